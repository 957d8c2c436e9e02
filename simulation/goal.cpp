#include "downwash/simulation/goal.hpp"

#include <cmath>

#include "downwash/base/lane_math.hpp"
#include "downwash/dynamics/rigid_body.hpp"

namespace downwash {
namespace {

double angle_between(double a_rad, double b_rad) {
    return std::abs(lane::wrap_angle(a_rad - b_rad));
}

GoalError end_effector_error(const EndEffectorGoal& goal, const PlantModel& model, const double q[4]) {
    const auto attitude = dynamics::attitude(model, q[2], q[3]);
    const auto tip = dynamics::end_effector_position(model, attitude, q[0], q[1]);
    const double dx = tip.x - goal.x_m;
    const double dz = tip.z - goal.z_m;
    return {std::sqrt(dx * dx + dz * dz), goal.direction_rad ? angle_between(q[2] + q[3], *goal.direction_rad) : 0};
}

GoalError configuration_error(const ConfigurationGoal& goal, const double q[4]) {
    const double dx = goal.x_m ? q[0] - *goal.x_m : 0;
    const double dz = goal.z_m ? q[1] - *goal.z_m : 0;
    return {std::sqrt(dx * dx + dz * dz), goal.arm_rad ? angle_between(q[3], *goal.arm_rad) : 0};
}

}  // namespace

GoalError goal_error(const Goal& goal, const PlantModel& model, const double q[4]) {
    return goal.end_effector ? end_effector_error(*goal.end_effector, model, q)
                             : configuration_error(goal.configuration.value_or(ConfigurationGoal{}), q);
}

bool is_met(const Goal& goal, const GoalError& error) {
    if (goal.end_effector) {
        return error.distance_m <= goal.end_effector->tolerance_m &&
               error.angle_rad <= goal.end_effector->direction_tolerance_rad;
    }
    return goal.configuration && error.distance_m <= goal.configuration->tolerance_m &&
           error.angle_rad <= goal.configuration->tolerance_rad;
}

}  // namespace downwash
