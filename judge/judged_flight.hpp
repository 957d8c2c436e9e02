#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/scene/planar_pose.hpp"
#include "downwash/simulation/world.hpp"

namespace downwash::judge {

/// How a flight ends, by the judge's own rules (docs/model.md 7.1).
enum class Outcome : std::uint8_t { ok, collision, unstable, left_flyable_area, goal_missed, over_budget };

/// The name in files: "left_flyable_area".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(Outcome outcome) noexcept;

/// A vehicle at a control tick.
struct JudgedRow {
    double t_s = 0;
    PlanarPose pose;
    double vx_m_s = 0, vz_m_s = 0;
    double reference_x_m = 0, reference_z_m = 0, reference_arm_rad = 0;
    double clearance_m = std::numeric_limits<double>::infinity();
    double energy_j = 0;
};

/// What became of a goal.
struct JudgedGoal {
    bool is_met = false;
    double error_m = 0;  ///< worst over the last second of its hover and of that after its touch, or where the flight
                         ///< ended before
    std::optional<double> touch_force_n;  ///< mean normal force over the hold of its touch; 0 if it was not held
};

/// The figures of one flight of a plan, hover included.
struct JudgedFlight {
    Outcome outcome = Outcome::ok;
    bool is_lateral_collision = false;  ///< in its plane, at the same pose, the vehicle would have touched nothing
    double min_clearance_m = std::numeric_limits<double>::infinity();  ///< 0 on contact; infinity without obstacles
    double energy_j = 0;
    double duration_s = 0;
    double length_m = 0;            ///< see CostFigures
    double clearance_integral = 0;  ///< [s/m]
    double goal_error_m = 0;        ///< worst of all goals over the last second of its hover
    double max_tracking_error_m = 0;
    std::vector<JudgedGoal> goals;  ///< one for each, in their order
    std::vector<JudgedRow> rows;    ///< one per control tick

    /// By an objective.
    [[nodiscard]] double cost(const CostFunction& objective) const noexcept {
        CostFigures figures;
        figures.length_m = length_m;
        figures.energy_j = energy_j;
        figures.time_s = duration_s;
        figures.clearance_integral = clearance_integral;
        return objective(figures);
    }
};

/// How to fly.
struct FlightConditions {
    bool aero = true;            ///< false: surfaces have no effect on the rotors
    std::optional<World> world;  ///< Empty: everything is nominal. In a world the vehicle has hovered at its start
};

}  // namespace downwash::judge
