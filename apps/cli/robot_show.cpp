#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include "downwash/base/files.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/program.hpp"
#include "downwash/cli/robot_commands.hpp"
#include "downwash/cli/run_report.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/report/robot_page.hpp"
#include "downwash/report/shown_robot.hpp"
#include "downwash/simulation/space_statics.hpp"

namespace downwash::cli {
namespace {

std::string triple(const Vector3& v) {
    return joined(v, ", ", [](double x) { return to_fixed_text(x, 3); });
}

const char* turning(int spin) {
    return spin == 0 ? "" : spin > 0 ? ", turns left" : ", turns right";
}

/// "link 2"; of a robot in a vertical plane "arm".
std::string link_name(const ShownRobot& shown, std::size_t link) {
    return shown.is_planar ? "arm" : fmt::format("link {}", link + 1);
}

std::string summary(const ShownRobot& shown) {
    const SpaceRobot& robot = shown.robot;
    const ArmPose pose = arm_pose(robot, shown.joints_rad);
    const std::vector<double> shares = hover_shares(shown);
    std::string masses = fmt::format("{} kg", to_text(robot.mass_kg(), 6));
    if (!robot.links.empty()) {
        masses += fmt::format(": multirotor {} kg", to_text(robot.plant.multirotor.mass_kg, 6));
        for (std::size_t i = 0; i < robot.links.size(); ++i) {
            masses += fmt::format(", {} {} kg", link_name(shown, i), to_text(robot.plant.links[i].body.mass_kg, 6));
        }
    }
    std::string text = table_row("robot", robot.name + (shown.is_planar ? ", in a vertical plane" : ", in space")) +
                       table_row("mass", masses);
    if (!robot.links.empty()) {
        text += table_row("shown at", "joints " + joints_text(shown.joints_rad) +
                                          " deg; places from the multirotor's "
                                          "centre of mass") +
                table_row("centre of mass", triple(center_of_mass_m(robot, pose)) + " m");
        for (std::size_t i = 0; i < robot.links.size(); ++i) {
            text += table_row(link_name(shown, i),
                              triple(pose.center_of_mass_m[i]) + " m, its joint " + triple(pose.joint_m[i]) + " m");
        }
        text +=
            table_row("end effector", triple(pose.end_effector_m) + " m, reach " + to_text(shown.reach_m, 4) + " m");
    }
    text += table_row("thrust / weight", to_text(shown.thrust_to_weight, 3));
    for (std::size_t k = 0; k < robot.plant.rotors.size(); ++k) {
        const SpaceRotor& rotor = robot.plant.rotors[k];
        const std::string axis = rotor.axis[2] < 1 - 1e-9 ? ", axis " + triple(rotor.axis) : "";
        text += table_row(fmt::format("rotor {}", k + 1),
                          fmt::format("{} m{}{}, hover {} N, {:.0f} % of {} N", triple(rotor.position_m), axis,
                                      turning(rotor.spin), to_text(shares[k] * robot.max_thrust_n[k], 4),
                                      100 * shares[k], to_text(robot.max_thrust_n[k], 4)));
    }
    return text +
           table_row(
               "hover",
               fmt::format("at most {:.0f} %, by rotor {}{}", 100 * shown.hover_share, shown.hover_rotor + 1,
                           robot.links.empty() ? "" : ", with joints " + joints_text(shown.hover_joints_rad) + " deg"));
}

Json document(const ShownRobot& shown, const RobotShowArguments& given, const std::vector<LocatedError>& warnings) {
    const SpaceRobot& robot = shown.robot;
    const ArmPose pose = arm_pose(robot, shown.joints_rad);
    const std::vector<double> shares = hover_shares(shown);
    auto rotors = Json::array(), links = Json::array(), said = Json::array();
    for (std::size_t k = 0; k < robot.plant.rotors.size(); ++k) {
        const SpaceRotor& rotor = robot.plant.rotors[k];
        rotors.push_back({{"position_m", rotor.position_m},
                          {"axis", rotor.axis},
                          {"spin", rotor.spin == 0 ? Json() : Json(rotor.spin)},
                          {"max_thrust_n", robot.max_thrust_n[k]},
                          {"hover_thrust_n", shares[k] * robot.max_thrust_n[k]},
                          {"hover_share", shares[k]}});
    }
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        links.push_back({{"mass_kg", robot.plant.links[i].body.mass_kg},
                         {"joint_m", pose.joint_m[i]},
                         {"center_of_mass_m", pose.center_of_mass_m[i]}});
    }
    for (const LocatedError& warning : warnings) {
        said.push_back({{"line", warning.line}, {"column", warning.column}, {"message", warning.message}});
    }
    return {{"robot", robot.name},
            {"file", given.robot},
            {"is_planar", shown.is_planar},
            {"mass_kg", robot.mass_kg()},
            {"multirotor_mass_kg", robot.plant.multirotor.mass_kg},
            {"joints_rad", shown.joints_rad},
            {"center_of_mass_m", center_of_mass_m(robot, pose)},
            {"end_effector_m", pose.end_effector_m},
            {"reach_m", shown.reach_m},
            {"thrust_to_weight", shown.thrust_to_weight},
            {"links", std::move(links)},
            {"rotors", std::move(rotors)},
            {"greatest_hover_share", shown.hover_share},
            {"page", given.out ? Json(*given.out) : Json()},
            {"warnings", std::move(said)}};
}

}  // namespace

bool is_model_file(const std::string& file) {
    constexpr std::size_t enough = 4096;
    try {
        std::string_view text = trimmed(read_file(file, enough));
        constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
        if (text.starts_with(byte_order_mark)) {
            text = trimmed(text.substr(byte_order_mark.size()));
        }
        return text.starts_with('<');
    } catch (const FileError&) {
        return false;
    }
}

ExitCode show(const ShownRobot& shown, const RobotShowArguments& given, const std::vector<LocatedError>& warnings) {
    if (given.out) {
        if (!is_same_word(std::filesystem::path(*given.out).extension().string(), ".html")) {
            throw UsageError("--out '{}': expected a name that ends in .html", excerpt(*given.out));
        }
        require_pages();
        std::vector<std::string> said;
        said.reserve(warnings.size());
        for (const LocatedError& warning : warnings) {
            said.push_back(to_text(warning));
        }
        write_result(*given.out, robot_page(shown, given.robot, said), "--out");
    }
    if (given.as_json) {
        print_json(document(shown, given, warnings));
    } else {
        fmt::print("{}{}", summary(shown), given.out ? table_row("page", *given.out) : "");
    }
    return ExitCode::done;
}

ExitCode show_robot_file(const RobotShowArguments& given) {
    if (is_model_file(given.robot)) {
        throw LeftToPart();
    }
    std::vector<LocatedError> warnings;
    const auto note = noting(warnings, false);
    const ShownRobot shown = is_space_robot_file(given.robot) ? shown_robot(read_space_robot(given.robot, note))
                                                              : shown_robot(read_robot(given.robot, note));
    return show(shown, given, warnings);
}

}  // namespace downwash::cli
