#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/simulation/flight_sums.hpp"

namespace downwash {

/// What a plan may keep small; hold included.
enum class Objective {
    energy,     ///< rotor and arm power over time [J]
    time,       ///< duration [s]
    length,     ///< FlightSums::length_m [m]
    clearance,  ///< integral of dt / (clearance + 0.1 m) [s/m]
};

/// Each once, in their order.
inline constexpr std::array all_objectives{Objective::energy, Objective::time, Objective::length, Objective::clearance};

/// Name as in problem files: "energy".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(Objective objective);

/// "J"
[[nodiscard]] DOWNWASH_EXPORT std::string_view unit_of(Objective objective);

/// What a flight, or a part of one, takes in each objective.
struct CostFigures : FlightSums {
    double energy_j = 0;
    double time_s = 0;
    double clearance_integral = 0;  ///< [s/m]
};

/// What a plan costs: one objective in its own unit, or a sum of several, each with a weight per unit.
class DOWNWASH_EXPORT CostFunction {
 public:
    /// One objective alone, with the weight 1.
    // NOLINTNEXTLINE(google-explicit-constructor): an objective is a sum of one, wherever a cost is asked for
    CostFunction(Objective objective = Objective::energy) noexcept { weights_[index_of(objective)] = 1; }

    /// A sum in which nothing counts yet.
    [[nodiscard]] static CostFunction of_nothing() noexcept;

    /// Per unit of the objective (J, s, m, s/m); >= 0, one of them above 0.
    [[nodiscard]] double weight(Objective objective) const noexcept { return weights_[index_of(objective)]; }
    /// For setting it.
    [[nodiscard]] double& weight(Objective objective) noexcept { return weights_[index_of(objective)]; }

    /// The objective that counts alone and with the weight 1; nothing for any other sum.
    [[nodiscard]] std::optional<Objective> single() const noexcept;

    /// @return the sum of weight times figure; figures without a weight are not looked at
    [[nodiscard]] double operator()(const CostFigures& figures) const noexcept;

    friend bool operator==(const CostFunction&, const CostFunction&) = default;

 private:
    static constexpr std::size_t index_of(Objective objective) noexcept { return static_cast<std::size_t>(objective); }

    std::array<double, all_objectives.size()> weights_{};
};

/// That of the objective that counts alone; empty for a weighted sum.
[[nodiscard]] DOWNWASH_EXPORT std::string_view unit_of(const CostFunction& cost);

/// For people: "energy", "energy + 50 time".
[[nodiscard]] DOWNWASH_EXPORT std::string text_of(const CostFunction& cost);

}  // namespace downwash
