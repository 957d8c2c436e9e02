#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "downwash/base/direction.hpp"
#include "downwash/base/text.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "downwash/scene/shape_parameters.hpp"
#include "downwash/simulation/space_robot.hpp"
#include "downwash/simulation/space_robot_facts.hpp"
#include "downwash/simulation/space_robot_parameters.hpp"
#include "downwash/simulation/space_statics.hpp"
#include "downwash/simulation/world_numbers.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash {
namespace {

using Errors = std::vector<KeyError>;

std::string rounded(double value) {
    return to_text(value, 4);
}

std::string link_key(std::size_t link, const char* name) {
    return "arm.links[" + std::to_string(link) + "]." + name;
}

double weight_n(const SpaceRobot& robot) {
    return robot.mass_kg() * standard_gravity_m_s2;
}

Errors missing_bodies(const SpaceRobot& robot) {
    if (!robot.body.empty()) {
        return {};
    }
    return {{"multirotor.body",
             "is empty: expected at least one box, cylinder, sphere or capsule that encloses the multirotor"}};
}

Errors shapeless_cylinders(const SpaceRobot& robot) {
    Errors errors = shape_errors(robot.body, "multirotor.body");
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        append(errors, shape_errors(robot.links[i].body, link_key(i, "body")));
    }
    return errors;
}

std::string moments_text(const Vector3& moments) {
    return rounded(moments[0]) + ", " + rounded(moments[1]) + " and " + rounded(moments[2]) + " kg m2";
}

/// What no distribution of mass has. @param key of the inertia
Errors inertia_errors(const Matrix3& inertia, const std::string& key) {
    constexpr double rounding = 1e-6;  // published inertias have few digits
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < row; ++column) {
            const double scale = std::abs(inertia[row][row]) + std::abs(inertia[column][column]);
            if (std::abs(inertia[row][column] - inertia[column][row]) > rounding * scale) {
                return {{key, "is no symmetric matrix: expected the same number in row " + std::to_string(row + 1) +
                                  ", column " + std::to_string(column + 1) + " as in row " +
                                  std::to_string(column + 1) + ", column " + std::to_string(row + 1) +
                                  ", the negative product of inertia of these axes"}};
            }
        }
    }
    const Vector3 moments = principal_moments(inertia);
    if (moments[0] <= 0) {
        return {{key, "has the principal moments " + moments_text(moments) +
                          ": expected three above 0; the products of inertia are too large"}};
    }
    if (moments[2] > (moments[0] + moments[1]) * (1 + rounding)) {
        return {{key, "has the principal moments " + moments_text(moments) +
                          ", which no body has: expected the largest to be at most the sum of the others, " +
                          rounded(moments[0] + moments[1])}};
    }
    return {};
}

Errors impossible_inertia(const SpaceRobot& robot) {
    Errors errors = inertia_errors(robot.plant.multirotor.inertia_kg_m2, "multirotor.inertia_kg_m2");
    for (std::size_t i = 0; i < robot.plant.links.size(); ++i) {
        append(errors, inertia_errors(robot.plant.links[i].body.inertia_kg_m2, link_key(i, "inertia_kg_m2")));
    }
    return errors;
}

Errors too_large_inertia(const SpaceRobot& robot) {
    double extent_m = robot.rotor_radius_m;
    for (const SpaceRotor& rotor : robot.plant.rotors) {
        extent_m = std::max(extent_m, std::sqrt(dot(rotor.position_m, rotor.position_m)) + robot.rotor_radius_m);
    }
    const double greatest = robot.plant.multirotor.mass_kg * extent_m * extent_m;
    const Vector3 moments = principal_moments(robot.plant.multirotor.inertia_kg_m2);
    if (moments[2] <= greatest) {
        return {};
    }
    return {{"multirotor.inertia_kg_m2",
             "is more than its whole mass at the outermost rotor tips would have (" + rounded(greatest) + " kg m2)"}};
}

