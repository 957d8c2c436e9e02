#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/planner/certificate.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/visit_order.hpp"
#include "downwash/search/search_record.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash {

/// The world that a plan was executed in.
struct ExecutionWorld {
    std::uint64_t index = 0;
    std::uint64_t seed = 0;
};

/// Where a vehicle that follows a plan can break off and hover.
struct SafeStops {
    struct Moment {
        std::int64_t tick = 0;
        std::optional<Configuration> rest;  ///< of the reference after braking; empty: no stop is known to be safe
        double duration_s = 0;              ///< until it is at rest
    };
    std::vector<Moment> moments;  ///< at each knot, and at most half a second apart
    double share_without = 0;     ///< of the time from the first knot to the last, from moments without a safe stop on
};

/// The answer to a problem.
struct Solution {
    Status status = Status::none;
    bool interrupted = false;  ///< ended by the stop token
    Variant variant = Variant::mp_arm_ada;
    std::string algorithm;
    CostFunction objective;
    std::uint32_t seed = 1;
    int threads = 1;
    double cost = 0;            ///< the planner's own figure; 0 without a plan
    double execution_cost = 0;  ///< by the same objective in the flight with direct aerodynamics
    SearchRecord planning;
    std::shared_ptr<const AeroMap> map;      ///< that the search flew in, for SolveOptions::map of another; empty: none
    std::vector<TreeNode> tree;              ///< of the search, one after the other if it took several; if asked for
    std::optional<Plan> plan;                ///< empty with Status::none
    std::optional<VisitOrder> order;         ///< in which the plan visits targets; empty where the problem has none
    std::optional<Certificate> certificate;  ///< of the plan; empty where everything is as believed
    std::optional<SafeStops> stops;          ///< along a plan that solves the problem, if asked for
    std::optional<ExecutionWorld> execution_world;  ///< empty: the nominal one
    std::optional<Execution> execution;             ///< the whole plan flown from the start with direct aerodynamics
};

/// What an executed flight costs.
[[nodiscard]] DOWNWASH_EXPORT double cost_of(const Execution& execution, const CostFunction& objective);

}  // namespace downwash
