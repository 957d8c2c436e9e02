#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "downwash/problems/visit_order.hpp"

// What summaries say of goals and of the order in which targets are visited, in the plane and in space.

namespace downwash::cli {

/// What a goal of a solution is called. @param order of a problem with targets   @param number of the goal, from 1
[[nodiscard]] std::string goal_name(const std::optional<VisitOrder>& order, std::size_t number);

/// Rows of a table: the order, how good it is, and what is left out.
[[nodiscard]] std::string order_rows(const VisitOrder& order, bool has_plan,
                                     const std::optional<double>& energy_budget_j);

/// How many goals a flight meets: of all, or of all targets and the place to return to.
[[nodiscard]] std::string met_goals_text(const std::optional<VisitOrder>& order, const std::vector<bool>& met);

/// The verdict on a flight that leaves out targets to which no flight was found.
[[nodiscard]] std::string left_out_text(const VisitOrder& order);

/// Whether no target is visited, as none can be within the energy budget.
[[nodiscard]] bool lacks_energy_for_all(const std::optional<VisitOrder>& order);

}  // namespace downwash::cli
