#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "downwash/identification/flight_filter.hpp"
#include "downwash/identification/logged_flight.hpp"
#include "downwash/identification/trial.hpp"

// Private to identification/.

namespace downwash::identification {

/// The noise before a search: of what is measured, what the third differences of neighbouring ticks have if the motion
/// is smooth; of accelerations, room for numbers that are not found yet.
[[nodiscard]] Noise first_noise(const std::vector<const LoggedFlight*>& flights, int joints);

/// Searches the noise that makes logs most likely: variances of what is measured by a fixed point, those of unmodelled
/// accelerations step by step.
class NoiseSearch {
 public:
    /// The filters' passes with a noise, summed over logs; the filters keep its gains.
    using Pass = std::function<FilterPass(const Noise&)>;

    NoiseSearch() = default;
    NoiseSearch(const Noise& first, bool has_joints) : noise_(first), counted_(has_joints ? 3 : 2) {}

    /// Searches on from the present noise; the last pass is the one with the noise that was found.
    /// @return by how much -2 log likelihood fell; empty if no motion follows from the logs
    std::optional<double> lower(const Pass& pass);

    [[nodiscard]] const Noise& noise() const noexcept { return noise_; }
    [[nodiscard]] const PerChannel& counts() const noexcept { return counts_; }

 private:
    /// One step with an acceleration, or with what is measured alone. @return by how much the cost fell
    double step(std::size_t acceleration, bool holds_measured, const Pass& pass, FilterPass& here);
    /// Steps with each number in turn until none lowers the cost any more.
    void descend(bool holds_measured, const Pass& pass, FilterPass& here);

    Noise noise_;
    std::size_t counted_ = 3;  ///< accelerations that there are
    std::array<double, acceleration_count> factors_{first_factor, first_factor, first_factor};
    PerChannel counts_{};
    bool has_its_gains_ = true;  ///< whether the last pass was that of noise_

    static constexpr double first_factor = 0.2;
};

}  // namespace downwash::identification