Errors lost_directions(const SpaceRobot& robot) {
    constexpr const char* remedy = "has no direction: expected a vector other than [0, 0, 0]";
    Errors errors;
    for (std::size_t k = 0; k < robot.plant.rotors.size(); ++k) {
        if (!has_direction(robot.plant.rotors[k].axis)) {
            errors.push_back({"rotors.axes", "of rotor " + std::to_string(k + 1) + " " + remedy});
        }
    }
    for (std::size_t i = 0; i < robot.plant.links.size(); ++i) {
        if (!has_direction(robot.plant.links[i].axis)) {
            errors.push_back({link_key(i, "axis"), remedy});
        }
    }
    if (!has_direction(robot.tool_direction)) {
        errors.push_back({"arm.direction", remedy});
    }
    return errors;
}

Errors too_many_links(const SpaceRobot& robot) {
    if (robot.plant.links.size() <= static_cast<std::size_t>(max_joints)) {
        return {};
    }
    return {{"arm.links", "has " + std::to_string(robot.plant.links.size()) + " links: expected at most " +
                              std::to_string(max_joints)}};
}

/// What the readers of files do not let through.
Errors misfit_lists(const SpaceRobot& robot) {
    Errors errors;
    const std::size_t rotors = robot.plant.rotors.size();
    const auto check = [&](const char* key, std::size_t given, std::size_t expected, const char* of_what) {
        if (given != expected) {
            errors.push_back({key, "has " + std::to_string(given) + " elements: expected " + std::to_string(expected) +
                                       ", one for each " + of_what});
        }
    };
    check("rotors.min_thrust_n", robot.min_thrust_n.size(), rotors, "rotor");
    check("rotors.max_thrust_n", robot.max_thrust_n.size(), rotors, "rotor");
    check("arm.links", robot.links.size(), robot.plant.links.size(), "link of the plant");
    for (const SpaceRotor& rotor : robot.plant.rotors) {
        if (rotor.spin != 1 && rotor.spin != -1) {
            errors.push_back({"rotors.spin", "has " + std::to_string(rotor.spin) + ": expected 1 or -1"});
            break;
        }
    }
    return errors;
}

Errors unusable_rotor_layout(const SpaceRobot& robot) {
    constexpr std::size_t fewest = 4;
    const std::size_t rotors = robot.plant.rotors.size();
    if (rotors < fewest || rotors > max_rotors) {
        return {{"rotors.positions_m", "has " + std::to_string(rotors) + (rotors == 1 ? " rotor" : " rotors") +
                                           ": expected " + std::to_string(fewest) + " to " +
                                           std::to_string(max_rotors)}};
    }
    if (allocation_rank(robot.plant, false) < 3) {
        return {{"rotors.positions_m",
                 "gives the rotors no lever in roll or in pitch: expected hubs that do not lie on one line"}};
    }
    if (allocation_rank(robot.plant, true) < 4) {
        return {{"rotors.spin",
                 "gives torques that cannot turn the vehicle in yaw without turning it in roll or pitch, or changing "
                 "its thrust: expected rotors of both spins around the vehicle, with a torque_ratio_m above 0, or axes "
                 "that are tilted sideways"}};
    }
    const std::vector<double> shares = thrust_shares(robot.plant, {});
    constexpr double rounding = 1e-9;
    const auto least = std::find_if(shares.begin(), shares.end(), [](double share) { return share < -rounding; });
    if (least != shares.end()) {
        const auto rotor = least - shares.begin();
        if (robot.plant.rotors[static_cast<std::size_t>(rotor)].axis[2] < 0) {
            return {{"rotors.axes", "of rotor " + std::to_string(rotor + 1) +
                                        " points down: expected thrust upwards, with x forward, y left and z up; where "
                                        "z is down, y and z have the other sign"}};
        }
        return {{"rotors.positions_m",
                 "would need rotor " + std::to_string(rotor + 1) +
                     " to pull downwards in a hover: expected the multirotor's centre of mass, [0, 0, 0], between the "
                     "hubs"}};
    }
    return {};
}

/// The first two hubs without a distance.
Errors rotors_at_one_place(const SpaceRobot& robot) {
    constexpr double least_m = 1e-3;
    const std::vector<SpaceRotor>& rotors = robot.plant.rotors;
    for (std::size_t k = 1; k < rotors.size(); ++k) {
        for (std::size_t i = 0; i < k; ++i) {
            const Vector3 apart_m = rotors[k].position_m - rotors[i].position_m;
            if (dot(apart_m, apart_m) < least_m * least_m) {
                return {{"rotors.positions_m", "has rotors " + std::to_string(i + 1) + " and " + std::to_string(k + 1) +
                                                   " at one place: expected hubs apart, of coaxial rotors one above "
                                                   "the other"}};
            }
        }
    }
    return {};
}

