#include <fmt/core.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/commands.hpp"
#include "downwash/cli/completion.hpp"
#include "downwash/cli/output_folder.hpp"
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

std::vector<std::string_view> format_names() {
    std::vector<std::string_view> names;
    for (const ExportFormat& format : export_formats()) {
        names.push_back(format.name);
    }
    return names;
}

const ExportFormat& format_named(const std::string& name) {
    for (const ExportFormat& format : export_formats()) {
        if (format.name == name) {
            return format;
        }
    }
    const std::vector<std::string_view> names = format_names();
    throw UsageError(fmt::format("there is no format '{}': expected {}{}", excerpt(name), joined_names(names),
                                 did_you_mean(name, names)));
}

ExportSettings settings_of(const ExportArguments& arguments) {
    ExportSettings settings;
    settings.rate_hz = arguments.rate_hz;
    if (!arguments.origin.empty()) {
        settings.origin = {arguments.origin[0], arguments.origin[1], arguments.origin[2],
                           arguments.bearing_deg.value_or(0)};
    }
    return settings;
}

void refuse_idle_options(const ExportArguments& arguments, const ExportFormat& format) {
    const auto refuse = [&format](const char* option, const char* why) {
        throw UsageError(fmt::format("{}: the format {} {}", option, format.name, why));
    };
    if (arguments.rate_hz && !format.has_rate) {
        refuse("--rate", "has no set-points");
    }
    if (!arguments.origin.empty() && !format.has_origin) {
        refuse("--origin", "stays in the frame of the problem");
    }
    if (arguments.bearing_deg && arguments.origin.empty()) {
        refuse("--bearing", "needs --origin with it");
    }
}

/// What others are to fly has to have flown well here.
void require_good_flight(const RunRecord& run) {
    if (run.plan && (run.status != "solved" || run.outcome != "ok")) {
        throw UsageError(fmt::format(
            "this plan is not fit to be flown: its status is '{}' and its flight ended '{}'; --anyway writes it",
            excerpt(run.status), excerpt(run.outcome)));
    }
}

ExitCode run(const ExportArguments& arguments) {
    const ExportFormat& format = format_named(arguments.format);
    refuse_idle_options(arguments, format);
    const fs::path file =
        arguments.out ? fs::path(*arguments.out) : fs::path(arguments.folder) / std::string(format.file_name);
    const RunRecord record = read_run(arguments.folder);
    if (format.is_to_be_flown && !arguments.anyway) {
        require_good_flight(record);
    }
    write_result(file, exported(record, format, settings_of(arguments)));
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

void add_export(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<ExportArguments>();
    CLI::App* command = program.add_subcommand("export", "Write a run as a file that other programs read");
    command->add_option("DIR", arguments->folder, "folder that `solve` or `execute` wrote to")->required();
    CLI::Option* format =
        command->add_option("--format", arguments->format, formats_help())->type_name("F")->required();
    offer_words(*format, format_names());
    command->add_option("-o,--out", arguments->out, "the file; default its usual name, in that folder")
        ->type_name("FILE");
    command->add_option("--rate", arguments->rate_hz, "set-points per second; default: the controller's rate")
        ->type_name("HZ");
    command
        ->add_option(
            "--origin", arguments->origin,
            "where the world frame lies, for qgc: latitude and longitude in degrees (WGS 84), and altitude of z = 0 "
            "in m above mean sea level")
        ->type_name("LATITUDE LONGITUDE ALTITUDE")
        ->expected(3);
    command
        ->add_option("--bearing", arguments->bearing_deg,
                     "compass direction of the world's x axis, clockwise from north; default 0")
        ->type_name("DEG");
    command->add_flag("--anyway", arguments->anyway, "write a plan for others to fly though its own flight failed");
    command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace downwash::cli
