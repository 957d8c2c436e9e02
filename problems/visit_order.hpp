#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/space_problem.hpp"

namespace downwash {

/// The targets of a problem, whose order the planner chooses; none where goals have an order.
[[nodiscard]] inline std::span<const Goal> targets_of(const Problem& problem) noexcept {
    return problem.targets;
}
[[nodiscard]] inline std::span<const SpaceGoal> targets_of(const SpaceProblem& problem) noexcept {
    return problem.in_any_order ? std::span(problem.goals) : std::span<const SpaceGoal>();
}

/// A stay at one of the targets of a problem.
struct Visit {
    std::size_t target = 0;                  ///< number among targets_of(problem), from 0
    std::optional<std::size_t> alternative;  ///< In its `any_of`, from 0; empty: any of them, or it has none.

    friend bool operator==(const Visit&, const Visit&) = default;
};

/// Why a flight leaves out a target.
enum class LeftOutReason : std::uint8_t {
    energy_budget,  ///< the flight would take more energy with it than it may
    no_flight,      ///< no flight to it was found
};

inline constexpr std::array all_left_out_reasons{LeftOutReason::energy_budget, LeftOutReason::no_flight};

/// Name as in solution files: "energy_budget".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(LeftOutReason reason);

/// A target that is not visited.
struct LeftOutTarget {
    std::size_t target = 0;  ///< number among targets_of(problem), from 0
    LeftOutReason reason = LeftOutReason::no_flight;
    /// For `energy_budget`: what the flight would take with this target beside those that are visited, by the legs that
    /// were flown and lower bounds of the others [J].
    std::optional<double> energy_j;

    friend bool operator==(const LeftOutTarget&, const LeftOutTarget&) = default;
};

/// In which order the targets of a problem are visited, and which of them are left out.
struct VisitOrder {
    std::vector<Visit> visits;
    std::vector<LeftOutTarget> left_out;  ///< by number
    bool is_best = false;    ///< no other order is cheaper by the legs that were flown and lower bounds of the others
    std::uint64_t legs = 0;  ///< flown between two places each to compare orders
    double cost_of_legs =
        0;  ///< Sum over the legs of this order, one by one; the flight of the plan costs something else.

    friend bool operator==(const VisitOrder&, const VisitOrder&) = default;
};

/// All targets as they stand in the problem. @pre there are targets
[[nodiscard]] DOWNWASH_EXPORT VisitOrder given_order(const Problem& problem);
[[nodiscard]] DOWNWASH_EXPORT VisitOrder given_order(const SpaceProblem& problem);

/// The problem in which the goals are visited in this order, one after the other; its energy budget stays. A problem
/// without targets stays what it is, and so does one without an order, or with one that visits nothing.
/// @pre all numbers are of the problem
[[nodiscard]] DOWNWASH_EXPORT Problem in_order(Problem problem, const std::optional<VisitOrder>& order);
[[nodiscard]] DOWNWASH_EXPORT SpaceProblem in_order(SpaceProblem problem, const std::optional<VisitOrder>& order);

/// What people call the goals of goals_of(problem) or, with an order, of goals_of(in_order(problem, order)): "goal" of
/// one alone, "goal 2", or "target 3" and "the place to return to".
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::string> goal_names(const Problem& problem,
                                                                  const std::optional<VisitOrder>& order);
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::string> goal_names(const SpaceProblem& problem,
                                                                  const std::optional<VisitOrder>& order);

}  // namespace downwash
