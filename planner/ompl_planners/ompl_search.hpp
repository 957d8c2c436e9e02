#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "downwash/controllers/plan.hpp"
#include "downwash/search/family.hpp"
#include "downwash/search/search_record.hpp"

namespace downwash::planning {

/// How a search by one of OMPL's planners ended.
template <class Family>
struct OmplResultOf {
    using Plan = typename Family::Plan;
    using TreeNode = typename Family::TreeNode;

    Status status = Status::none;
    std::optional<Plan> plan;
    double cost = 0;  ///< by the planner's own model
    std::uint64_t iterations = 0;
    /// Without a plan that was accepted: how near to the goal region it came [m].
    std::optional<double> nearest_approach_m;
    std::vector<TreeNode> tree;  ///< if it was to be kept
};
using OmplResult = OmplResultOf<Plane>;

/// A glance at a running search.
struct OmplProgress {
    std::uint64_t iteration, nodes, rejected;
};

/// What a search is told and asked while it runs.
template <class Family>
struct OmplHooksOf {
    using Plan = typename Family::Plan;

    /// Asked in every iteration.
    std::function<bool(const OmplProgress&)> is_over;
    /// Asked about every better plan; false discards it and the search goes on.
    std::function<bool(const Plan& plan, double cost, std::uint64_t iteration)> accept;
    bool keep_tree = false;
};
using OmplHooks = OmplHooksOf<Plane>;

}  // namespace downwash::planning
