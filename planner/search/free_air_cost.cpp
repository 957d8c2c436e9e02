#include "downwash/search/free_air_cost.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "downwash/dynamics/flight_step.hpp"
#include "downwash/simulation/space_place.hpp"
#include "downwash/simulation/space_statics.hpp"

namespace downwash::planning {

double hover_power_w(const FlightModel& model) {
    const PlantModel& plant = model.tick().plant;
    double thrust_n[max_rotors];
    dynamics::allocate(plant, plant.total_mass_kg * standard_gravity_m_s2, 0.0, thrust_n);
    return dynamics::rotor_power(plant, thrust_n);
}

double hover_power_w(const SpaceProblemModel& model) {
    const SpaceRobot& robot = model.problem().robot;
    std::vector<double> joints_rad = model.problem().start.joints_rad;
    joints_rad.resize(robot.plant.links.size());
    const double weight_n = robot.mass_kg() * standard_gravity_m_s2;
    double power_w = 0;
    for (const double share : thrust_shares(robot.plant, center_of_mass_m(robot, arm_pose(robot, joints_rad)))) {
        const double thrust_n = std::max(0.0, share * weight_n);
        power_w += robot.plant.power_coefficient_w_n1p5 * thrust_n * std::sqrt(thrust_n);
    }
    return power_w;
}

template <class Family>
FreeAirCostOf<Family>::FreeAirCostOf(const SearchTask& task)
    : objective_(task.problem.planner.objective),
      counts_clearance_(objective_.weight(Objective::clearance) > 0),
      model_(task.model),
      space_(task.space),
      limits_(motion_limits_of(task.problem)),
      hover_power_w_(hover_power_w(task.model)) {}

template <>
double FreeAirCostOf<Plane>::of_motion(const Configuration& from, const Configuration& to) const {
    const double turn = space_.turn_rad(from, to);
    double way[max_axes];
    std::transform(to.coordinate.begin(), to.coordinate.end(), from.coordinate.begin(), way, std::minus{});
    const double duration_s = rest_to_rest_duration_s(space_.travel_m(from, to), turn, limits_along(limits_, way));
    const double density = counts_clearance_ ? mean_clearance_density(from, space_.seen_from(from, to)) : 0;
    return objective_({{space_.distance_m(from, to)}, hover_power_w_ * duration_s, duration_s, duration_s * density});
}

template <>
double FreeAirCostOf<Plane>::min_cost_of_motion(const Configuration& from, const Configuration& to) const {
    const double turn = space_.turn_rad(from, to);
    const double duration_s = peak_over_mean_speed * std::max(space_.travel_m(from, to) / limits_.max_speed_m_s,
                                                              turn / limits_.max_arm_rate_rad_s);
    // Far from everything clearance costs next to nothing.
    return objective_({{space_.distance_m(from, to)}, hover_power_w_ * duration_s, duration_s, 0});
}

template <>
double FreeAirCostOf<Plane>::min_cost_to_goal(const Configuration& from) const {
    double least = HUGE_VAL;
    for (const Goal& goal : alternatives(space_.goal())) {
        // What the tolerance leaves open may stay; the tip moves with the vehicle and with the arm.
        const GoalError off = space_.error_beyond_tolerance(goal, from);
        const bool has_tip = part_of(goal) == GoalPart::end_effector;
        const double tip_speed_m_s =
            limits_.max_speed_m_s + (has_tip ? 2 * space_.arm_weight_m() * limits_.max_arm_rate_rad_s : 0);
        const double duration_s =
            peak_over_mean_speed * std::max(off.distance_m / tip_speed_m_s, off.angle_rad / limits_.max_arm_rate_rad_s);
        // A tip moves by at most d + 2 w darm where the length is sqrt(d^2 + (w darm)^2).
        const double length_m = has_tip ? off.distance_m / std::sqrt(5.0) : off.distance_m;
        const double all_s = duration_s + goal.hold_s;
        least = std::min(least, objective_({{length_m}, hover_power_w_ * all_s, all_s, 0}));
    }
    return least;
}

template <>
double FreeAirCostOf<Space>::of_motion(const Configuration& from, const Configuration& to) const {
    const double duration_s = space_.duration_s(from, to);
    const double density = counts_clearance_ ? mean_clearance_density(from, space_.seen_from(from, to)) : 0;
    return objective_({{space_.travel_m(from, to)}, hover_power_w_ * duration_s, duration_s, duration_s * density});
}

template <>
double FreeAirCostOf<Space>::min_cost_of_motion(const Configuration& from, const Configuration& to) const {
    const double duration_s = peak_over_mean_speed * space_.duration_at_limits_s(from, to);
    return objective_({{space_.travel_m(from, to)}, hover_power_w_ * duration_s, duration_s, 0});
}

template <>
double FreeAirCostOf<Space>::min_cost_to_goal(const Configuration& from) const {
    double least = HUGE_VAL;
    for (const SpaceSearchSpace::Approach& goal : space_.approaches(from)) {
        const double all_s = peak_over_mean_speed * goal.duration_at_limits_s + goal.hold_s;
        least = std::min(least, objective_({{goal.length_m}, hover_power_w_ * all_s, all_s, 0}));
    }
    return least;
}

template <class Family>
double FreeAirCostOf<Family>::of_hold(const Configuration& at, double hold_s) const {
    const double density = counts_clearance_ ? clearance_density(at) : 0;
    return objective_({{}, hover_power_w_ * hold_s, hold_s, hold_s * density});
}

template <class Family>
double FreeAirCostOf<Family>::clearance_density(const Configuration& at) const {
    return downwash::clearance_density(model_.collisions().clearance_m(level_at(at)));
}

template <class Family>
double FreeAirCostOf<Family>::mean_clearance_density(const Configuration& from, const Configuration& to) const {
    constexpr double spacing_m = 0.25;
    const int pieces = static_cast<int>(std::ceil(space_.distance_m(from, to) / spacing_m)) + 1;
    double sum = 0;
    for (int i = 0; i < pieces; ++i) {
        sum += clearance_density(between(from, to, (i + 0.5) / pieces));
    }
    return sum / pieces;
}

template class FreeAirCostOf<Plane>;
template class FreeAirCostOf<Space>;

}  // namespace downwash::planning
