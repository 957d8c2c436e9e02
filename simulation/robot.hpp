#pragma once

#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/controllers/control_law.hpp"
#include "downwash/dynamics/plant.hpp"
#include "downwash/scene/shapes.hpp"
#include "downwash/simulation/uncertainty.hpp"

namespace downwash {

/// An aerial manipulator: bodies, rotors, arm and the controller that flies it.
struct Robot {
    std::string name;
    MultirotorParameters multirotor;
    std::vector<BodyShape> body;
    RotorParameters rotors;
    ArmParameters arm;
    Controller controller;
    /// How well vehicle and sensors are known. Where a problem file has an uncertainty, this is its default; flights
    /// depend on Problem::uncertainty alone.
    std::optional<Uncertainty> uncertainty;

    /// Total mass [kg].
    [[nodiscard]] double mass_kg() const noexcept { return multirotor.mass_kg + arm.mass_kg; }
    /// The parts of the robot that can touch an obstacle.
    [[nodiscard]] RobotShape shape() const { return {body, arm.joint_x_m, arm.joint_z_m, arm.length_m, arm.radius_m}; }
};

/// What makes a robot impossible to fly: numbers out of range, a rotor layout of lower rank, rotors that cannot lift
/// the weight. Keys are relative to the robot ("rotors.positions_m"). Empty when the robot is sound.
[[nodiscard]] DOWNWASH_EXPORT std::vector<KeyError> robot_errors(const Robot& robot);

}  // namespace downwash
