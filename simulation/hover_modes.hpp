#pragma once

// Private to simulation/.

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "downwash/base/portable_math.hpp"

// How disturbances of a hover develop, by the eigenvalues of its tick.

namespace downwash::simulation {

/// Nearer to 1 than this a spectral radius is not known to be below: rounding and differences.
inline constexpr double radius_slack = 1e-9;

/// Modes that cannot be found, as with gains beyond all measure, count as growing without limit.
/// @param jacobian of one tick at its fixed point
template <class Matrix, class Stability>
void find_modes(const Matrix& jacobian, double tick_s, Stability& stability) {
    stability.spectral_radius = std::numeric_limits<double>::infinity();
    stability.growth_rate_1_s = std::numeric_limits<double>::infinity();
    stability.growing_modes = static_cast<int>(jacobian.rows());
    if (!jacobian.allFinite()) {
        return;
    }
    const Eigen::EigenSolver<Matrix> solver(jacobian, false);
    if (solver.info() != Eigen::Success || !solver.eigenvalues().allFinite()) {
        return;
    }
    stability.growing_modes = 0;
    double largest = 0;  // squared modulus
    for (Eigen::Index i = 0; i < jacobian.rows(); ++i) {
        const double re = solver.eigenvalues()[i].real();
        const double im = solver.eigenvalues()[i].imag();
        const double squared = re * re + im * im;
        stability.growing_modes += squared > 1 ? 1 : 0;
        if (squared > largest) {
            largest = squared;
            stability.frequency_rad_s = std::abs(lane::atan2(im, re)) / tick_s;
        }
    }
    stability.spectral_radius = std::sqrt(largest);
    stability.growth_rate_1_s = natural_log(stability.spectral_radius) / tick_s;
}

}  // namespace downwash::simulation
