#pragma once

#include <functional>
#include <optional>

#include "downwash/controllers/plan.hpp"
#include "downwash/search/query_counts.hpp"
#include "downwash/search/random.hpp"
#include "downwash/search/search_record.hpp"
#include "downwash/search/search_task.hpp"

namespace downwash::planning {

/// How a geometric search ended.
struct GeometricResult {
    Status status = Status::none;
    std::optional<Plan> plan;
    double cost = 0;  ///< estimate of the variant: level hover along the reference and through the hold
    std::uint64_t iterations = 0;
    QueryCounts counts;
    std::vector<TreeNode> tree;     ///< if it was to be kept
    double nearest_approach_m = 0;  ///< how near to the goal region the start, or the end of the plan, is
};

/// A glance at a running geometric search.
struct GeometricProgress {
    std::uint64_t iteration, nodes, rejected;
};

/// What a geometric search is told and asked while it runs.
struct GeometricHooks {
    /// Asked in every iteration.
    std::function<bool(const GeometricProgress&)> is_over;
    /// Told of every better path.
    std::function<void(double cost, std::uint64_t iteration)> on_improvement;
    bool keep_tree = false;
};

/// MP-ARM: OMPL's geometric planners in (x, z, arm) with the vehicle level and straight edges; blind to dynamics
/// (thesis C.2). An iteration is one turn of the planner's own loop.
[[nodiscard]] GeometricResult plan_geometrically(const SearchTask& task, Random& random, const GeometricHooks& hooks);

/// The rest-to-rest reference through waypoints whose arm angles are unwrapped, the first at the start's motion.
[[nodiscard]] Plan timed_plan(const std::vector<Configuration>& waypoints, const ReferencePoint& start,
                              const MotionLimits& limits, double tick_s);

}  // namespace downwash::planning
