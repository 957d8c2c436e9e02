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
};

}  // namespace downwash
