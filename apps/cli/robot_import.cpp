#include "downwash/robot_import/robot_import.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/robot_commands.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/report/shown_robot.hpp"
#include "downwash/simulation/space_robot_facts.hpp"

namespace downwash::cli {
namespace {

FrozenJoint frozen_joint(const std::string& given) {
    const std::size_t equals = given.rfind('=');
    const auto position = equals == std::string::npos ? std::nullopt : parse_number<double>(given.substr(equals + 1));
    if (!position || equals == 0) {
        throw UsageError(
            "--freeze is '{}': expected JOINT=DEG, a joint of the file and an angle in degrees (of a "
            "sliding joint in m)",
            excerpt(given));
    }
    return {given.substr(0, equals), *position};
}

ImportSettings settings_of(const RobotImportArguments& given) {
    ImportSettings settings;
    settings.name = given.name.value_or("");
    for (const std::string& joint : given.frozen) {
        settings.frozen.push_back(frozen_joint(joint));
    }
    settings.arm_end = given.arm_end.value_or("");
    settings.tool = given.tool.value_or("");
    settings.massless = given.massless;
    settings.skips_meshes = given.skips_meshes;
    settings.forward = given.forward.value_or(settings.forward);
    settings.up = given.up.value_or(settings.up);
    settings.rotors = given.rotors.value_or("");
    settings.rotor_radius_m = given.rotor_radius_m;
    settings.min_thrust_n = given.min_thrust_n;
    settings.max_thrust_n = given.max_thrust_n;
    settings.torque_ratio_m = given.torque_ratio_m;
    settings.time_constant_s = given.rotor_lag_s;
    settings.power_coefficient_w_n1p5 = given.power_coefficient;
    for (const double spin : given.spins) {
        if (spin != 1 && spin != -1) {
            throw UsageError("--spin has {}: expected 1 or -1 for each rotor", spin);
        }
        settings.spins.push_back(spin > 0 ? 1 : -1);
    }
    return settings;
}

void print_warnings(const std::vector<LocatedError>& warnings) {
    for (const LocatedError& warning : warnings) {
        print_warning(warning);
    }
}

}  // namespace

ExitCode import_robot_file(const RobotImportArguments& given) {
    const ImportSettings settings = settings_of(given);
    require_writable_result(given.out, "--out");
    const ImportedRobot imported = import_robot(given.file, settings);
    write_result(given.out, imported.yaml, "--out");
    print_warnings(imported.warnings);
    const SpaceRobotFacts facts = space_robot_facts(imported.robot);
    const std::vector<double> shares = hover_shares(shown_robot(imported.robot));
    if (given.as_json) {
        auto warnings = Json::array();
        for (const LocatedError& warning : imported.warnings) {
            warnings.push_back({{"line", warning.line}, {"column", warning.column}, {"message", warning.message}});
        }
        print_json({{"robot", imported.robot.name},
                    {"file", given.out},
                    {"mass_kg", facts.mass_kg},
                    {"joints", facts.joints},
                    {"reach_m", facts.reach_m},
                    {"thrust_to_weight", facts.thrust_to_weight},
                    {"hover_share", shares},
                    {"greatest_hover_share", facts.hover_share},
                    {"warnings", std::move(warnings)}});
        return ExitCode::done;
    }
    fmt::print(
        "{}",
        table_row("robot", imported.robot.name) + table_row("mass", to_text(facts.mass_kg, 6) + " kg") +
            table_row("joints", std::to_string(facts.joints)) +
            (facts.joints > 0 ? table_row("reach", to_text(facts.reach_m, 4) + " m") : std::string()) +
            table_row("thrust / weight", to_text(facts.thrust_to_weight, 3)) +
            table_row("hover", fmt::format("{} of the greatest thrust of rotors 1 to {}, arm at zero; "
                                           "at most {:.0f} %",
                                           joined(shares, ", ",
                                                  [](double share) { return fmt::format("{:.0f} %", 100 * share); }),
                                           shares.size(), 100 * facts.hover_share)) +
            table_row("file", given.out));
    return ExitCode::done;
}

ExitCode show_any_robot(const RobotShowArguments& given) {
    if (!is_model_file(given.robot)) {
        return show_robot_file(given);
    }
    const ImportedRobot imported = import_robot(given.robot);
    print_warnings(imported.warnings);
    return show(shown_robot(imported.robot), given, imported.warnings);
}

}  // namespace downwash::cli
