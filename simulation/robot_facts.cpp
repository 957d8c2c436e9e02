#include "downwash/simulation/robot_facts.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "downwash/base/infinity.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "downwash/simulation/hover_analysis.hpp"

namespace downwash {
namespace {

constexpr double quarter_turn_rad = std::numbers::pi / 2;

bool is_within(const ArmParameters& arm, double arm_rad) {
    return !arm.is_limited || (arm_rad >= arm.lower_limit_rad && arm_rad <= arm.upper_limit_rad);
}

/// Arm angles among which a load that is linear in the cosine and the sine of the angle is greatest: where the arm is
/// level or upright, and its limits.
std::vector<double> extreme_arm_angles_rad(const ArmParameters& arm) {
    std::vector<double> angles;
    if (!arm.is_limited) {
        for (int quarter = -1; quarter <= 2; ++quarter) {
            angles.push_back(quarter * quarter_turn_rad);
        }
        return angles;
    }
    angles.push_back(arm.lower_limit_rad);
    const double first = std::ceil(arm.lower_limit_rad / quarter_turn_rad);
    constexpr int one_turn = 4;
    for (int i = 0; i <= one_turn && (first + i) * quarter_turn_rad < arm.upper_limit_rad; ++i) {
        angles.push_back((first + i) * quarter_turn_rad);
    }
    angles.push_back(arm.upper_limit_rad);
    return angles;
}

/// The arm's end is farthest from the centre of mass where the arm points away from it, or else at a limit.
double reach_of(const ArmParameters& arm) {
    const double joint_m = std::hypot(arm.joint_x_m, arm.joint_z_m);
    const double outward_rad = std::atan2(-arm.joint_z_m, arm.joint_x_m);
    if (joint_m == 0 || !arm.is_limited) {
        return joint_m + arm.length_m;
    }
    const double turns = std::ceil((arm.lower_limit_rad - outward_rad) / (4 * quarter_turn_rad));
    if (is_within(arm, outward_rad + turns * 4 * quarter_turn_rad)) {
        return joint_m + arm.length_m;
    }
    const auto reach_at = [&arm](double arm_rad) {
        return std::hypot(arm.joint_x_m + arm.length_m * std::cos(arm_rad),
                          arm.joint_z_m - arm.length_m * std::sin(arm_rad));
    };
    return std::max(reach_at(arm.lower_limit_rad), reach_at(arm.upper_limit_rad));
}

void find_hover_share(const Robot& robot, RobotFacts& facts) {
    AeroSettings calm;
    calm.enabled = false;
    const FlightModel model(robot, {}, std::make_shared<const Scene>(std::vector<Obstacle>{}), calm);
    for (const double arm_rad : extreme_arm_angles_rad(robot.arm)) {
        const HoverTrim trim = analyse_hover(model, 0, 0, arm_rad).trim;
        for (std::size_t rotor = 0; rotor < robot.rotors.positions_m.size(); ++rotor) {
            const double share = trim.rotor_command_n[rotor] / robot.rotors.max_thrust_n;
            constexpr double rounding = 1e-9;  // of rotors that carry the same
            if (share > facts.hover_share * (1 + rounding)) {
                facts.hover_share = share;
                facts.hover_rotor = rotor;
                facts.hover_arm_rad = arm_rad;
            }
        }
    }
}

std::optional<LeastMargins> least_margins(const Robot& robot) {
    LeastMargins least{infinity, {}, 0, infinity, {}, 0};
    for (const double arm_rad : examined_arm_angles_rad(robot.arm)) {
        try {
            const auto loops = loop_margins(robot, arm_rad);
            for (const LoopInput input : all_loop_inputs) {
                const LoopMargins& loop = loops[static_cast<std::size_t>(input)];
                if (loop.gain_margin_db < least.gain_margin_db) {
                    least.gain_margin_db = loop.gain_margin_db;
                    least.gain_input = input;
                    least.gain_arm_rad = arm_rad;
                }
                if (loop.phase_margin_rad < least.phase_margin_rad) {
                    least.phase_margin_rad = loop.phase_margin_rad;
                    least.phase_input = input;
                    least.phase_arm_rad = arm_rad;
                }
            }
        } catch (const InputError&) {
            return std::nullopt;
        }
    }
    return least;
}

}  // namespace

std::vector<double> examined_arm_angles_rad(const ArmParameters& arm) {
    std::vector<double> angles;
    for (const double arm_rad : {-quarter_turn_rad, 0.0, quarter_turn_rad}) {
        // A limit in degrees may be the same angle but for rounding.
        constexpr double rounding_rad = 1e-9;
        const double kept_rad =
            arm.is_limited ? std::max(arm.lower_limit_rad, std::min(arm_rad, arm.upper_limit_rad)) : arm_rad;
        if (std::abs(kept_rad - arm_rad) <= rounding_rad) {
            angles.push_back(kept_rad);
        }
    }
    if (angles.empty()) {
        angles.push_back(arm.lower_limit_rad);
        if (arm.upper_limit_rad != arm.lower_limit_rad) {
            angles.push_back(arm.upper_limit_rad);
        }
    }
    return angles;
}

RobotFacts robot_facts(const Robot& robot) {
    RobotFacts facts;
    facts.mass_kg = robot.mass_kg();
    facts.thrust_to_weight = static_cast<double>(robot.rotors.positions_m.size()) * robot.rotors.max_thrust_n /
                             (facts.mass_kg * standard_gravity_m_s2);
    facts.reach_m = reach_of(robot.arm);
    find_hover_share(robot, facts);
    facts.margins = least_margins(robot);
    return facts;
}

}  // namespace downwash
