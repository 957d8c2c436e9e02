#pragma once

#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/controllers/space_law.hpp"
#include "downwash/dynamics/space_plant.hpp"
#include "downwash/scene/space_robot_shape.hpp"
#include "downwash/simulation/uncertainty.hpp"

namespace downwash {

/// Limits and shapes of a link of an arm in space.
struct SpaceLinkLimits {
    double lower_limit_rad = 0, upper_limit_rad = 0;  ///< of its joint, when it is limited
    bool is_limited = false;
    double max_torque_nm = 0;          ///< of its joint, > 0
    std::vector<SpaceBodyShape> body;  ///< in its own axes, from its joint
};

/// An aerial manipulator in space: bodies, rotors, arm and the controller that flies it.
struct SpaceRobot {
    std::string name;
    SpacePlant plant;
    std::vector<SpaceBodyShape> body;                ///< of the multirotor, in its frame
    std::vector<SpaceLinkLimits> links;              ///< one for each link of the plant
    double rotor_radius_m = 0;                       ///< > 0
    std::vector<double> min_thrust_n, max_thrust_n;  ///< of each rotor: least command, >= 0, and greatest, > least
    Vector3 tool_direction = {1, 0, 0};  ///< where the end effector points, in the last link's axes; of length 1
    SpaceController controller;
    std::optional<Uncertainty> uncertainty;

    [[nodiscard]] int joints() const noexcept { return static_cast<int>(plant.links.size()); }
    /// Total mass [kg].
    [[nodiscard]] double mass_kg() const noexcept {
        double sum_kg = plant.multirotor.mass_kg;
        for (const SpaceLink& link : plant.links) {
            sum_kg += link.body.mass_kg;
        }
        return sum_kg;
    }
};

/// What of a robot can touch something: its bodies, at the joints of its arm.
[[nodiscard]] DOWNWASH_EXPORT SpaceRobotShape shape_of(const SpaceRobot& robot);

/// What makes a robot impossible to fly: numbers out of range, an inertia that no body has, rotors that cannot turn the
/// vehicle or lift the weight, joints too weak to hold the arm. Keys are relative to the robot ("rotors.positions_m").
/// Empty when the robot is sound.
[[nodiscard]] DOWNWASH_EXPORT std::vector<KeyError> space_robot_errors(const SpaceRobot& robot);

/// What can fly but is likely not meant: rotors at one place, a pose of the arm in which a rotor would need more than
/// it gives to hover. Keys are relative to the robot. @pre space_robot_errors(robot) is empty
[[nodiscard]] DOWNWASH_EXPORT std::vector<KeyError> space_robot_warnings(const SpaceRobot& robot);

}  // namespace downwash
