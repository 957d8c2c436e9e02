#include "downwash/identification/noise_search.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/base/vector3.hpp"
#include "downwash/identification/vehicle_estimate.hpp"

namespace downwash::identification {
namespace {

constexpr int max_steps = 40;
/// Of -2 log likelihood: a tenth of what chance changes it by.
constexpr double small_fall = 0.1;
constexpr double fine = 1.5;  ///< a factor of a variance that is worth no further step
/// Bounds of variances: no log is more exact than a micrometre or a microradian.
constexpr double least_measured = 1e-12, least_acceleration = 1e-10, most_acceleration = 1e6;

/// Variances of what is measured, by their likelihood at the present gains: its slope is zero where the sum of
/// e^2 / S^2 is that of 1 / S.
PerChannel better_measured(const PerChannel& measured, const FilterPass& pass) {
    PerChannel better = measured;
    for (std::size_t k = 0; k < channel_count; ++k) {
        const double ratio = pass.excess[k] / pass.weight[k];
        if (std::isfinite(ratio)) {
            better[k] = std::max(measured[k] * ratio, least_measured);
        }
    }
    return better;
}

bool is_fine(double factor) {
    return factor < fine && factor > 1 / fine;
}

/// Mean of the squared third differences of white noise, over its variance: 1 + 9 + 9 + 1.
constexpr double of_third_difference = 20;

Vector3 turn_between(const std::array<double, 4>& from, const std::array<double, 4>& to) {
    const Eigen::Quaterniond a(from[0], from[1], from[2], from[3]), b(to[0], to[1], to[2], to[3]);
    const Eigen::Vector3d turn = vector_of_turn(a.conjugate() * b);
    return {turn.x(), turn.y(), turn.z()};
}

/// Adds the squared third differences of one channel from four ticks in a row.
template <class Difference>
void add_third(const LoggedTick* ticks, std::size_t count, const Difference& difference, double& sum, double& terms) {
    const auto first = difference(ticks[0].seen, ticks[1].seen), second = difference(ticks[1].seen, ticks[2].seen),
               third = difference(ticks[2].seen, ticks[3].seen);
    for (std::size_t i = 0; i < count; ++i) {
        const double value = first[i] - 2 * second[i] + third[i];
        sum += value * value;
        terms += 1;
    }
}

}  // namespace

Noise first_noise(const std::vector<const LoggedFlight*>& flights, int joints) {
    PerChannel sums{}, terms{};
    for (const LoggedFlight* flight : flights) {
        for (std::size_t i = 0; i + 3 < flight->ticks.size(); ++i) {
            const LoggedTick* ticks = &flight->ticks[i];
            const auto add = [&](Channel channel, std::size_t count, const auto& difference) {
                const auto k = static_cast<std::size_t>(channel);
                add_third(ticks, count, difference, sums[k], terms[k]);
            };
            const auto of = [](auto member) {
                return [member](const SpaceMotion& from, const SpaceMotion& to) { return to.*member - from.*member; };
            };
            const auto of_joints = [](auto member) {
                return [member](const SpaceMotion& from, const SpaceMotion& to) {
                    auto by = to.*member;
                    for (std::size_t j = 0; j < by.size(); ++j) {
                        by[j] -= (from.*member)[j];
                    }
                    return by;
                };
            };
            add(Channel::position, 3, of(&SpaceMotion::position_m));
            add(Channel::attitude, 3, [](const SpaceMotion& from, const SpaceMotion& to) {
                return turn_between(from.attitude, to.attitude);
            });
            add(Channel::velocity, 3, of(&SpaceMotion::velocity_m_s));
            add(Channel::body_rates, 3, of(&SpaceMotion::body_rates_rad_s));
            const auto count = static_cast<std::size_t>(joints);
            add(Channel::joints, count, of_joints(&SpaceMotion::joints_rad));
            add(Channel::joint_rates, count, of_joints(&SpaceMotion::joint_rates_rad_s));
        }
    }
    Noise noise{{}, {0.01, 1, 100}};
    for (std::size_t k = 0; k < channel_count; ++k) {
        noise.measured[k] = std::max(terms[k] > 0 ? sums[k] / (terms[k] * of_third_difference) : 0, least_measured);
    }
    return noise;
}

double NoiseSearch::step(std::size_t acceleration, bool holds_measured, const Pass& pass, FilterPass& here) {
    Noise next = noise_;
    if (!holds_measured) {
        next.measured = better_measured(noise_.measured, here);
    }
    if (acceleration < counted_) {
        double& variance = next.accelerations[acceleration];
        variance = std::clamp(variance * factors_[acceleration], least_acceleration, most_acceleration);
    }
    const FilterPass there = pass(next);
    const double fall = there.is_finite ? here.cost - there.cost : 0;
    has_its_gains_ = fall > 0;
    if (fall > 0) {
        noise_ = next;
        here = there;
    }
    if (acceleration < counted_) {
        double& factor = factors_[acceleration];
        constexpr double greatest = 1e-3;
        factor = fall > small_fall ? std::clamp(factor * factor, greatest, 1 / greatest) : 1 / std::sqrt(factor);
    }
    return fall;
}

void NoiseSearch::descend(bool holds_measured, const Pass& pass, FilterPass& here) {
    const std::size_t kinds = counted_ + (holds_measured ? 0 : 1);  // the last one: only what is measured
    std::size_t still = 0;
    for (std::size_t i = 0; i < max_steps && still < kinds; ++i) {
        const std::size_t kind = holds_measured ? i % kinds : (i + counted_) % kinds;
        const bool was_fine = kind == counted_ || is_fine(factors_[kind]);
        const double fall = step(kind, holds_measured, pass, here);
        still = fall < small_fall && was_fine ? still + 1 : 0;
    }
}

std::optional<double> NoiseSearch::lower(const Pass& pass) {
    FilterPass here = pass(noise_);
    if (!here.is_finite) {
        return std::nullopt;
    }
    has_its_gains_ = true;
    const double before = here.cost;
    // Both at once can end where accelerations explain what is noise of the sensors, a maximum of the likelihood that
    // is not the greatest.
    descend(true, pass, here);
    descend(false, pass, here);
    if (!has_its_gains_) {
        here = pass(noise_);
    }
    counts_ = here.counts;
    // A later search begins with steps that are neither too fine nor too coarse.
    for (double& factor : factors_) {
        factor = first_factor;
    }
    return before - here.cost;
}

}  // namespace downwash::identification
