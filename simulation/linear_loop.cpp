#include "downwash/simulation/linear_loop.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>

namespace downwash::simulation {
namespace {

using Complex = std::complex<double>;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A sample of a loop's gain L.
struct Sample {
    double frequency_rad_s = 0;
    Complex gain;
};

/// The gains L of loops at a frequency, exactly: a past motion is the motion times z^-age. L is the command that comes
/// back, reversed, for one that goes in. With T from what is added to the command, u = y + d and y = T d, so that
/// L = -T / (1 + T).
std::vector<Complex> gains_at(const LinearLoops& loops, double angle_rad) {
    const Eigen::Index size = loops.a.rows();
    Eigen::MatrixXcd a = loops.a, c = loops.c;
    for (const LatePart& part : loops.late) {
        const Complex ago = std::polar(1.0, -angle_rad * part.age);
        a.leftCols(part.a.cols()) += ago * part.a;
        c.leftCols(part.a.cols()) += ago * part.c;
    }
    // What takes the time is the same for all loops.
    const Eigen::PartialPivLU<Eigen::MatrixXcd> resolvent(
        std::polar(1.0, angle_rad) * Eigen::MatrixXcd::Identity(size, size) - a);
    std::vector<Complex> gains;
    for (Eigen::Index i = 0; i < loops.b.cols(); ++i) {
        const Eigen::VectorXcd x = resolvent.solve(loops.b.col(i).cast<Complex>());
        const Eigen::RowVectorXcd seen = c.row(i);
        const Complex t = seen * x;
        gains.push_back(-t / (1.0 + t));
    }
    return gains;
}

/// What a loop's gain between two neighbouring frequencies tells of its margins.
void look_between(const Sample& sample_before, const Sample& sample, LoopMargins& margins) {
    const auto& [frequency_before, before] = sample_before;
    const auto& [frequency, gain] = sample;
    const double size = std::log(std::abs(gain));
    const double size_before = std::log(std::abs(before));
    if (size * size_before <= 0 && size != size_before) {  // the gain crosses 1
        const double at = size_before / (size_before - size);
        const double frequency_there = frequency_before * std::pow(frequency / frequency_before, at);
        const double phase = std::arg(-before) + at * std::arg(gain / before);  // from -1
        const double folded = std::remainder(phase, 2 * std::numbers::pi);
        margins.phase_margin_rad = std::min(margins.phase_margin_rad, std::abs(folded));
        margins.crossover_rad_s = frequency_there;
        const double lag = folded >= 0 ? folded : folded + 2 * std::numbers::pi;
        margins.delay_margin_s = std::min(margins.delay_margin_s, lag / frequency_there);
    }
    const bool crosses_axis = gain.imag() * before.imag() <= 0 && gain.imag() != before.imag();
    if (crosses_axis) {
        const double at = before.imag() / (before.imag() - gain.imag());
        const double real = before.real() + at * (gain.real() - before.real());
        if (real < 0) {
            margins.gain_margin_db = std::min(margins.gain_margin_db, std::abs(20 * std::log10(-real)));
        }
    }
    // Of the closed loop L / (1 + L), beside 1 / sqrt 2.
    const double answer = std::log(std::numbers::sqrt2 * std::abs(gain / (1.0 + gain)));
    const double answer_before = std::log(std::numbers::sqrt2 * std::abs(before / (1.0 + before)));
    if (answer * answer_before <= 0 && answer != answer_before) {
        const double at = answer_before / (answer_before - answer);
        margins.bandwidth_rad_s = frequency_before * std::pow(frequency / frequency_before, at);
    }
}

}  // namespace

std::vector<LoopMargins> margins_of(const LinearLoops& loops, double tick_s) {
    constexpr int samples = 500;
    constexpr double lowest_rad_s = 0.02;
    const double highest_rad_s = std::numbers::pi / tick_s;
    const auto count = static_cast<std::size_t>(loops.b.cols());
    std::vector<LoopMargins> margins(count, LoopMargins{infinity, infinity, 0, infinity, 0});
    std::vector<Sample> before(count);
    for (int i = 0; i < samples; ++i) {
        const double share = static_cast<double>(i) / (samples - 1);
        const double frequency = lowest_rad_s * std::pow(highest_rad_s / lowest_rad_s, share);
        const std::vector<Complex> gains = gains_at(loops, std::min(frequency * tick_s, std::numbers::pi));
        for (std::size_t loop = 0; loop < count; ++loop) {
            Sample here{frequency, gains[loop]};
            if (i == samples - 1) {
                here.gain = here.gain.real();  // at half the sampling frequency L is real: the curve ends on the axis
            }
            if (i > 0) {
                look_between(before[loop], here, margins[loop]);
            }
            before[loop] = here;
        }
    }
    return margins;
}

Eigen::MatrixXd with_past(const Eigen::MatrixXd& a, const std::vector<LatePart>& late) {
    int oldest = 0;
    Eigen::Index motion = 0;
    for (const LatePart& part : late) {
        oldest = std::max(oldest, part.age);
        motion = part.a.cols();
    }
    const Eigen::Index size = a.rows();
    const Eigen::Index all = size + oldest * motion;
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(all, all);
    result.topLeftCorner(size, size) = a;
    for (const LatePart& part : late) {
        result.block(0, size + (part.age - 1) * motion, size, motion) += part.a;
    }
    // A motion becomes one tick older.
    for (int age = 1; age <= oldest; ++age) {
        const Eigen::Index from = age == 1 ? 0 : size + (age - 2) * motion;
        result.block(size + (age - 1) * motion, from, motion, motion).setIdentity();
    }
    return result;
}

}  // namespace downwash::simulation
