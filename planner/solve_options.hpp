#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/search/family.hpp"

namespace downwash {

/// A glance at a running search.
struct Progress {
    double wall_s = 0;
    std::uint64_t iterations = 0;
    std::uint64_t nodes = 0;          ///< of all searches for this solution, as far as they were told of
    std::uint64_t rejected = 0;       ///< edges rejected so far, for any reason
    std::optional<double> best_cost;  ///< planned cost of the best whole way; empty before the first
    std::size_t goal = 1;             ///< the goal to which a way is searched, from 1
    std::size_t goals = 1;            ///< how many there are
    std::size_t round = 1;            ///< number of the search for a whole way through several goals, from 1
    /// Legs between targets that were flown so far, while their orders are compared. Empty at other times.
    std::optional<std::uint64_t> legs;
    /// Worlds in which a plan was flown so far, while it is certified, and in how many it failed. Empty at other times.
    std::optional<std::uint64_t> worlds;
    std::uint64_t failures = 0;
    double failure_bound =
        1;  ///< the failure probability is at most this, by these flights, with the problem's confidence
};

/// A plan that a search has just found, better than all before.
template <class Family>
struct FoundPlanOf {
    using Plan = typename Family::Plan;

    const Plan& plan;                  ///< through all goals; valid during the call
    double cost = 0;                   ///< by the planner's own model
    std::optional<double> flown_cost;  ///< cost of its flight with direct aerodynamics, if that was checked
};
using FoundPlan = FoundPlanOf<planning::Plane>;

/// How a program takes part in a search. Its functions must not throw.
template <class Family>
struct SolveOptionsOf {
    using Configuration = typename Family::Configuration;
    using Plan = typename Family::Plan;
    using FoundPlan = FoundPlanOf<Family>;

    int threads = 1;       ///< threads for flights, below 1 as 1; the result does not depend on it
    std::stop_token stop;  ///< ends the search early, with the best plan so far
    std::function<void(const Progress&)> on_progress;  ///< called by solve()'s thread, ten times a second
    /// Called by solve()'s thread with each plan that counts and is better than the last.
    std::function<void(const FoundPlan&)> on_plan;
    /// What the search knows before it begins, as from a search for the same goal from another start or in another
    /// scene: a plan, whose ticks begin with the search, is flown from the start first and refined if nothing rejects
    /// it; places are tried before random ones, in their order. Of a problem with a single goal; rrt-star only.
    std::optional<Plan> known_plan;
    std::vector<Configuration> known_places;
    /// The same, in space alone: corners of a way of the level vehicle, from the first one after the start to one in
    /// the goal region, along which the tree grows first.
    std::vector<Configuration> known_way;
    bool stop_at_first_solution = false;
    std::optional<double> enough_cost;  ///< a plan that costs no more ends the search; of a single goal; rrt-star only
    /// Also says where a plan can be left for a hover, and prefers plans that can be left for more of their time to
    /// cheaper ones; takes a moment for each plan that counts.
    bool finds_stops = false;
    bool keep_tree = false;  ///< also gives the search tree
    /// Reuses a map of the same problem, else std::invalid_argument. The search fills what it needs of it.
    std::shared_ptr<const typename Family::Effects> map;
    /// Without a map of the caller's: folder from which a map's blocks are read, and in which those that the search
    /// filled are kept; empty: nowhere.
    std::filesystem::path map_cache;
};
using SolveOptions = SolveOptionsOf<planning::Plane>;

}  // namespace downwash
