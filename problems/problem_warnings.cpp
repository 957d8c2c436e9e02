#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/cut_off_goals.hpp"
#include "downwash/problems/data_facts.hpp"
#include "downwash/problems/geometry_warnings.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/problem_check.hpp"
#include "downwash/problems/shared_checks.hpp"
#include "downwash/problems/slip_warnings.hpp"
#include "downwash/simulation/goal.hpp"
#include "downwash/simulation/loop_margins.hpp"
#include "downwash/simulation/robot_facts.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash {
namespace {

/// A loop with less than this is next to unstable.
constexpr double thin_gain_db = 2;
constexpr double thin_phase_deg = 10;

std::string shortened(double value) {
    return to_text(value, 3);
}

constexpr const char* margins_remedy =
    "; less rotors.time_constant_s or controller.delay_s, or other gains: `downwash margins` shows all loops";

std::string thin_loop_text(LoopInput input, const LoopMargins& margins, const std::string& where) {
    return "makes a hover in free air nearly unstable" + where + ": the loop of " + std::string(name_of(input)) +
           " has margins of " + shortened(margins.gain_margin_db) + " dB and " +
           shortened(margins.phase_margin_rad * degrees_per_radian) + " deg" + margins_remedy;
}

std::string unstable_text(const std::string& where) {
    return "does not hold a hover in free air" + where + ": it is unstable there" + margins_remedy;
}

/// What a hover in free air shows at the examined arm angles; of the first angle only.
std::vector<KeyError> thin_margins(const Robot& robot) {
    for (const double arm_rad : examined_arm_angles_rad(robot.arm)) {
        std::string where = " with the arm at ";
        where.append(shortened(arm_rad * degrees_per_radian)).append(" deg");
        try {
            const auto loops = loop_margins(robot, arm_rad);
            for (const LoopInput input : all_loop_inputs) {
                const LoopMargins& margins = loops[static_cast<std::size_t>(input)];
                if (margins.gain_margin_db < thin_gain_db ||
                    margins.phase_margin_rad * degrees_per_radian < thin_phase_deg) {
                    return {{"controller", thin_loop_text(input, margins, where)}};
                }
            }
        } catch (const InputError&) {
            return {{"controller", unstable_text(where)}};
        }
    }
    return {};
}

/// Two rotors, counted from 0, whose discs overlap in plan.
struct OverlappingDiscs {
    std::size_t i, j;
    double apart_m;
    bool are_level;
};

std::vector<OverlappingDiscs> overlapping_discs_of(const RotorParameters& rotors) {
    constexpr double level_share = 0.1;  // of a radius
    const auto& hubs = rotors.positions_m;
    std::vector<OverlappingDiscs> found;
    for (std::size_t i = 0; i < hubs.size(); ++i) {
        for (std::size_t j = i + 1; j < hubs.size(); ++j) {
            const double apart_m = std::hypot(hubs[i][0] - hubs[j][0], hubs[i][1] - hubs[j][1]);
            if (apart_m < 2 * rotors.radius_m * (1 - 1e-9)) {
                found.push_back({i, j, apart_m, std::abs(hubs[i][2] - hubs[j][2]) <= level_share * rotors.radius_m});
            }
        }
    }
    return found;
}

std::string rotors_text(const OverlappingDiscs& discs) {
    return "puts the rotors " + std::to_string(discs.i + 1) + " and " + std::to_string(discs.j + 1);
}

std::vector<KeyError> overlapping_discs(const Robot& robot) {
    for (const OverlappingDiscs& discs : overlapping_discs_of(robot.rotors)) {
        if (discs.are_level) {
            return {{"rotors.positions_m", rotors_text(discs) + " " + shortened(discs.apart_m) +
                                               " m apart, less than two radii, " +
                                               shortened(2 * robot.rotors.radius_m) +
                                               " m: their discs overlap; move them apart, or give the radius "
                                               "of one rotor in rotors.radius_m"}};
        }
    }
    return {};
}

/// A rotor in the slipstream of another. The factors of power are those of momentum theory for two rotors in one plane,
/// 1.41, and of measured coaxial pairs, 1.2 (Leishman 2006, Principles of Helicopter Aerodynamics, section 2.15).
std::vector<KeyError> coaxial_rotors(const Robot& robot) {
    std::vector<OverlappingDiscs> pairs = overlapping_discs_of(robot.rotors);
    std::erase_if(pairs, [](const OverlappingDiscs& discs) { return discs.are_level; });
    if (pairs.empty()) {
        return {};
    }
    return {
        {"rotors.positions_m",
         rotors_text(pairs.front()) + " one above the other" +
             (pairs.size() > 1 ? ", one of " + std::to_string(pairs.size()) + " such pairs" : "") +
             ": the lower one works in the slipstream of the upper one, but counts in full here. At the same thrust "
             "such a pair takes 1.2 to 1.4 times the power: raise rotors.power_coefficient_w_n1p5 and lower "
             "rotors.max_thrust_n to what the pairs give"}};
}

/// Far more thrust than a vehicle needs is likely in another unit.
std::vector<KeyError> unusual_thrust(const Robot& robot) {
    constexpr double most_times = 20;
    const double greatest_n = static_cast<double>(robot.rotors.positions_m.size()) * robot.rotors.max_thrust_n;
    const double times = greatest_n / (robot.mass_kg() * standard_gravity_m_s2);
    if (times <= most_times) {
        return {};
    }
    return {{"rotors.max_thrust_n", "is " + to_text(robot.rotors.max_thrust_n) + ", and all rotors lift " +
                                        shortened(times) +
                                        " times the weight: expected newtons of one rotor; if these are gram-force, as "
                                        "in data sheets, it is " +
                                        shortened(robot.rotors.max_thrust_n * standard_gravity_m_s2 / 1000) + " N"}};
}

/// All rotors at the same place along x have the same thrust, which is linear in x.
std::vector<KeyError> unbalanced_roll(const Robot& robot) {
    constexpr double rounding_m = 1e-3;
    double sum_m = 0;
    double moment_m2 = 0;
    for (const auto& hub : robot.rotors.positions_m) {
        sum_m += hub[1];
        moment_m2 += hub[0] * hub[1];
    }
    if (std::abs(sum_m) < rounding_m && std::abs(moment_m2) < rounding_m) {
        return {};
    }
    return {{"rotors.positions_m",
             "is not the same to the left and to the right: the rotors would roll the vehicle out of its plane of "
             "motion; expected y that cancel at the front and at the back"}};
}

/// A gain without which nothing holds what it controls.
struct HoldingGain {
    const char* key;
    double value;
    bool is_inherited = false;  ///< it is that of another key
};

std::vector<HoldingGain> holding_gains(const ModelInversion& law) {
    const ModelInversion::AxisGains height = law.axis_gains(1);
    return {{"controller.position.kp", law.position_kp},
            {"controller.position.kd", law.position_kd},
            {"controller.height.kp", height.kp, height.kp == law.position_kp},
            {"controller.height.kd", height.kd, height.kd == law.position_kd},
            {"controller.attitude.kp", law.attitude_kp},
            {"controller.attitude.rate_kp", law.attitude_rate_kp},
            {"controller.arm.kp", law.arm_kp},
            {"controller.arm.kd", law.arm_kd}};
}

std::vector<HoldingGain> holding_gains(const CascadedPid& law) {
    return {{"controller.horizontal.position_kp", law.horizontal_position_kp},
            {"controller.horizontal.velocity_kp", law.horizontal_velocity_kp},
            {"controller.vertical.position_kp", law.vertical_position_kp},
            {"controller.vertical.velocity_kp", law.vertical_velocity_kp},
            {"controller.pitch.angle_kp", law.pitch_angle_kp},
            {"controller.pitch.rate_kp", law.pitch_rate_kp},
            {"controller.joint.kp", law.joint_kp},
            {"controller.joint.kd", law.joint_kd}};
}

/// Nothing is known about the gains of other laws.
template <class Law>
std::vector<HoldingGain> holding_gains(const Law& /*law*/) {
    return {};
}

std::vector<KeyError> gains_of_zero(const Robot& robot) {
    std::vector<KeyError> warnings;
    for (const HoldingGain& gain :
         std::visit([](const auto& law) { return holding_gains(law); }, robot.controller.law)) {
        if (gain.value == 0 && !gain.is_inherited) {
            warnings.push_back({gain.key, "is 0: nothing holds what it controls in place; expected more than 0"});
        }
    }
    return warnings;
}

/// Momentum theory: an ideal rotor takes T^1.5 / sqrt(2 rho A).
std::vector<KeyError> unusual_power(const Robot& robot) {
    constexpr double air_kg_m3 = 1.225;
    constexpr double most_times = 20;
    const double area_m2 = std::numbers::pi * robot.rotors.radius_m * robot.rotors.radius_m;
    const double ideal = 1 / std::sqrt(2 * air_kg_m3 * area_m2);
    const double times = robot.rotors.power_coefficient_w_n1p5 / ideal;
    if (times >= 1 && times <= most_times) {
        return {};
    }
    return {{"rotors.power_coefficient_w_n1p5",
             "is " + shortened(times) + " times that of an ideal rotor of this radius, " + shortened(ideal) +
                 ": usual are 1.2 to 3 times; energies and plans for little energy are off by as much"}};
}

/// A robot that problems with uncertainty will not take, because of the uncertainty that it has by default.
std::vector<KeyError> unflyable_default_uncertainty(const Robot& robot) {
    if (robot.uncertainty) {
        return {};  // then it is an error
    }
    constexpr std::string_view group = "uncertainty.vehicle.";
    std::vector<KeyError> warnings;
    for (const KeyError& error : uncertainty_errors(Uncertainty(), robot)) {
        const bool is_delay = error.key.ends_with("delay_s");
        warnings.push_back({is_delay ? "controller.delay_s" : "rotors.time_constant_s",
                            "is too uncertain by default for problems with an `uncertainty:`: " +
                                error.key.substr(group.size()) + " " + error.message});
    }
    return warnings;
}

std::vector<KeyError> robot_remarks(const Robot& robot) {
    std::vector<KeyError> all;
    for (const auto& find : {thin_margins, overlapping_discs, coaxial_rotors, unbalanced_roll, unusual_thrust,
                             gains_of_zero, unusual_power, unflyable_default_uncertainty}) {
        const std::vector<KeyError> found = find(robot);
        all.insert(all.end(), found.begin(), found.end());
    }
    append(all, robot_slips(robot));
    return all;
}

/// A vehicle that need not move.
std::vector<KeyError> goal_at_start(const Problem& problem) {
    if (!problem.targets.empty()) {
        return {};
    }
    const PlantModel plant = make_plant_model(problem.robot.multirotor, problem.robot.arm, problem.robot.rotors);
    const GoalError error = goal_error(problem.goals_before.empty() ? problem.goal : problem.goals_before.front(),
                                       plant, problem.start.pose());
    if (!is_met(error)) {
        return {};
    }
    return {
        {"goal",
         "is met at the start already: its tolerance is larger than the way there; expected a smaller tolerance, or "
         "another place"}};
}

/// References may ask for more force than all rotors together have. It is no error: the other limits of motion may keep
/// references below it, and demands may be clipped (planner.max_saturation).
std::vector<KeyError> thrust_beyond_rotors(const Problem& problem) {
    constexpr double rounding = 1.01;  // of thrusts and masses as they stand in files
    const Robot& robot = problem.robot;
    const double weight_n = robot.mass_kg() * standard_gravity_m_s2;
    const double greatest_n = static_cast<double>(robot.rotors.positions_m.size()) * robot.rotors.max_thrust_n;
    const std::optional<double>& ratio = problem.motion.max_thrust_ratio;
    if (!ratio || *ratio * weight_n <= rounding * greatest_n) {
        return {};
    }
    return {{"motion.max_thrust_ratio", "is " + to_text(*ratio) + ", and the rotors give " +
                                            shortened(greatest_n / weight_n) + " times the weight at most (" +
                                            shortened(greatest_n) + " N of " + shortened(weight_n) +
                                            " N): flights cannot follow references that ask for more; expected "
                                            "at most " +
                                            shortened(greatest_n / weight_n)}};
}

/// Numbers of a file that are likely not what they should be.
std::vector<KeyError> unlikely_data(const Problem& problem) {
    if (!problem.aero.enabled) {
        return {};
    }
    std::vector<KeyError> warnings;
    for (const DataFacts& data : data_facts(problem)) {
        for (const std::string& remark : data_remarks(data, std::max(2.0, problem.aero.max_factor))) {
            warnings.push_back({data.key, remark});
        }
    }
    return warnings;
}

/// An uncertainty in which nothing is uncertain.
std::vector<KeyError> exact_uncertainty(const Problem& problem) {
    if (!problem.uncertainty) {
        return {};
    }
    const auto is_exact = [&](const WorldParameter* parameter) {
        return ((*problem.uncertainty).*parameter->spread).form == Spread::Form::exact;
    };
    if (!std::ranges::all_of(world_parameters_of(problem.robot), is_exact)) {
        return {};
    }
    return {
        {"uncertainty",
         "leaves nothing uncertain: all worlds are alike, and a certificate says nothing; leave out the keys that are "
         "0, for their defaults, or the whole group"}};
}

/// The key of a goal by its number in goals_of().
std::string goal_key(const Problem& problem, std::size_t number) {
    const std::string index = "[" + std::to_string(number) + "]";
    if (!problem.targets.empty()) {
        return number < problem.targets.size() ? "goal.in_any_order" + index : "goal.return_to";
    }
    return problem.goals_before.empty() ? "goal" : "goal" + index;
}

/// Goals to which no way leads.
std::vector<KeyError> closed_plane(const ProblemCheck& check) {
    const Problem& problem = check.problem();
    std::vector<KeyError> warnings;
    for (const CutOffGoal& goal : cut_off_goals(problem, *check.scene())) {
        std::vector<std::string> labels;
        for (const std::size_t obstacle : goal.obstacles) {
            labels.push_back(label_of(problem.obstacles, obstacle));
        }
        warnings.push_back({goal_key(problem, goal.goal),
                            "is out of reach in this plane of motion: at no pitch and no arm angle does the vehicle "
                            "get past " +
                                quoted_labels(labels) +
                                " within the bounds; move the plane, widen the bounds, or change the scene"});
    }
    return warnings;
}

}  // namespace

