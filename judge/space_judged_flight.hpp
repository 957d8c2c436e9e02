#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "downwash/base/vector3.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/judge/judged_flight.hpp"

namespace downwash::judge {

/// Where a vehicle in space is and how it moves. Joints that it lacks stay at zero.
struct SpaceJudgedMotion {
    Vector3 position_m{};                        ///< of the point that the robot file calls the centre of mass, world
    std::array<double, 4> attitude{1, 0, 0, 0};  ///< quaternion (w, x, y, z) from body to world, of any length but zero
    std::array<double, max_joints> joints_rad{};
    Vector3 velocity_m_s{};      ///< of that point, world axes
    Vector3 body_rates_rad_s{};  ///< body axes
    std::array<double, max_joints> joint_rates_rad_s{};
};

/// A vehicle in space at a control tick.
struct SpaceJudgedRow {
    double t_s = 0;
    SpaceJudgedMotion motion;
    SpacePoint reference;
    double clearance_m = std::numeric_limits<double>::infinity();  ///< to obstacles
    double energy_j = 0;
};

/// What the vehicle itself could record of a control tick.
struct SpaceJudgedRecord {
    SpaceJudgedMotion seen;               ///< by its controller: late, with bias and noise
    std::vector<double> rotor_command_n;  ///< free-air thrust of each rotor, held until the next tick
    std::vector<double> joint_torque_nm;  ///< of each joint, held until the next tick
};

/// A touch in flight.
struct SpaceJudgedTouch {
    double force_n = 0;         ///< mean normal force over the hold; 0 if it was not held
    Vector3 place_m{};          ///< middle of what touched as the hold began, in the nominal scene
    double slip_m = 0;          ///< farthest along the surface over the hold
    bool is_force_met = false;  ///< over every second of the hold
    bool is_place_met = false;  ///< near the wanted place, if there is one, and without a slip
    bool is_free = false;       ///< the robot came off the surface again
};

/// What became of a goal.
struct SpaceJudgedGoal {
    bool is_met = false;
    double error_m = 0;  ///< worst over the last second of its hover, or where the flight ended before
    std::optional<SpaceJudgedTouch> touch;
};

/// The figures of one flight of a plan in space, hover included.
struct SpaceJudgedFlight {
    Outcome outcome = Outcome::ok;
    bool is_self_collision = false;                                    ///< of a collision: the robot touched itself
    double min_clearance_m = std::numeric_limits<double>::infinity();  ///< 0 on contact; infinity without obstacles
    double energy_j = 0;
    double duration_s = 0;
    double max_tracking_error_m = 0;
    std::vector<SpaceJudgedGoal> goals;  ///< one for each that was asked for
    std::vector<SpaceJudgedRow> rows;    ///< one per control tick
    /// One per control tick where the conditions ask for them; the last row, in which nothing is commanded, has none.
    std::vector<SpaceJudgedRecord> records;
};

}  // namespace downwash::judge
