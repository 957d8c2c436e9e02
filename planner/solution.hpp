#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/controllers/reference_segment.hpp"
#include "downwash/planner/problem.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash {

/// A corner of a plan: plane coordinates [m], arm angle relative to the multirotor, unwrapped [rad].
struct Waypoint {
    double x_m = 0;
    double z_m = 0;
    double arm_rad = 0;
};

/// A timed reference for (x, z, arm) and the corners that it runs through.
struct Plan {
    std::vector<Waypoint> waypoints;
    std::vector<ReferenceKnot> reference;  ///< one knot per waypoint; the first at tick 0
    double tick_s = 0;                     ///< length of a control tick

    [[nodiscard]] double duration_s() const {
        return reference.empty() ? 0 : static_cast<double>(reference.back().tick) * tick_s;
    }
};

/// Plans longer than this many control ticks, the last hold apart, are not looked for: an hour at 100 Hz.
inline constexpr std::int64_t most_plan_ticks = 360000;

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
    std::optional<double> flown_cost;  ///< of its flight with direct aerodynamics; mp-arm-ada only
};

/// What stood between a search and its goal: of the ways into the goal region that were refused, holds included, the
/// one that came nearest. `direct_flight`, if it had plans: where the flight of the one that was discarded last came
/// nearest to an obstacle or, if that is not why, ended.
struct Obstruction {
    std::string cause;           ///< as in SearchRecord::rejected
    Waypoint at;                 ///< where it was refused
    double goal_distance_m = 0;  ///< from there to the goal region; 0 inside
};

/// How a search went.
struct SearchRecord {
    double wall_s = 0;                            ///< of the search, direct flights of better plans included
    double setup_wall_s = 0;                      ///< before it: checks of the problem, scene and aero map
    double map_wall_s = 0;                        ///< of that, spent on the aero map
    double flight_wall_s = 0;                     ///< spent on the direct flight of the reported plan
    std::optional<double> first_solution_wall_s;  ///< first plan that the planner's own model accepted
    std::uint64_t iterations = 0;
    std::uint64_t edges_simulated = 0;
    double simulated_s = 0;            ///< flight time simulated, not counting direct flights
    std::uint64_t states_checked = 0;  ///< collision queries of single states
    std::vector<Improvement> improvements;
    std::map<std::string, std::uint64_t> rejected;  ///< by cause: collision, flyable_area, saturation, ...
    /// Of a search that found no plan: how near to the goal region the vehicle was brought [m], and, of a search by
    /// flights, what stopped it there.
    std::optional<double> nearest_approach_m;
    std::optional<Obstruction> obstruction;
};

/// A node of the tree that a search has grown.
struct TreeNode {
    static constexpr int no_parent = -1;

    Waypoint at;
    int parent = no_parent;  ///< in the same list
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
    std::shared_ptr<const AeroMap> map;  ///< that the search flew in, for SolveOptions::map of another; empty: none
    std::vector<TreeNode> tree;          ///< of the search, one after the other if it took several; if asked for
    std::optional<Plan> plan;            ///< empty with Status::none
    std::optional<Execution> execution;  ///< the whole plan flown from the start with direct aerodynamics
};

/// Name as in problem files: "mp-arm-ada".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(Variant variant);
/// Name as in solution files: "solved".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(Status status);

/// What an executed flight costs.
[[nodiscard]] DOWNWASH_EXPORT double cost_of(const Execution& execution, const CostFunction& objective);

}  // namespace downwash
