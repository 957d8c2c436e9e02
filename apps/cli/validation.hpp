#pragma once

#include <optional>
#include <string>
#include <vector>

#include "downwash/cli/output.hpp"
#include "downwash/judge/disagreements.hpp"
#include "downwash/judge/plan_judge.hpp"
#include "downwash/judge/world_runs.hpp"
#include "downwash/problems/visit_order.hpp"

namespace downwash::cli {

/// What `validate` finds.
struct Validation {
    judge::JudgedFlight flight;
    bool is_self_collision = false;      ///< of a collision: the robot touched itself
    std::optional<std::uint64_t> world;  ///< world of that flight; empty: the nominal one
    bool has_flight_claims = false;      ///< the file says something about a flight
    std::vector<judge::Disagreement> disagreements;
    std::optional<judge::WorldRuns> worlds;

    [[nodiscard]] bool is_valid() const noexcept {
        return flight.outcome == judge::Outcome::ok && disagreements.empty();
    }
};

/// What is wrong with the order that a plan claims: without an energy budget there is no reason to leave out targets.
template <class AnyProblem>
[[nodiscard]] std::vector<judge::Disagreement> disagreements_about_order(const std::optional<VisitOrder>& order,
                                                                         const AnyProblem& problem) {
    if (!order || problem.energy_budget_j || order->left_out.empty()) {
        return {};
    }
    return {{"order: targets visited without an energy budget", static_cast<double>(order->visits.size()),
             static_cast<double>(targets_of(problem).size())}};
}

/// For programs.
[[nodiscard]] Json json_of(const Validation& validation);

/// For people: a verdict, then a table. @param fly_one the command that flies one world, up to its number
[[nodiscard]] std::string text_of(const Validation& validation, const std::string& fly_one);

}  // namespace downwash::cli
