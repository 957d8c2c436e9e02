#include "downwash/identification/noise_search.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace

double NoiseSearch::step(std::size_t acceleration, const Pass& pass, FilterPass& here) {
    Noise next = noise_;
    next.measured = better_measured(noise_.measured, here);
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

std::optional<double> NoiseSearch::lower(const Pass& pass) {
    FilterPass here = pass(noise_);
    if (!here.is_finite) {
        return std::nullopt;
    }
    has_its_gains_ = true;
    const double before = here.cost;
    const std::size_t kinds = counted_ + 1;  // the last one: only what is measured
    std::size_t still = 0;
    for (std::size_t i = 0; i < max_steps && still < kinds; ++i) {
        const std::size_t kind = (i + counted_) % kinds;
        const bool was_fine = kind == counted_ || is_fine(factors_[kind]);
        const double fall = step(kind, pass, here);
        still = fall < small_fall && was_fine ? still + 1 : 0;
    }
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
