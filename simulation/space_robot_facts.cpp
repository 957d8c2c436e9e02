#include "downwash/simulation/space_robot_facts.hpp"

#include <cmath>

#include "downwash/dynamics/plant_model.hpp"
#include "downwash/simulation/space_statics.hpp"

namespace downwash {

SpaceRobotFacts space_robot_facts(const SpaceRobot& robot) {
    SpaceRobotFacts facts;
    facts.mass_kg = robot.mass_kg();
    facts.joints = robot.joints();
    const double weight_n = facts.mass_kg * standard_gravity_m_s2;
    // Shares are linear in where the weight acts.
    const std::vector<double> middle = thrust_shares(robot.plant, {});
    const std::vector<double> forward = thrust_shares(robot.plant, {1, 0, 0});
    const std::vector<double> left = thrust_shares(robot.plant, {0, 1, 0});
    for (std::size_t k = 0; k < robot.plant.rotors.size(); ++k) {
        const Vector3& axis = robot.plant.rotors[k].axis;
        facts.thrust_to_weight += robot.max_thrust_n[k] * axis[2] / std::sqrt(dot(axis, axis)) / weight_n;
        const WorstPose worst = worst_pose(robot, [&](const std::vector<double>& joints_rad) {
            const Vector3 at_m = center_of_mass_m(robot, arm_pose(robot, joints_rad));
            const double share = middle[k] + at_m[0] * (forward[k] - middle[k]) + at_m[1] * (left[k] - middle[k]);
            return share * weight_n / robot.max_thrust_n[k];
        });
        constexpr double rounding = 1e-9;  // of rotors that carry the same
        if (worst.value > facts.hover_share * (1 + rounding)) {
            facts.hover_share = worst.value;
            facts.hover_rotor = k;
            facts.hover_joints_rad = worst.joints_rad;
        }
    }
    facts.reach_m = arm_reach_m(robot);
    return facts;
}

}  // namespace downwash
