#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <string>

#include "downwash/base/angles.hpp"
#include "downwash/base/files.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/export_command.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/run_folder.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/exports/setpoint_check.hpp"

namespace downwash::cli {
namespace {

constexpr std::size_t max_setpoint_bytes = std::size_t{512} << 20U;

void reject_other_options(const ExportArguments& given) {
    const auto reject_if = [](bool is_given, const char* option) {
        if (is_given) {
            throw UsageError("{}: --check writes nothing, and the file itself shows its format and rate", option);
        }
    };
    reject_if(!given.format.empty(), "--format");
    reject_if(given.out.has_value(), "--out");
    reject_if(given.rate_hz.has_value(), "--rate");
    reject_if(!given.origin.empty(), "--origin");
    reject_if(given.end != "hover", "--end");
    reject_if(given.anyway, "--anyway");
}

SetpointCheck check_of(const ExportArguments& given) {
    const std::string file = *given.check;
    const std::string text = naming(file, [&] { return read_whole_file(file, max_setpoint_bytes); });
    const std::string folder = run_folder(given.folder);
    const double bearing_deg = given.bearing_deg.value_or(0);
    return is_space_run(folder) ? check_setpoints(read_space_run(folder), text, file, bearing_deg)
                                : check_setpoints(read_run(folder), text, file, bearing_deg);
}

std::string text_of(const SetpointDistance& distance) {
    const auto text = [&](double value) {
        constexpr double metre_mm = 1000;
        return distance.is_angle ? to_fixed_text(value * degrees_per_radian, 3) + " degrees"
                                 : to_fixed_text(value * metre_mm, 3) + " mm";
    };
    std::string all = "off by " + text(distance.itself);
    if (distance.rate_integrated) {
        all += fmt::format(", by its {} {}", distance.is_angle ? "rate" : "velocity", text(*distance.rate_integrated));
    }
    if (distance.acceleration_integrated) {
        all += ", by its acceleration " + text(*distance.acceleration_integrated);
    }
    return all;
}

std::string text_of(const SetpointCheck& check) {
    std::string text = check.fits() ? "The set-points fit the plan.\n\n" : "The set-points do not fit the plan.\n\n";
    text += table_row("format", std::string(check.format));
    text += table_row("set-points", fmt::format("{} in {:.3f} s", check.count, check.duration_s));
    for (const SetpointDistance& distance : check.distances) {
        text += table_row(distance.name, text_of(distance));
    }
    return text + (check.has_arm ? "" : table_row("arm", "not in the file"));
}

Json json_of(const SetpointCheck& check) {
    Json distances = Json::array();
    for (const SetpointDistance& distance : check.distances) {
        distances.push_back({{"name", distance.name},
                             {"unit", distance.is_angle ? "rad" : "m"},
                             {"itself", finite(distance.itself)},
                             {"rate_integrated", cli::json_of(distance.rate_integrated)},
                             {"acceleration_integrated", cli::json_of(distance.acceleration_integrated)}});
    }
    return {{"format", check.format},         {"fits", check.fits()},     {"setpoints", check.count},
            {"duration_s", check.duration_s}, {"has_arm", check.has_arm}, {"distances", std::move(distances)},
            {"findings", check.findings}};
}

}  // namespace

ExitCode check_exported(const ExportArguments& given) {
    reject_other_options(given);
    const SetpointCheck check = check_of(given);
    for (const std::string& finding : check.findings) {
        print_error(finding + "\n");
    }
    if (given.as_json) {
        print_json(json_of(check));
    } else {
        fmt::print("{}", text_of(check));
    }
    return check.fits() ? ExitCode::done : ExitCode::flight_failed;
}

}  // namespace downwash::cli
