#include <fmt/core.h>

#include <optional>
#include <string>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/completion.hpp"
#include "downwash/cli/run_folder.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/exports/export_format.hpp"

namespace downwash::cli {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
    std::string folder;
    std::string format;
    std::optional<std::string> out;
    std::optional<double> rate_hz;
    std::vector<double> origin;
    std::optional<double> bearing_deg;
    bool anyway = false;
};

ExportSettings settings_of(const ExportArguments& given) {
    ExportSettings settings;
    settings.rate_hz = given.rate_hz;
    if (!given.origin.empty()) {
        settings.origin = {given.origin[0], given.origin[1], given.origin[2], given.bearing_deg.value_or(0)};
    }
    return settings;
}

void reject_useless_options(const ExportArguments& given, const ExportFormat& format) {
    const auto reject_if = [&format](bool is_useless, const char* option, const char* why) {
        if (is_useless) {
            throw UsageError("{}: the format {} {}", option, format.name, why);
        }
    };
    reject_if(given.rate_hz && !format.has_rate, "--rate", "has no set-points");
    reject_if(!given.origin.empty() && !format.has_origin, "--origin", "stays in the frame of the problem");
    reject_if(given.bearing_deg && given.origin.empty(), "--bearing", "needs --origin with it");
}

/// A plan for others to fly must have flown well here.
void require_good_flight(const RunRecord& run) {
    if (run.plan && (run.status != "solved" || run.outcome != "ok")) {
        throw UsageError(
            "this plan is not fit to be flown: its status is '{}' and its flight ended '{}'; --anyway writes it",
            excerpt(run.status), excerpt(run.outcome));
    }
}

ExitCode run(const ExportArguments& given) {
    const ExportFormat& chosen = entry_named(export_formats(), given.format, "--format");
    reject_useless_options(given, chosen);
    const fs::path file =
        given.out ? fs::path(*given.out) : fs::path(run_folder(given.folder)) / std::string(chosen.file_name);
    const RunRecord record = read_run(run_folder(given.folder));
    if (chosen.is_to_be_flown && !given.anyway) {
        require_good_flight(record);
    }
    write_made_from(source_of(run_folder(given.folder), record), file.parent_path(),
                    {{file.filename().string(), exported(record, chosen, settings_of(given))}});
    fmt::print("{}\n", file.string());
    return ExitCode::done;
}

std::string formats_help() {
    std::string text = "what to write, and its usual name:";
    for (const ExportFormat& format : export_formats()) {
        text += fmt::format("\n{} ({}): {}", format.name, format.file_name, format.description);
    }
    return text;
}

}  // namespace

void add_export(Command program, Action& action) {
    auto [command, given] =
        add_command(program, action, "export", "Write a run as a file that other programs read", run);
    add_run(command, given.folder);
    Option option = command.add_option("--format F", given.format, formats_help()).required();
    option.offers(names_of(export_formats()));
    add_out(command, "FILE", given.out, "a file; default its usual name, in that folder");
    command.add_option("--rate HZ", given.rate_hz, "set-points per second; default: the controller's rate");
    command
        .add_option(
            "--origin LATITUDE LONGITUDE ALTITUDE", given.origin,
            "origin of the world frame, for qgc: latitude and longitude in degrees (WGS 84), and altitude of z = 0 "
            "in m above mean sea level")
        .values(3);
    command.add_option("--bearing DEG", given.bearing_deg,
                       "compass direction of the world's x axis, clockwise from north; default 0");
    command.add_flag("--anyway", given.anyway, "write a plan for others to fly even if its own flight failed");
}

}  // namespace downwash::cli
