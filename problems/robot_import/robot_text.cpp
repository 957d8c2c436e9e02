#include "downwash/robot_import/robot_text.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/designed_robot.hpp"

namespace downwash::robot_import {
namespace {

/// Twelve digits, which is more than any model has, without the dust of turned axes.
std::string text(double value) {
    constexpr double dust = 1e-13;
    return std::abs(value) < dust ? "0" : to_text(value, 12);
}

template <class Numbers>
std::string list(const Numbers& numbers) {
    return "[" + joined(numbers, ", ", [](double number) { return text(number); }) + "]";
}

/// One number where all are equal.
std::string one_or_list(const std::vector<double>& numbers) {
    const bool are_equal = std::ranges::all_of(numbers, [&](double n) { return n == numbers[0]; });
    return are_equal ? text(numbers[0]) : list(numbers);
}

std::string inertia_text(const Matrix3& m) {
    const double scale = m[0][0] + m[1][1] + m[2][2];
    constexpr double dust = 1e-12;
    Matrix3 clean = m;
    bool is_diagonal = true;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (i != k) {
                const double product = 0.5 * (m[i][k] + m[k][i]);
                clean[i][k] = std::abs(product) < dust * scale ? 0 : product;
                is_diagonal = is_diagonal && clean[i][k] == 0;
            }
        }
    }
    return is_diagonal ? list(Vector3{clean[0][0], clean[1][1], clean[2][2]})
                       : "[" + joined(clean, ", ", [](const Vector3& row) { return list(row); }) + "]";
}

std::string body_text(const SpaceBodyShape& body) {
    std::string place = ", center_m: " + list(body.center_m);
    if (const auto* box = std::get_if<Box>(&body.shape)) {
        return "box: {size_m: " + list(box->size_m) + place + "}";
    }
    if (const auto* cylinder = std::get_if<Cylinder>(&body.shape)) {
        return "cylinder: {radius_m: " + text(cylinder->radius_m) + ", length_m: " + text(cylinder->length_m) +
               ", axis: " + list(cylinder->axis) + place + "}";
    }
    if (const auto* sphere = std::get_if<Sphere>(&body.shape)) {
        return "sphere: {radius_m: " + text(sphere->radius_m) + place + "}";
    }
    const auto& capsule = std::get<Capsule>(body.shape);
    return "capsule: {radius_m: " + text(capsule.radius_m) + ", from_m: " + list(body.center_m + capsule.from_m) +
           ", to_m: " + list(body.center_m + capsule.to_m) + "}";
}

std::string bodies_text(const std::vector<SpaceBodyShape>& bodies, const std::string& indent) {
    if (bodies.empty()) {
        return indent + "body: []\n";
    }
    std::string all = indent + "body:\n";
    for (const SpaceBodyShape& body : bodies) {
        all += indent + "  - " + body_text(body) + "\n";
    }
    return all;
}

/// "  key: value  # comment"
std::string line(const std::string& key, const std::string& value, const std::string& comment = "") {
    return key + ": " + value + (comment.empty() ? "" : "  # " + comment) + "\n";
}

std::string multirotor_text(const BuiltRobot& built) {
    const SpaceBody& body = built.robot.plant.multirotor;
    return "multirotor:\n  # " + built.part_sources[0] + "\n" + line("  mass_kg", text(body.mass_kg)) +
           line("  inertia_kg_m2", inertia_text(body.inertia_kg_m2), "joined by the parallel-axis rule") + "  # " +
           built.body_source + "\n" + bodies_text(built.robot.body, "  ") +
           "  # Air drag is not in the file: multirotor.drag has it.\n";
}

