#include "downwash/simulation/linear_loop.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace downwash::simulation {
namespace {

using Complex = std::complex<double>;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A loop's answer at a frequency, exactly: a past motion is the motion times z^-age.
class FrequencyResponse {
 public:
    explicit FrequencyResponse(const LinearLoop& loop) : loop_(loop) {}

    /// The loop's gain L: the command that comes back, reversed, for one that goes in. With T from what is added to the
    /// command, u = y + d and y = T d, so that L = -T / (1 + T).
    [[nodiscard]] Complex gain_at(double angle_rad) const {
        const Eigen::Index size = loop_.a.rows();
        Eigen::MatrixXcd a = loop_.a;
        Eigen::RowVectorXcd c = loop_.c;
        for (const LatePart& part : loop_.late) {
            const Complex ago = std::polar(1.0, -angle_rad * part.age);
            a.leftCols(part.a.cols()) += ago * part.a;
            c.head(part.a.cols()) += ago * part.c;
        }
        const Eigen::MatrixXcd resolvent = std::polar(1.0, angle_rad) * Eigen::MatrixXcd::Identity(size, size) - a;
        const Complex t = c * resolvent.partialPivLu().solve(loop_.b.cast<Complex>());
        return -t / (1.0 + t);
    }

 private:
    const LinearLoop& loop_;
};

}  // namespace

LoopMargins margins_of(const LinearLoop& loop, double tick_s) {
    const FrequencyResponse response(loop);
    constexpr int samples = 500;
    constexpr double lowest_rad_s = 0.02;
    const double highest_rad_s = std::numbers::pi / tick_s;
    LoopMargins margins{infinity, infinity, 0, infinity, 0};
    double frequency_before = 0;
    Complex before;
    for (int i = 0; i < samples; ++i) {
        const double share = static_cast<double>(i) / (samples - 1);
        const double frequency = lowest_rad_s * std::pow(highest_rad_s / lowest_rad_s, share);
        Complex gain = response.gain_at(std::min(frequency * tick_s, std::numbers::pi));
        if (i == samples - 1) {
            gain = gain.real();  // at half the sampling frequency L is real: the curve ends on the axis
        }
        if (i > 0) {
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
        before = gain;
        frequency_before = frequency;
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