Errors crossed_thrust_limits(const SpaceRobot& robot) {
    for (std::size_t k = 0; k < robot.plant.rotors.size(); ++k) {
        if (robot.min_thrust_n[k] >= robot.max_thrust_n[k]) {
            return {{"rotors.min_thrust_n", "is " + to_text(robot.min_thrust_n[k]) + " for rotor " +
                                                std::to_string(k + 1) + ": expected less than max_thrust_n, which is " +
                                                to_text(robot.max_thrust_n[k])}};
        }
    }
    return {};
}

/// Force along the body's z if every rotor gives its part of a list.
double lift_n(const SpaceRobot& robot, const std::vector<double>& thrust_n) {
    double sum_n = 0;
    for (std::size_t k = 0; k < robot.plant.rotors.size(); ++k) {
        const Vector3& axis = robot.plant.rotors[k].axis;
        sum_n += thrust_n[k] * axis[2] / std::sqrt(dot(axis, axis));
    }
    return sum_n;
}

Errors too_little_thrust(const SpaceRobot& robot) {
    const double greatest_n = lift_n(robot, robot.max_thrust_n);
    if (greatest_n > weight_n(robot)) {
        return {};
    }
    return {{"rotors.max_thrust_n",
             "lifts " + rounded(greatest_n) + " N with " + std::to_string(robot.plant.rotors.size()) +
                 " rotors, which cannot carry the weight of " + rounded(weight_n(robot)) +
                 " N, arm included: " + rounded(weight_n(robot) - greatest_n) + " N are missing"}};
}

Errors too_much_thrust(const SpaceRobot& robot) {
    const double least_n = lift_n(robot, robot.min_thrust_n);
    if (least_n < weight_n(robot)) {
        return {};
    }
    return {{"rotors.min_thrust_n",
             "lifts " + rounded(least_n) + " N with " + std::to_string(robot.plant.rotors.size()) +
                 " rotors, more than the weight of " + rounded(weight_n(robot)) + " N: the vehicle could not descend"}};
}

Errors crossed_joint_limits(const SpaceRobot& robot) {
    Errors errors;
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        if (robot.links[i].is_limited && robot.links[i].lower_limit_rad > robot.links[i].upper_limit_rad) {
            errors.push_back({link_key(i, "limits_deg"),
                              "is [lower, upper]: expected the lower limit below the upper one, or both the same"});
        }
    }
    return errors;
}

Errors weak_joints(const SpaceRobot& robot) {
    Errors errors;
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        const WorstPose worst = worst_pose(robot, [&](const std::vector<double>& joints_rad) {
            return holding_torque_nm(robot, arm_pose(robot, joints_rad), i);
        });
        const WorstPose other = worst_pose(robot, [&](const std::vector<double>& joints_rad) {
            return -holding_torque_nm(robot, arm_pose(robot, joints_rad), i);
        });
        const WorstPose& most = other.value > worst.value ? other : worst;
        if (most.value > robot.links[i].max_torque_nm) {
            errors.push_back({link_key(i, "max_torque_nm"),
                              "is " + to_text(robot.links[i].max_torque_nm) +
                                  ", too little to hold the arm with joints at " + joints_text(most.joints_rad) +
                                  " deg: expected at least " + rounded(most.value) + " Nm"});
        }
    }
    return errors;
}

/// One Runge-Kutta step of a tick follows a lag only when it is no faster than about a third of the tick.
Errors too_short_lag(const SpaceRobot& robot) {
    const double least_s = 0.5 / robot.controller.rate_hz;
    if (robot.plant.time_constant_s == 0 || robot.plant.time_constant_s >= least_s) {
        return {};
    }
    return {{"rotors.time_constant_s", "is " + to_text(robot.plant.time_constant_s) +
                                           ": expected 0 for no lag, or at least half a control tick, " +
                                           rounded(least_s) + " s"}};
}

Errors too_long_delay(const SpaceRobot& robot) {
    if (robot.controller.delay_s * robot.controller.rate_hz <= simulation::max_delay_ticks) {
        return {};
    }
    return {{"controller.delay_s", "is " + to_text(robot.controller.delay_s) + ": expected at most " +
                                       std::to_string(simulation::max_delay_ticks) + " control ticks, " +
                                       rounded(simulation::max_delay_ticks / robot.controller.rate_hz) + " s"}};
}

