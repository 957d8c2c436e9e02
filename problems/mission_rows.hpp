#pragma once

// Private to problems/.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "downwash/base/parameter_factories.hpp"

namespace downwash {

/// Adds what a mission to targets in any order has beside them: the place to return to, and the energy budget.
/// @tparam ConfigurationKind of goals that the place may be   @param configuration rows of such a goal
/// @param hold the row of that place's hold   @param has_targets whether a problem has targets in any order
template <class ConfigurationKind, class AnyProblem, class AnyGoal, class HasTargets>
void add_mission_rows(std::vector<Parameter<AnyProblem>>& rows, const std::vector<Parameter<AnyGoal>>& configuration,
                      Parameter<AnyProblem> hold, HasTargets has_targets) {
    constexpr std::string_view with_targets = "with in_any_order";
    const std::string path = "goal.return_to";
    rows.push_back(parameters::group<AnyProblem>(
                       path, "where the flight must end and stay after the last target",
                       [](const AnyProblem& p, std::size_t) {
                           return p.return_to && std::holds_alternative<ConfigurationKind>(p.return_to->kind);
                       },
                       [](AnyProblem& p, std::size_t, bool is_there) {
                           p.return_to.reset();
                           if (is_there) {
                               p.return_to.emplace();
                           }
                       })
                       .only(with_targets, has_targets));
    for (const Parameter<AnyGoal>& row : configuration) {
        rows.push_back(parameters::nested<AnyProblem>(
            row, path + ".", [](auto& p, std::size_t) -> auto& { return *p.return_to; }));
    }
    rows.push_back(std::move(hold));
    rows.push_back(parameters::number<AnyProblem>(
                       "goal.energy_budget_j",
                       "energy that no flight may exceed: targets for which it is not enough are left out",
                       [](auto& p, std::size_t) -> auto& { return p.energy_budget_j; })
                       .above(0)
                       .at_most(1e12)
                       .only(with_targets, has_targets));
}

}  // namespace downwash
