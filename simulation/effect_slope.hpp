#pragma once

#include "downwash/dynamics/flight_step.hpp"

// The surface effect around one configuration, as values and slopes: all that the stability of a hover depends on.

namespace downwash::simulation {

/// Steps of central differences over a surface effect: small beside a rotor, large beside the error of the quadrature
/// over its disc.
inline constexpr double slope_step_m = 1e-3;

/// A surface effect near one configuration, linear in the position of every rotor.
class LinearEffect {
 public:
    /// The tangent of `factor` where a vehicle at this configuration has its rotors. Where K has a kink (a disc at
    /// its cap) the slope is the mean of both sides over slope_step_m.
    /// @param factor callable (rotor, x_m, z_m) -> K
    template <class Factor>
    LinearEffect(const PlantModel& plant, const dynamics::Attitude<double>& attitude, double x_m, double z_m,
                 const Factor& factor) {
        // Whatever the plant asks for on its way to a force is what has to be known.
        const double nothing_n[max_rotors] = {};
        static_cast<void>(
            dynamics::rotor_wrench(plant, attitude, x_m, z_m, nothing_n, [&](int rotor, double x, double z) {
                constexpr double h = slope_step_m;
                tangents_[rotor] = {x, z, factor(rotor, x, z),
                                    (factor(rotor, x + h, z) - factor(rotor, x - h, z)) / (2 * h),
                                    (factor(rotor, x, z + h) - factor(rotor, x, z - h)) / (2 * h)};
                return 1.0;
            }));
    }

    double operator()(int rotor, double x_m, double z_m) const noexcept {
        const Tangent& t = tangents_[rotor];
        return t.factor + t.slope_x_1_m * (x_m - t.x_m) + t.slope_z_1_m * (z_m - t.z_m);
    }

 private:
    struct Tangent {
        double x_m, z_m, factor, slope_x_1_m, slope_z_1_m;
    };
    Tangent tangents_[max_rotors + 2] = {};  // two more for what acts on the body
};

}  // namespace downwash::simulation
