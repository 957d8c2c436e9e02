#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/planner/certificate.hpp"
#include "downwash/planner/safe_stops.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/visit_order.hpp"
#include "downwash/search/family.hpp"
#include "downwash/search/search_record.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash {

/// Cause of an obstruction: the search ended before the direct flight of its plan did.
inline constexpr std::string_view unfinished_flight = "unfinished_flight";
/// The search ended before its plan was flown in enough worlds.
inline constexpr std::string_view unfinished_certificate = "unfinished_certificate";

/// What a search has found, or what stood between it and its goal.
template <class Family>
struct FoundOf {
    using Plan = typename Family::Plan;
    using Obstruction = typename Family::Obstruction;
    using TreeNode = typename Family::TreeNode;
    using Execution = typename Family::Execution;

    Status status = Status::none;
    double cost = 0;                  ///< the planner's own figure; 0 without a plan
    std::optional<Plan> plan;         ///< empty with Status::none
    std::optional<VisitOrder> order;  ///< order in which the plan visits targets; empty where the problem has none
    std::optional<Certificate> certificate;         ///< certificate of the plan; empty if none was asked for
    std::optional<SafeStopsOf<Family>> safe_stops;  ///< safe stops along a plan that solves the problem, if asked for
    std::optional<Execution> execution;             ///< the whole plan flown from the start with direct aerodynamics
    double flight_wall_s = 0;                       ///< time that this flight took to simulate [s]
    /// How near to the goal region a search without a plan brought the vehicle [m].
    std::optional<double> nearest_approach_m;
    std::optional<Obstruction> obstruction;  ///< what stopped a search by flights before the goal
    std::optional<std::size_t> missed_goal;  ///< number of the goal, from 1, that a search for several did not reach
    std::vector<TreeNode> tree;              ///< trees of all searches for the plan, if asked for
};
using Found = FoundOf<planning::Plane>;

/// What an executed flight costs.
[[nodiscard]] DOWNWASH_EXPORT double cost_of(const Execution& execution, const CostFunction& objective);
[[nodiscard]] DOWNWASH_EXPORT double cost_of(const SpaceFlight& flight, const CostFunction& objective);

}  // namespace downwash
