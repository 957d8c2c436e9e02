#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/planner/problem.hpp"
#include "downwash/planner/solution.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash {

/// A glance at a running search.
struct Progress {
    double wall_s = 0;
    std::uint64_t iterations = 0;
    std::uint64_t nodes = 0;
    std::uint64_t rejected = 0;       ///< edges refused so far, for any reason
    std::optional<double> best_cost;  ///< empty before the first solution
};

/// How a program takes part in a search.
struct SolveOptions {
    int threads = 1;       ///< for flights and the aero map, below 1 as 1; the result does not depend on it
    std::stop_token stop;  ///< ends the search early, with the best plan so far
    std::function<void(const Progress&)> on_progress;  ///< called by solve()'s thread, up to ten times a second
    /// Called from the calling thread while the aero map is built, with the share of it that is begun; not where a map
    /// is reused.
    std::function<void(double)> on_map_progress;
    bool stop_at_first_solution = false;
    bool keep_tree = false;              ///< also gives the search tree
    std::shared_ptr<const AeroMap> map;  ///< reuses a map of the same problem; built when empty
    std::filesystem::path map_cache;     ///< folder in which maps are kept between runs; empty: nowhere
};

/// A number that an algorithm works with. Fixed; listed so that results can be compared with others'.
struct AlgorithmParameter {
    std::string_view name;  ///< as OMPL calls it, where it is OMPL's
    double value;
    std::string_view description;
};

/// One search algorithm.
struct AlgorithmInfo {
    std::string_view name;
    std::string_view kind;  ///< "geometric, anytime", ...
    std::string_view description;
    bool plans_lines = false;    ///< for mp-arm
    bool plans_flights = false;  ///< for mp-arm-da and mp-arm-ada
    std::span<const AlgorithmParameter> parameters = {};

    /// Whether a problem may name it together with a variant.
    [[nodiscard]] bool plans_for(Variant variant) const noexcept {
        return variant == Variant::mp_arm ? plans_lines : plans_flights;
    }
};

/// Every algorithm that a problem may name.
[[nodiscard]] DOWNWASH_EXPORT std::span<const AlgorithmInfo> algorithms();

/// The robot and scene of a problem, bound together.
/// @pre problem_faults(problem) is empty
[[nodiscard]] DOWNWASH_EXPORT std::shared_ptr<const FlightModel> make_flight_model(const Problem& problem);

/// The vehicle at the start of a problem.
[[nodiscard]] DOWNWASH_EXPORT FlightState start_state(const FlightModel& model, const Start& start);

/// Plans, and flies the plan with direct aerodynamics, hold included.
/// An aerodynamics-aware plan whose direct flight fails or comes nearer to an obstacle than the margin, at any tick, is
/// discarded and the search goes on; the other variants' plans are reported with their failed flight. Never prints,
/// never exits. While it runs OMPL's log, one for the whole process, is silent; OMPL's global seeds are neither needed
/// nor set.
/// @throws InputError with every fault when the problem cannot be planned
[[nodiscard]] DOWNWASH_EXPORT Solution solve(const Problem& problem, const SolveOptions& options = {});

}  // namespace downwash
