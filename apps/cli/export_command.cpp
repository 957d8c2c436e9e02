#include "downwash/cli/export_command.hpp"

#include <fmt/core.h>

#include "downwash/cli/common_options.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/exports/export_format.hpp"

namespace downwash::cli {
namespace {

std::string formats_help() {
    std::string text = "what to write, and its usual name:";
    for (const ExportFormat& format : export_formats) {
        text += fmt::format("\n{} ({}): {}", format.name, format.file_name, format.description);
    }
    return text;
}

}  // namespace

void add_export(Command program, Action& action, ExitCode (*run)(const ExportArguments&)) {
    auto [command, given] =
        add_command(program, action, "export",
                    "Write a run as a file that other programs read; with --check, read set-points back and compare "
                    "them with the plan",
                    run);
    add_run(command, given.folder);
    Option option = command.add_option("--format F", given.format, formats_help());
    option.offers(names_of(export_formats));
    add_out(command, "FILE", given.out, "a file; default its usual name, in that folder");
    command.add_option("--rate HZ", given.rate_hz, "set-points per second; default: the controller's rate");
    command
        .add_option(
            "--origin LATITUDE LONGITUDE ALTITUDE", given.origin,
            "origin of the world frame, for qgc: latitude and longitude in degrees (WGS 84), and altitude of z = 0 "
            "in m above mean sea level")
        .values(3);
    command.add_option("--bearing DEG", given.bearing_deg,
                       "compass direction of the world's x axis, clockwise from north, for px4, px4-csv, mavlink, "
                       "qgc and ros; default 0");
    Option end = command.add_option("--end WHAT", given.end,
                                    "what a mission (qgc) does after the plan: hover; land, straight below; or return, "
                                    "the autopilot's own way home, "
                                    "which most climb for first");
    end.offers(mission_ends);
    command.add_flag("--anyway", given.anyway, "write a plan for others to fly even if its own flight failed");
    command
        .add_option("--check FILE", given.check,
                    "write nothing, but read set-points (csv, ros, px4, px4-csv or mavlink) and compare them with the "
                    "plan: positions and angles as they are, velocities and accelerations integrated; exit code 3 if "
                    "they do not fit within 1 cm and 0.01 rad")
        .offers_files({".csv", ".json", ".tlog"});
    add_json(command, given.as_json, "with --check");
}

}  // namespace downwash::cli
