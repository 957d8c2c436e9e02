#pragma once

#include <optional>
#include <string>
#include <vector>

#include "downwash/controllers/space_law.hpp"
#include "downwash/dynamics/space_plant.hpp"
#include "downwash/scene/space_shape.hpp"
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
};

}  // namespace downwash
