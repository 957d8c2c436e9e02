#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/planner/found.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/search/search_record.hpp"

namespace downwash {

/// The world that a plan was executed in.
struct ExecutionWorld {
    std::uint64_t index = 0;
    std::uint64_t seed = 0;
};

/// How a plan takes over from an earlier one, whose vehicle is in the air.
struct Replanned {
    std::string plan;                    ///< file of the earlier plan, as the user gave it
    std::int64_t tick = 0;               ///< of that plan, with which this one begins
    double t_s = 0;                      ///< the same as a time
    Outcome rest_outcome = Outcome::ok;  ///< of the rest of that plan from there, in the problem as it is now
    double rest_cost = 0;                ///< its cost in that flight
    std::optional<double>
        same_reference_s;  ///< so long this plan's reference is that of the rest; empty without a plan
};

/// The answer to a problem: what was found, how the search went, and the settings that it was asked with.
struct Solution : Found {
    bool interrupted = false;  ///< ended by the stop token
    Variant variant = Variant::mp_arm_ada;
    std::string algorithm;
    CostFunction objective;
    std::uint32_t seed = 1;
    int threads = 1;
    double execution_cost = 0;  ///< by the same objective in the flight with direct aerodynamics
    SearchRecord planning;
    std::shared_ptr<const AeroMap> map;  ///< map of the problem, for SolveOptions::map of another; empty: none
    std::optional<ExecutionWorld> execution_world;  ///< empty: the nominal one
    std::optional<Replanned> replanned;             ///< empty: the plan begins on its own
};

}  // namespace downwash