Errors spin_without_speed(const SpaceRobot& robot) {
    if (robot.plant.rotor_inertia_kg_m2 == 0 || robot.plant.thrust_coefficient_n_s2 > 0) {
        return {};
    }
    return {{"rotors.spinning_inertia_kg_m2",
             "needs the rotors' speeds: expected rotors.thrust_coefficient_n_s2 above 0 as well"}};
}

Errors wash_without_drag(const SpaceRobot& robot) {
    const bool has_drag = std::any_of(robot.plant.links.begin(), robot.plant.links.end(),
                                      [](const SpaceLink& link) { return link.drag.is_any(); });
    if (!robot.plant.wash || has_drag) {
        return {};
    }
    return {{"arm.wash", "acts through the drag of the links, and none has any: expected drag of a link as well"}};
}

Errors unflyable_uncertainty(const SpaceRobot& robot) {
    return robot.uncertainty ? uncertainty_errors(*robot.uncertainty, uncertain_parts_of(robot)) : Errors();
}

const std::array<Check<SpaceRobot>, 18> checks{{
    {{"multirotor.body"}, missing_bodies},
    {{"multirotor.body", "arm.links"}, shapeless_cylinders},
    {{"multirotor.inertia_kg_m2", "arm.links"}, impossible_inertia},
    {{"multirotor.inertia_kg_m2", "multirotor.mass_kg", "rotors.positions_m", "rotors.radius_m"}, too_large_inertia},
    {{"rotors.axes", "arm.links", "arm.direction"}, lost_directions},
    {{"arm.links"}, too_many_links},
    {{"rotors.positions_m", "rotors.spin", "rotors.min_thrust_n", "rotors.max_thrust_n", "arm.links"}, misfit_lists},
    {{"rotors.positions_m", "rotors.axes", "rotors.spin", "rotors.torque_ratio_m"}, unusable_rotor_layout},
    {{"rotors.positions_m", "rotors.min_thrust_n", "rotors.max_thrust_n"}, crossed_thrust_limits},
    {{"rotors.positions_m", "rotors.axes", "rotors.max_thrust_n", "multirotor.mass_kg", "arm.links"},
     too_little_thrust},
    {{"rotors.positions_m", "rotors.axes", "rotors.min_thrust_n", "multirotor.mass_kg", "arm.links"}, too_much_thrust},
    {{"arm.links"}, crossed_joint_limits},
    {{"arm.links"}, weak_joints},
    {{"rotors.time_constant_s", "controller.rate_hz"}, too_short_lag},
    {{"controller.delay_s", "controller.rate_hz"}, too_long_delay},
    {{"rotors.spinning_inertia_kg_m2", "rotors.thrust_coefficient_n_s2"}, spin_without_speed},
    {{"arm.wash", "arm.links"}, wash_without_drag},
    {{"uncertainty", "rotors.time_constant_s", "controller"}, unflyable_uncertainty},
}};

}  // namespace

Errors further_space_robot_errors(const SpaceRobot& robot, WrongKeys& wrong, std::string_view prefix) {
    Errors errors = value_errors(space_robot_parameters(), robot, prefix, wrong);
    append(errors, run_checks(std::span<const Check<SpaceRobot>>(checks), robot, prefix, wrong));
    return errors;
}

Errors space_robot_errors(const SpaceRobot& robot) {
    WrongKeys wrong;
    return further_space_robot_errors(robot, wrong, "");
}

Errors space_robot_warnings(const SpaceRobot& robot) {
    Errors warnings = rotors_at_one_place(robot);
    const SpaceRobotFacts facts = space_robot_facts(robot);
    if (facts.hover_share > 1) {
        warnings.push_back({"rotors.max_thrust_n", "makes rotor " + std::to_string(facts.hover_rotor + 1) + " give " +
                                                       rounded(100 * facts.hover_share) +
                                                       " % of its greatest thrust in a hover with joints at " +
                                                       joints_text(facts.hover_joints_rad) +
                                                       " deg: it cannot hover there"});
    }
    return warnings;
}

}  // namespace downwash
