#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "downwash/scene/shape_parameters.hpp"
#include "downwash/simulation/robot.hpp"
#include "downwash/simulation/robot_parameters.hpp"
#include "downwash/simulation/world_numbers.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash {
namespace {

std::string rounded(double value) {
    return to_text(value, 4);
}

double weight_n(const Robot& robot) {
    return robot.mass_kg() * standard_gravity_m_s2;
}

std::vector<KeyError> missing_bodies(const Robot& robot) {
    if (!robot.body.empty()) {
        return {};
    }
    return {
        {"multirotor.body", "is empty: expected at least one box, cylinder or sphere that encloses the multirotor"}};
}

std::vector<KeyError> shapeless_cylinders(const Robot& robot) {
    return shape_errors(robot.body, "multirotor.body");
}

std::vector<KeyError> unusable_rotor_layout(const Robot& robot) {
    const auto& hubs = robot.rotors.positions_m;
    if (hubs.size() < 2 || hubs.size() > max_rotors) {
        return {{"rotors.positions_m", "has " + std::to_string(hubs.size()) +
                                           (hubs.size() == 1 ? " rotor" : " rotors") + ": expected 2 to " +
                                           std::to_string(max_rotors)}};
    }
    const auto [rear, front] =
        std::minmax_element(hubs.begin(), hubs.end(), [](const Vector3& a, const Vector3& b) { return a[0] < b[0]; });
    if ((*front)[0] - (*rear)[0] < 0.01 * robot.rotors.radius_m) {
        return {{"rotors.positions_m",
                 "gives every rotor the same x: without a lever they cannot turn the vehicle in "
                 "pitch; place rotors in front of and behind the centre of mass"}};
    }
    if ((*front)[0] <= 0 || (*rear)[0] >= 0) {
        return {{"rotors.positions_m",
                 "has all rotors on one side of the centre of mass (x = 0): thrust that carries "
                 "the weight would turn the vehicle over"}};
    }
    return {};
}

std::vector<KeyError> crossed_thrust_limits(const Robot& robot) {
    if (robot.rotors.min_thrust_n < robot.rotors.max_thrust_n) {
        return {};
    }
    return {{"rotors.min_thrust_n", "is " + to_text(robot.rotors.min_thrust_n) +
                                        ": expected less than max_thrust_n, which is " +
                                        to_text(robot.rotors.max_thrust_n)}};
}

std::vector<KeyError> too_little_thrust(const Robot& robot) {
    const double count = static_cast<double>(robot.rotors.positions_m.size());
    const double greatest_n = count * robot.rotors.max_thrust_n;
    if (greatest_n > weight_n(robot)) {
        return {};
    }
    constexpr double far_too_heavy = 20;
    const bool may_be_grams = weight_n(robot) > far_too_heavy * greatest_n;
    return {{"rotors.max_thrust_n", "gives " + rounded(greatest_n) + " N with " + rounded(count) +
                                        " rotors, which cannot lift the weight of " + rounded(weight_n(robot)) +
                                        " N: " + rounded(weight_n(robot) - greatest_n) +
                                        " N are missing; expected more than " + rounded(weight_n(robot) / count) +
                                        " N a rotor" +
                                        (may_be_grams ? "; masses are in kilograms, not in grams" : "")}};
}

std::vector<KeyError> too_much_thrust(const Robot& robot) {
    const double count = static_cast<double>(robot.rotors.positions_m.size());
    const double min_n = count * robot.rotors.min_thrust_n;
    if (min_n < weight_n(robot)) {
        return {};
    }
    return {{"rotors.min_thrust_n", "gives " + rounded(min_n) + " N with " + rounded(count) +
                                        " rotors, more than the weight of " + rounded(weight_n(robot)) +
                                        " N: the vehicle could not descend"}};
}

std::vector<KeyError> impossible_inertia(const Robot& robot) {
    double extent_m = robot.rotors.radius_m;
    for (const Vector3& hub_m : robot.rotors.positions_m) {
        extent_m = std::max(extent_m, std::hypot(hub_m[0], hub_m[2]) + robot.rotors.radius_m);
    }
    const double greatest = robot.multirotor.mass_kg * extent_m * extent_m;
    if (robot.multirotor.pitch_inertia_kg_m2 <= greatest) {
        return {};
    }
    return {{"multirotor.pitch_inertia_kg_m2",
             "is more than its whole mass at the outermost rotor tips would have (" + rounded(greatest) + " kg m2)"}};
}

std::vector<KeyError> impossible_arm_inertia(const Robot& robot) {
    const double extent_m = robot.arm.length_m + robot.arm.radius_m;
    const double greatest = robot.arm.mass_kg * extent_m * extent_m;
    if (robot.arm.inertia_kg_m2 <= greatest) {
        return {};
    }
    return {{"arm.inertia_kg_m2",
             "is more than the arm's whole mass at its full length would have (" + rounded(greatest) + " kg m2)"}};
}

std::vector<KeyError> outlying_center_of_mass(const Robot& robot) {
    if (robot.arm.center_of_mass_m <= robot.arm.length_m) {
        return {};
    }
    return {{"arm.center_of_mass_m", "is " + to_text(robot.arm.center_of_mass_m) +
                                         ": expected at most the arm's length, " + to_text(robot.arm.length_m) + " m"}};
}

std::vector<KeyError> crossed_arm_limits(const Robot& robot) {
    if (!robot.arm.is_limited || robot.arm.lower_limit_rad <= robot.arm.upper_limit_rad) {
        return {};
    }
    return {
        {"arm.limits_deg", "is [" + rounded(robot.arm.lower_limit_rad * degrees_per_radian) + ", " +
                               rounded(robot.arm.upper_limit_rad * degrees_per_radian) +
                               "]: expected [lower, upper], the lower limit below the upper one, or both the same"}};
}

std::vector<KeyError> weak_joint(const Robot& robot) {
    const double level_nm = robot.arm.mass_kg * standard_gravity_m_s2 * robot.arm.center_of_mass_m;
    if (level_nm <= robot.arm.max_torque_nm) {
        return {};
    }
    return {{"arm.max_torque_nm", "is " + to_text(robot.arm.max_torque_nm) +
                                      ", too little to hold the arm level: expected at least " + rounded(level_nm) +
                                      " Nm"}};
}

/// One Runge-Kutta step of a tick follows a lag only when it is no faster than about a third of the tick.
std::vector<KeyError> too_short_lag(const Robot& robot) {
    const double least_s = 0.5 / robot.controller.rate_hz;
    if (robot.rotors.time_constant_s == 0 || robot.rotors.time_constant_s >= least_s) {
        return {};
    }
    return {{"rotors.time_constant_s", "is " + to_text(robot.rotors.time_constant_s) +
                                           ": expected 0 for no lag, or at least half a control tick, " +
                                           rounded(least_s) + " s"}};
}

std::vector<KeyError> too_long_delay(const Robot& robot) {
    if (robot.controller.delay_s * robot.controller.rate_hz <= simulation::max_delay_ticks) {
        return {};
    }
    return {{"controller.delay_s",
             "is " + to_text(robot.controller.delay_s) + ": expected at most " +
                 std::to_string(simulation::max_delay_ticks) + " control ticks, " +
                 rounded(simulation::max_delay_ticks / robot.controller.rate_hz) + " s; a controller.rate_hz of " +
                 rounded(std::floor(simulation::max_delay_ticks / robot.controller.delay_s)) + " or less would do"}};
}

std::vector<KeyError> wash_without_drag(const Robot& robot) {
    if (!robot.arm.wash || robot.arm.drag.is_any()) {
        return {};
    }
    return {{"arm.wash", "acts through the drag of the arm, and it has none: expected arm.drag as well"}};
}

std::vector<KeyError> unflyable_uncertainty(const Robot& robot) {
    return robot.uncertainty ? uncertainty_errors(*robot.uncertainty, robot) : std::vector<KeyError>();
}

const std::array<Check<Robot>, 15> checks{{
    {{"multirotor.body"}, missing_bodies},
    {{"multirotor.body"}, shapeless_cylinders},
    {{"rotors.positions_m", "rotors.radius_m"}, unusable_rotor_layout},
    {{"rotors.min_thrust_n", "rotors.max_thrust_n"}, crossed_thrust_limits},
    {{"rotors.positions_m", "rotors.max_thrust_n", "multirotor.mass_kg", "arm.mass_kg"}, too_little_thrust},
    {{"rotors.positions_m", "rotors.min_thrust_n", "multirotor.mass_kg", "arm.mass_kg"}, too_much_thrust},
    {{"multirotor.pitch_inertia_kg_m2", "multirotor.mass_kg", "rotors.positions_m", "rotors.radius_m"},
     impossible_inertia},
    {{"rotors.time_constant_s", "controller.rate_hz"}, too_short_lag},
    {{"controller.delay_s", "controller.rate_hz"}, too_long_delay},
    {{"arm.inertia_kg_m2", "arm.mass_kg", "arm.length_m", "arm.radius_m"}, impossible_arm_inertia},
    {{"arm.center_of_mass_m", "arm.length_m"}, outlying_center_of_mass},
    {{"arm.limits_deg"}, crossed_arm_limits},
    {{"arm.max_torque_nm", "arm.mass_kg", "arm.center_of_mass_m"}, weak_joint},
    {{"arm.wash", "arm.drag"}, wash_without_drag},
    {{"uncertainty", "rotors.time_constant_s", "controller"}, unflyable_uncertainty},
}};

}  // namespace

std::vector<KeyError> further_robot_errors(const Robot& robot, WrongKeys& wrong, std::string_view prefix) {
    std::vector<KeyError> errors = value_errors(robot_parameters(), robot, prefix, wrong);
    append(errors, run_checks(std::span<const Check<Robot>>(checks), robot, prefix, wrong));
    return errors;
}

std::vector<KeyError> robot_errors(const Robot& robot) {
    WrongKeys wrong;
    return further_robot_errors(robot, wrong, "");
}

}  // namespace downwash