std::string rotors_text(const BuiltRobot& built) {
    const SpaceRobot& robot = built.robot;
    const ImportedRotors& from = built.rotors;
    std::string all =
        "\nrotors:\n" + line("  radius_m", text(robot.rotor_radius_m), from.radius_m.source) + "  positions_m:\n";
    std::vector<double> torque_ratios;
    bool are_level = true;
    for (std::size_t k = 0; k < robot.plant.rotors.size(); ++k) {
        const SpaceRotor& rotor = robot.plant.rotors[k];
        all +=
            "    - " + list(rotor.position_m) + "  # " + std::to_string(k + 1) + ": " + excerpt(from.names[k]) + "\n";
        torque_ratios.push_back(rotor.drag_torque_m);
        are_level = are_level && rotor.axis[2] > 1 - 1e-12;
    }
    if (!are_level) {
        all += "  axes:\n";
        for (const SpaceRotor& rotor : robot.plant.rotors) {
            all += "    - " + list(rotor.axis) + "\n";
        }
    }
    all += line(
        "  spin",
        "[" + joined(robot.plant.rotors, ", ", [](const SpaceRotor& rotor) { return std::to_string(rotor.spin); }) +
            "]",
        from.spin_source);
    all += line("  torque_ratio_m", one_or_list(torque_ratios), from.torque_source);
    all += line("  min_thrust_n", one_or_list(robot.min_thrust_n));
    all += line("  max_thrust_n", one_or_list(robot.max_thrust_n), from.thrust_source);
    all += line("  time_constant_s", text(robot.plant.time_constant_s), from.time_constant_s.source);
    all += line("  power_coefficient_w_n1p5", text(robot.plant.power_coefficient_w_n1p5),
                from.power_coefficient_w_n1p5.source);
    if (robot.plant.thrust_coefficient_n_s2 > 0) {
        all += line("  thrust_coefficient_n_s2", text(robot.plant.thrust_coefficient_n_s2),
                    from.thrust_coefficient_n_s2.source);
    }
    return all;
}

std::string arm_text(const BuiltRobot& built) {
    const SpaceRobot& robot = built.robot;
    if (robot.links.empty()) {
        return {};
    }
    std::string all = "\narm:\n  links:\n";
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        const SpaceLink& link = robot.plant.links[i];
        const SpaceLinkLimits& limits = robot.links[i];
        const std::string rate = built.joint_rates[i];
        all += "    # joint " + excerpt(built.joint_names[i]) +
               (rate.empty() ? "" : ", which turns at up to " + rate + " (motion.max_joint_rate_deg_s of problems)") +
               ": " + built.part_sources[i + 1] + "\n";
        all += line("    - joint_m", list(link.joint_m)) + line("      axis", list(link.axis)) +
               line("      mass_kg", text(link.body.mass_kg)) +
               line("      center_of_mass_m", list(link.center_of_mass_m)) +
               line("      inertia_kg_m2", inertia_text(link.body.inertia_kg_m2)) +
               line("      limits_deg", list(std::vector{limits.lower_limit_rad * degrees_per_radian,
                                                         limits.upper_limit_rad * degrees_per_radian})) +
               line("      max_torque_nm", text(limits.max_torque_nm));
        if (link.viscous_friction_nm_s > 0 || link.coulomb_friction_nm > 0) {
            all += line("      friction", "{viscous_nm_s: " + text(link.viscous_friction_nm_s) +
                                              ", coulomb_nm: " + text(link.coulomb_friction_nm) + "}");
        }
        all += bodies_text(limits.body, "      ");
    }
    all += line("  end_effector_m", list(robot.plant.end_effector_m), built.tool_source);
    all += line("  direction", list(robot.tool_direction), "assumed: away from the last joint");
    return all;
}

}  // namespace

std::string robot_text(const BuiltRobot& built, const std::string& from) {
    std::string all = "# Imported from " + from + " by `downwash robot import`.\n";
    all +=
        "# Body frame: x forward, y left, z up, from the multirotor's centre of mass. Joint angles are those of the "
        "file.\n";
    for (const std::string& joint : built.frozen) {
        all += "# Held: joint " + joint + ".\n";
    }
    all += "schema: downwash/robot/v1\n" + line("name", built.robot.name) + "\n";
    all += multirotor_text(built) + rotors_text(built) + arm_text(built);
    all +=
        "\n# Designed from bandwidths, as by `downwash margins ROBOT --design`. Rate and delay are defaults: set those "
        "of your autopilot.\n";
    return all + controller_yaml(AnyRobot(built.robot));
}

}  // namespace downwash::robot_import
