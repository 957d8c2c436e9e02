#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/controllers/configuration.hpp"
#include "downwash/controllers/space_configuration.hpp"

namespace downwash {

/// What a search came to.
enum class Status : std::uint8_t {
    none,         ///< not even a first step
    approximate,  ///< the best there is does not reach the goal
    solved,       ///< the planner's own model reaches the goal and holds there
};

/// A moment at which the best plan became cheaper.
struct Improvement {
    double wall_s = 0;
    std::uint64_t iteration = 0;
    double cost = 0;                   ///< by the planner's own model
    std::optional<double> flown_cost;  ///< cost of its flight with direct aerodynamics, if that was checked
};

/// What stood between a search and its goal: of the ways into the goal region that were rejected, holds included, the
/// one that came nearest. `direct_flight`, if it had plans: where the flight of the one that was discarded last came
/// nearest to an obstacle or, if that is not why, ended. `unfinished_flight` and `unfinished_certificate`: the search
/// ended before it was known whether that plan counts.
template <class Configuration>
struct BasicObstruction {
    std::string cause;           ///< as in SearchRecord::rejected
    Configuration at;            ///< where it was rejected
    double goal_distance_m = 0;  ///< from there to the goal region; 0 inside
    /// Labels of obstacles (label_of): the one that was nearest where an obstacle is the cause; with the cause
    /// `closed_plane` those that no way passes.
    std::vector<std::string> obstacles = {};
};
using Obstruction = BasicObstruction<Configuration>;
using SpaceObstruction = BasicObstruction<SpaceConfiguration>;

/// How many edges each obstacle stopped as a collision, by its number in the problem.
using StoppedBy = std::map<std::size_t, std::uint64_t>;

/// What became of the candidates of a search: plans that its own model accepts, each cheaper than the best before it.
struct Candidates {
    std::uint64_t checked = 0;
    std::uint64_t failed_execution = 0;    ///< discarded after their execution with direct aerodynamics
    std::uint64_t failed_certificate = 0;  ///< discarded because they failed in too many worlds
    std::uint64_t worse_stops = 0;         ///< discarded because they can be left for a hover for less of their time
    std::uint64_t unfinished = 0;          ///< discarded because the search ended before their flights did
    // The others count or, when executed, were no better than one before.

    /// Discarded for what they do, not for lack of time.
    [[nodiscard]] std::uint64_t rejected() const noexcept {
        return failed_execution + failed_certificate + worse_stops;
    }
};

/// How a search went.
struct SearchRecord {
    double wall_s = 0;        ///< time of the search, direct flights of better plans included
    double setup_wall_s = 0;  ///< before it: checks of the problem, scene, and reading the map
    /// Reading the aero map from the cache, and what the threads together spent on filling it, mostly during the
    /// search.
    double map_wall_s = 0;
    std::optional<double> first_solution_wall_s;   ///< first plan that the planner's own model accepted
    std::optional<double> first_certified_wall_s;  ///< first plan that got its certificate
    std::uint64_t iterations = 0;
    std::uint64_t edges_simulated = 0;
    double simulated_s = 0;            ///< flight time simulated, not counting direct flights
    std::uint64_t states_checked = 0;  ///< collision queries of single states
    std::vector<Improvement> improvements;
    std::map<std::string, std::uint64_t> rejected;  ///< by cause: collision, flyable_area, saturation, ...
    /// Edges that collisions stopped, by the label of the nearest obstacle (label_of); of OMPL's planners on lines,
    /// states and motions.
    std::map<std::string, std::uint64_t> stopped_by;
    Candidates candidates;  ///< what became of plans before one of them was reported
};

/// A node of the tree that a search has grown.
template <class Configuration>
struct BasicTreeNode {
    static constexpr int no_parent = -1;

    Configuration at;
    int parent = no_parent;  ///< number of the parent in the same list
};
using TreeNode = BasicTreeNode<Configuration>;
using SpaceTreeNode = BasicTreeNode<SpaceConfiguration>;

/// Name as in solution files: "solved".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(Status status);

}  // namespace downwash
