#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/export_command.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/run_folder.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/exports/export_format.hpp"

namespace downwash::cli {
namespace {

namespace fs = std::filesystem;

ExportSettings settings_of(const ExportArguments& given) {
    ExportSettings settings;
    settings.rate_hz = given.rate_hz;
    if (!given.origin.empty()) {
        settings.origin = {given.origin[0], given.origin[1], given.origin[2]};
    }
    settings.bearing_deg = given.bearing_deg.value_or(0);
    settings.is_east_north_up = given.bearing_deg.has_value();
    const auto end = std::find(mission_ends.begin(), mission_ends.end(), given.end);
    if (end == mission_ends.end()) {
        reject_unknown("--end", given.end, {mission_ends.begin(), mission_ends.end()});
    }
    settings.mission_end = static_cast<MissionEnd>(end - mission_ends.begin());
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
    reject_if(given.end != "hover" && !format.has_origin, "--end", "is no mission");
    reject_if(given.bearing_deg && !format.has_bearing, "--bearing", "stays in the frame of the problem");
}

/// A plan for others to fly must have flown well here.
/// @param run a RunRecord or SpaceRunRecord
template <class Record>
void require_good_flight(const Record& run) {
    if (run.plan && (run.status != "solved" || run.outcome != "ok")) {
        throw UsageError(
            "this plan is not fit to be flown: its status is '{}' and its flight ended '{}'; --anyway writes it",
            excerpt(run.status), excerpt(run.outcome));
    }
}

template <class Record>
void write_export(const Record& run, const ExportFormat& format, const fs::path& file, const ExportArguments& given) {
    if (format.is_to_be_flown && !given.anyway) {
        require_good_flight(run);
    }
    write_made_from(source_of(run_folder(given.folder), run.solution_text), file.parent_path(),
                    {{file.filename().string(), exported(run, format, settings_of(given))}});
    for (const std::string& warning : export_warnings(run, format)) {
        print_error(fmt::format("warning: {}\n", warning));
    }
}

}  // namespace

ExitCode export_run(const ExportArguments& given) {
    if (given.check) {
        return check_exported(given);
    }
    if (given.format.empty()) {
        throw UsageError("expected --format F, what to write, or --check FILE, set-points to compare with the plan");
    }
    if (given.as_json) {
        throw UsageError("--json: expected --check too");
    }
    const ExportFormat& chosen = entry_named(export_formats, given.format, "--format");
    reject_useless_options(given, chosen);
    const fs::path folder = run_folder(given.folder);
    const fs::path file = given.out ? fs::path(*given.out) : folder / std::string(chosen.file_name);
    if (is_space_run(folder)) {
        write_export(read_space_run(folder), chosen, file, given);
    } else {
        write_export(read_run(folder), chosen, file, given);
    }
    fmt::print("{}\n", file.string());
    return ExitCode::done;
}

}  // namespace downwash::cli
