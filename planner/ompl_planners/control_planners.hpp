#pragma once

#include <functional>
#include <optional>

#include "downwash/ompl_planners/steered_flights.hpp"
#include "downwash/search/random.hpp"

namespace downwash::planning {

/// How a search over controls ended.
struct ControlResult {
    Status status = Status::none;
    std::optional<Plan> plan;
    double cost = 0;
    std::uint64_t iterations = 0;
    /// Without a plan that was accepted: from the place of rest that came nearest to the goal region [m].
    std::optional<double> nearest_approach_m;
    std::vector<TreeNode> tree;  ///< if it was to be kept; a node is where its reference would come to rest
};

/// What a search over controls is told and asked while it runs.
struct ControlHooks {
    /// Asked before every iteration.
    std::function<bool(std::uint64_t iteration)> is_over;
    /// Asked about every better plan; false discards it and the search goes on.
    std::function<bool(const Plan& plan, double cost, std::uint64_t iteration)> accept;
    bool keep_tree = false;
};

/// OMPL's planners over controls on steered flights, with algorithm, seed and parameters of the task's problem: `rrt`,
/// `sst`, `kpiece1` or `est`. An iteration is one turn of the planner's own loop. `sst` goes on for better plans; the
/// others end with the first that is accepted.
[[nodiscard]] ControlResult plan_by_controls(const SteeredFlights& flights, Random& random, const ControlHooks& hooks);

}  // namespace downwash::planning