std::vector<KeyError> robot_warnings(const Robot& robot) {
    return robot_errors(robot).empty() ? robot_remarks(robot) : std::vector<KeyError>{};
}

std::vector<KeyError> warnings_of(const ProblemCheck& check) {
    const Problem& problem = check.problem();
    std::vector<KeyError> all = robot_warnings(problem.robot);
    for (KeyError& warning : all) {
        warning.key.insert(0, "robot.");
    }
    for (const auto& find :
         {no_margin<Problem>, thrust_beyond_rotors, goal_at_start, unlikely_data, exact_uncertainty}) {
        const std::vector<KeyError> found = find(problem);
        all.insert(all.end(), found.begin(), found.end());
    }
    append(all, problem_slips(problem));
    append(all, closed_plane(check));
    append(all, geometry_warnings(check));
    return all;
}

std::vector<KeyError> file_warnings_of(const ProblemCheck& check, const WrongKeys& wrong) {
    std::vector<KeyError> all;
    if (!wrong.touch("aero")) {
        append(all, unlikely_data(check));
    }
    if (!wrong.touch("environment") && !wrong.touch("robot")) {
        append(all, geometry_warnings(check));
    }
    return all;
}

std::vector<KeyError> problem_warnings(const Problem& problem) {
    return warnings_of(ProblemCheck(problem));
}

}  // namespace downwash
