#pragma once

#include <cstddef>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/simulation/space_robot.hpp"

namespace downwash {

/// What a robot in space amounts to: numbers by which a user sees whether it is the one that was meant.
struct SpaceRobotFacts {
    double mass_kg = 0;           ///< multirotor and arm
    double thrust_to_weight = 0;  ///< greatest thrust of all rotors along the body's z over the weight
    int joints = 0;
    double reach_m = 0;  ///< farthest that the end effector gets from the multirotor's centre of mass
    /// Greatest share of its largest thrust that any rotor needs for a level hover in free air, in any pose of the arm
    /// that was tried; above 1 it cannot hover there.
    double hover_share = 0;
    std::size_t hover_rotor = 0;  ///< that rotor, from 0
    std::vector<double> hover_joints_rad;
};

/// @pre space_robot_errors(robot) is empty
[[nodiscard]] DOWNWASH_EXPORT SpaceRobotFacts space_robot_facts(const SpaceRobot& robot);

}  // namespace downwash
