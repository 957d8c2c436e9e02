#include "downwash/problems/slip_warnings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <variant>

#include "downwash/base/angles.hpp"
#include "downwash/base/checks.hpp"
#include "downwash/base/parameter.hpp"
#include "downwash/base/parameter_table.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/number_text.hpp"
#include "downwash/problems/problem_parameters.hpp"
#include "downwash/problems/space_goal_parameters.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/problems/space_problem_parameters.hpp"
#include "downwash/problems/visit_order.hpp"
#include "downwash/simulation/space_tool.hpp"

namespace downwash {
namespace {

using problems::rounded;

bool is_whole(double value) {
    return std::abs(value - std::round(value)) < 1e-9;
}

/// How far a body reaches from the centre of mass, to all sides along the ground.
double reach_m(const BodyShape& body) {
    const Vector3& center_m = body.center_body_m;
    double around_m = 0;
    if (const auto* box = std::get_if<Box>(&body.shape)) {
        around_m = 0.5 * std::hypot(box->size_m[0], box->size_m[1]);
    } else if (const auto* cylinder = std::get_if<Cylinder>(&body.shape)) {
        around_m = std::hypot(cylinder->radius_m, 0.5 * cylinder->length_m);
    } else {
        around_m = std::get<Sphere>(body.shape).radius_m;
    }
    return std::hypot(center_m[0], center_m[1]) + around_m;
}

double body_reach_m(const Robot& robot) {
    double farthest_m = 0;
    for (const BodyShape& body : robot.body) {
        farthest_m = std::max(farthest_m, reach_m(body));
    }
    return farthest_m;
}

/// Limits of a joint that turns by a few degrees only, and not by whole ones.
std::vector<KeyError> limits_in_radians(const std::string& key, double lower_rad, double upper_rad) {
    const double low_deg = lower_rad * degrees_per_radian, high_deg = upper_rad * degrees_per_radian;
    constexpr double turn = 2 * std::numbers::pi + 0.01;
    if (low_deg >= high_deg || std::abs(low_deg) > turn || std::abs(high_deg) > turn ||
        (is_whole(low_deg) && is_whole(high_deg))) {
        return {};
    }
    return {{key, "lets the arm turn by " + rounded(high_deg - low_deg) +
                      " degrees only: expected degrees; if these are radians, it is [" +
                      rounded(low_deg * degrees_per_radian) + ", " + rounded(high_deg * degrees_per_radian) + "]"}};
}

std::vector<KeyError> arm_limits_in_radians(const Robot& robot) {
    const ArmParameters& arm = robot.arm;
    return arm.is_limited ? limits_in_radians("arm.limits_deg", arm.lower_limit_rad, arm.upper_limit_rad)
                          : std::vector<KeyError>();
}

std::vector<KeyError> outlying_rotors(const Robot& robot) {
    constexpr double most_times = 4;
    const double body_m = body_reach_m(robot);
    for (std::size_t i = 0; i < robot.rotors.positions_m.size(); ++i) {
        const Vector3& hub_m = robot.rotors.positions_m[i];
        const double away_m = std::hypot(hub_m[0], hub_m[1]);
        if (away_m > most_times * body_m) {
            return {{"rotors.positions_m", "puts rotor " + std::to_string(i + 1) + " " + rounded(away_m) +
                                               " m from the centre of mass, and multirotor.body reaches " +
                                               rounded(body_m) +
                                               " m: expected metres, and bodies that enclose the rotors"}};
        }
    }
    return {};
}

std::vector<KeyError> small_inertias(const Robot& robot) {
    constexpr double least_of_body = 0.1, least_of_arm = 0.05;
    std::vector<KeyError> warnings;
    const auto check = [&warnings](const char* key, double inertia_kg_m2, double mass_kg, double size_m, double least) {
        const double gyration_m = std::sqrt(inertia_kg_m2 / mass_kg);
        if (gyration_m < least * size_m) {
            warnings.push_back(
                {key,
                 "is that of the whole mass " + rounded(gyration_m) +
                     " m from the axis, which is little for something that reaches " + rounded(size_m) +
                     " m: expected kg m2 about the pitch axis; CAD programs give g mm2 (1e-9 kg m2) or kg mm2 (1e-6 "
                     "kg m2), too"});
        }
    };
    check("multirotor.pitch_inertia_kg_m2", robot.multirotor.pitch_inertia_kg_m2, robot.multirotor.mass_kg,
          body_reach_m(robot), least_of_body);
    check("arm.inertia_kg_m2", robot.arm.inertia_kg_m2, robot.arm.mass_kg, robot.arm.length_m, least_of_arm);
    return warnings;
}

/// Whether an angle in degrees is a multiple of 45 degrees in radians, as people round it: 0.785, 1.57, 3.1416.
bool looks_like_radians(double degrees) {
    constexpr double eighth = std::numbers::pi / 4, rounding = 0.006;
    const double eighths = std::round(degrees / eighth);
    return eighths != 0 && std::abs(eighths) <= 8 && std::abs(degrees - eighths * eighth) < rounding &&
           !is_whole(10 * degrees);
}

template <class AnyProblem>
std::vector<KeyError> angles_in_radians(const ParameterTable<AnyProblem>& parameters, const AnyProblem& problem) {
    constexpr std::array<std::string_view, 7> angles{"heading_deg", "arm_deg", "pitch_deg", "direction_deg",
                                                     "rpy_deg",     "yaw_deg", "joints_deg"};
    std::vector<KeyError> warnings;
    const auto check = [&warnings](const std::string& key, double radians) {
        const double degrees = radians * degrees_per_radian;
        if (looks_like_radians(degrees)) {
            warnings.push_back({key, "is " + rounded(degrees) + " degrees: if these are radians, it is " +
                                         rounded(degrees * degrees_per_radian)});
        }
    };
    for_each_value(parameters, problem,
                   [&](const Parameter<AnyProblem>& parameter, const std::string& key, std::size_t index) {
                       if (std::ranges::find(angles, last_name(parameter.path)) == angles.end()) {
                           return;
                       }
                       const Value value = parameter.get(problem, index);
                       if (const auto* one = std::get_if<double>(&value)) {
                           check(key, *one);
                       } else if (const auto* some = std::get_if<std::vector<double>>(&value)) {
                           std::ranges::for_each(*some, [&](double each) { check(key, each); });
                       }
                   });
    return warnings;
}

/// What a hover in free air takes, with rotors that lift alike [W].
double hover_power_w(double mass_kg, std::size_t rotors, double coefficient_w_n1p5) {
    const auto count = static_cast<double>(rotors);
    return count * coefficient_w_n1p5 * std::pow(mass_kg * standard_gravity_m_s2 / count, 1.5);
}

/// A budget that is not enough for the hover at a single target and at the place to return to. Near surfaces a hover
/// may take half of what it takes in free air.
template <class AnyProblem>
std::vector<KeyError> small_energy_budget(const AnyProblem& problem, double power_w) {
    const auto targets = targets_of(problem);
    if (!problem.energy_budget_j || targets.empty()) {
        return {};
    }
    constexpr double near_surfaces = 0.5;
    double hover_s = std::numeric_limits<double>::infinity();
    for (const auto& target : targets) {
        hover_s = std::min(hover_s, target.hold_s);
    }
    hover_s += problem.return_to ? problem.return_to->hold_s : 0;
    if (*problem.energy_budget_j > near_surfaces * power_w * hover_s) {
        return {};
    }
    return {{"goal.energy_budget_j", "is " + to_text(*problem.energy_budget_j) +
                                         ": expected joules (1 kJ is 1000, 1 Wh is "
                                         "3600); a hover in free air takes " +
                                         rounded(power_w) + " W, so the hovers at one target" +
                                         (problem.return_to ? " and after the return" : "") + " take about " +
                                         rounded(power_w * hover_s) + " J by themselves"}};
}

std::vector<KeyError> idle_yaw(const SpaceStart& start) {
    constexpr double rounding_rad = 1e-6;
    if (!start.attitude || start.yaw_rad == 0) {
        return {};
    }
    const double yaw_rad = yaw_of(start_motion(start).attitude);
    if (std::abs(std::remainder(start.yaw_rad - yaw_rad, 2 * std::numbers::pi)) < rounding_rad) {
        return {};
    }
    return {{"start.yaw_deg", "counts for nothing beside start.attitude, whose yaw is " +
                                  rounded(yaw_rad * degrees_per_radian) + " degrees; leave one of them out"}};
}

/// Tolerances about a direction that is not given. One that was not given either is the default.
std::vector<KeyError> idle_tolerances(const SpaceProblem& problem) {
    std::vector<KeyError> warnings;
    for_each_goal(problem, [&](const SpaceGoal& goal, const std::string& key) {
        const auto warn = [&](const char* name) {
            warnings.push_back({key + "." + name, "counts for nothing without " + key + ".direction; give one"});
        };
        if (const auto* tool = std::get_if<SpaceEndEffectorGoal>(&goal.kind)) {
            if (!tool->direction && tool->direction_tolerance_rad != SpaceEndEffectorGoal().direction_tolerance_rad) {
                warn("direction_tolerance_deg");
            }
        } else if (const auto* camera = std::get_if<SpaceCameraGoal>(&goal.kind)) {
            if (!camera->direction && camera->view_cone_rad != SpaceCameraGoal().view_cone_rad) {
                warn("view_cone_deg");
            }
        }
    });
    return warnings;
}

std::vector<KeyError> repeated_targets(const SpaceProblem& problem) {
    const auto targets = targets_of(problem);
    for (auto target = targets.begin(); target != targets.end(); ++target) {
        const auto first = std::find(targets.begin(), target, *target);
        if (first != target) {
            return {{"goal.in_any_order[" + std::to_string(target - targets.begin()) + "]",
                     "is the same as goal.in_any_order[" + std::to_string(first - targets.begin()) +
                         "], so the vehicle goes there twice; leave one of them out"}};
        }
    }
    return {};
}

}  // namespace

std::vector<KeyError> robot_slips(const Robot& robot) {
    std::vector<KeyError> all;
    for (const auto& find : {arm_limits_in_radians, outlying_rotors, small_inertias}) {
        append(all, find(robot));
    }
    return all;
}

std::vector<KeyError> robot_slips(const SpaceRobot& robot) {
    std::vector<KeyError> all;
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        const SpaceLinkLimits& limits = robot.links[i];
        if (limits.is_limited) {
            append(all, limits_in_radians("arm.links[" + std::to_string(i) + "].limits_deg", limits.lower_limit_rad,
                                          limits.upper_limit_rad));
        }
    }
    return all;
}

std::vector<KeyError> problem_slips(const Problem& problem) {
    const RotorParameters& rotors = problem.robot.rotors;
    std::vector<KeyError> all = angles_in_radians(problem_parameters(), problem);
    append(all, small_energy_budget(problem, hover_power_w(problem.robot.mass_kg(), rotors.positions_m.size(),
                                                           rotors.power_coefficient_w_n1p5)));
    return all;
}

std::vector<KeyError> problem_slips(const SpaceProblem& problem) {
    const SpacePlant& plant = problem.robot.plant;
    std::vector<KeyError> all = angles_in_radians(space_problem_parameters(), problem);
    append(all, small_energy_budget(problem, hover_power_w(problem.robot.mass_kg(), plant.rotors.size(),
                                                           plant.power_coefficient_w_n1p5)));
    append(all, idle_yaw(problem.start));
    append(all, idle_tolerances(problem));
    append(all, repeated_targets(problem));
    return all;
}

}  // namespace downwash
