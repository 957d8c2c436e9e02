#include <fmt/core.h>

#include <optional>
#include <string>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/completion.hpp"
#include "downwash/cli/output.hpp"
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

    void add_to(CLI::App& command);
    [[nodiscard]] ExitCode run() const;
};

ExportSettings settings_of(const ExportArguments& arguments) {
    ExportSettings settings;
    settings.rate_hz = arguments.rate_hz;
    if (!arguments.origin.empty()) {
        settings.origin = {arguments.origin[0], arguments.origin[1], arguments.origin[2],
                           arguments.bearing_deg.value_or(0)};
    }
    return settings;
}

void reject_useless_options(const ExportArguments& arguments, const ExportFormat& format) {
    const auto reject_if = [&format](bool is_useless, const char* option, const char* why) {
        if (is_useless) {
            throw UsageError(fmt::format("{}: the format {} {}", option, format.name, why));
        }
    };
    reject_if(arguments.rate_hz && !format.has_rate, "--rate", "has no set-points");
    reject_if(!arguments.origin.empty() && !format.has_origin, "--origin", "stays in the frame of the problem");
    reject_if(arguments.bearing_deg && arguments.origin.empty(), "--bearing", "needs --origin with it");
}

/// A plan for others to fly must have flown well here.
void require_good_flight(const RunRecord& run) {
    if (run.plan && (run.status != "solved" || run.outcome != "ok")) {
        throw UsageError(fmt::format(
            "this plan is not fit to be flown: its status is '{}' and its flight ended '{}'; --anyway writes it",
            excerpt(run.status), excerpt(run.outcome)));
    }
}

ExitCode ExportArguments::run() const {
    const ExportFormat& chosen = entry_named(export_formats(), format, "there is no format");
    reject_useless_options(*this, chosen);
    const fs::path file = out ? fs::path(*out) : fs::path(folder) / std::string(chosen.file_name);
    const RunRecord record = read_run(folder);
    if (chosen.is_to_be_flown && !anyway) {
        require_good_flight(record);
    }
    write_result(file, exported(record, chosen, settings_of(*this)));
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

void ExportArguments::add_to(CLI::App& command) {
    command.add_option("DIR", folder, "folder that `solve` or `execute` wrote to")->required();
    CLI::Option* option = command.add_option("--format", format, formats_help())->type_name("F")->required();
    offer_words(*option, names_of(export_formats()));
    command.add_option("-o,--out", out, "the file; default its usual name, in that folder")->type_name("FILE");
    command.add_option("--rate", rate_hz, "set-points per second; default: the controller's rate")->type_name("HZ");
    command
        .add_option("--origin", origin,
                    "origin of the world frame, for qgc: latitude and longitude in degrees (WGS 84), and altitude of "
                    "z = 0 in m above mean sea level")
        ->type_name("LATITUDE LONGITUDE ALTITUDE")
        ->expected(3);
    command
        .add_option("--bearing", bearing_deg,
                    "compass direction of the world's x axis, clockwise from north; default 0")
        ->type_name("DEG");
    command.add_flag("--anyway", anyway, "write a plan for others to fly even if its own flight failed");
}

}  // namespace

void add_export(CLI::App& program, Action& action) {
    add_command<ExportArguments>(program, action, "export", "Write a run as a file that other programs read");
}

}  // namespace downwash::cli
