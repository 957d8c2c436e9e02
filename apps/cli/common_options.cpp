#include "downwash/cli/common_options.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <thread>
#include <utility>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/usage_error.hpp"

namespace downwash::cli {
namespace {

constexpr int max_threads = 256;
constexpr char solution_name[] = "solution.json";

/// The absolute path in an environment variable; empty without one.
std::filesystem::path path_in(const char* variable) {
    const char* text = std::getenv(variable);
    std::filesystem::path path = text == nullptr ? "" : text;
    return path.is_absolute() ? path : std::filesystem::path();
}

}  // namespace

void add_problem(Command command, std::string& file) {
    command.add_option("PROBLEM", file, "problem file").required().offers_files({".yaml", ".yml"});
}

void add_json(Command command, bool& as_json, const std::string& detail) {
    command.add_flag("--json", as_json, meaning_and("JSON instead of text", detail));
}

void add_quiet(Command command, bool& is_quiet) {
    command.add_flag("--quiet", is_quiet, "print only errors on standard error, no progress");
}

void add_no_cache(Command command, bool& no_cache) {
    command.add_flag("--no-cache", no_cache,
                     "neither read nor write the cache of aero maps in $XDG_CACHE_HOME/downwash (~/.cache/downwash)");
}

void add_threads(Command command, int& threads) {
    command
        .add_option(
            "--threads N", threads,
            fmt::format("number of threads, 1 to {}; the result does not depend on it; default: one per processor",
                        max_threads))
        .in_range(1, max_threads);
}

void add_jobs(Command command, std::optional<std::uint64_t>& jobs, const std::string& otherwise) {
    command
        .add_option("--jobs N", jobs, fmt::format("searches at a time, 1 to {}; default: {}", max_threads, otherwise))
        .in_range(1, max_threads);
}

void add_wall_limit(Command command, std::optional<double>& limit_s, const std::string& detail) {
    command
        .add_option("--wall-limit S", limit_s,
                    meaning_and("wall time of the whole command [s], reading and the aero map included", detail))
        .positive();
}

Option add_plan(Command command, std::string& plan) {
    return command.add_option("--plan FILE", plan, "the plan: solution.json, or the folder of the run that wrote it")
        .required()
        .offers_files({".json"});
}

Option add_run(Command command, std::string& folder) {
    return command.add_option("DIR", folder, "folder that `solve` or `execute` wrote to, or the solution.json in it")
        .required();
}

Option add_arm(Command command, std::optional<double>& arm_deg) {
    return command.add_option("--arm-deg A", arm_deg,
                              "arm angle relative to the multirotor [deg]; default: that of the problem's start");
}

void add_pilot(Command command, std::optional<std::string>& folder, const std::string& needs) {
    command.add_option(
        "--pilot DIR", folder,
        meaning_and("deal out the runs to shards by the times that the campaign in this folder has measured", needs));
}

void add_width(Command command, std::optional<int>& width_px) {
    command
        .add_option("--width PX", width_px,
                    fmt::format("width of the pictures [pixels]: {} to {}; default {}", min_picture_width_px,
                                max_picture_width_px, PictureSettings{}.width_px))
        .in_range(min_picture_width_px, max_picture_width_px);
}

void add_no_labels(Command command, bool& no_labels) {
    command.add_flag("--no-labels", no_labels, "leave out the names of obstacles in pictures");
}

void require_coordinate(double coordinate_m, const std::string& where) {
    constexpr double max_m = 1e6;
    if (!(std::abs(coordinate_m) <= max_m)) {
        throw UsageError("{} {}: expected finite coordinates in m, at most {:g} either way", where, coordinate_m,
                         max_m);
    }
}

std::string meaning_and(std::string meaning, const std::string& detail) {
    return detail.empty() ? meaning : std::move(meaning) + "; " + detail;
}

std::string plan_file(const std::string& given) {
    std::error_code ignored;
    return std::filesystem::is_directory(given, ignored) ? (std::filesystem::path(given) / solution_name).string()
                                                         : given;
}

std::string run_folder(const std::string& given) {
    const std::filesystem::path path(given);
    if (std::error_code ignored; path.filename() != solution_name || std::filesystem::is_directory(path, ignored)) {
        return given;
    }
    return path.has_parent_path() ? path.parent_path().string() : ".";
}

double arm_option(const std::optional<double>& arm_deg, const Problem& problem) {
    if (!arm_deg) {
        return problem.start.at[plane::arm];
    }
    constexpr double max_deg = 3600;
    if (!(std::abs(*arm_deg) <= max_deg)) {
        throw UsageError("--arm-deg {}: expected an angle of at most {} degrees", *arm_deg, max_deg);
    }
    const double arm_rad = *arm_deg / degrees_per_radian;
    constexpr double tolerance_rad = 1e-9;
    const ArmParameters& arm = problem.robot.arm;
    if (arm.is_limited &&
        (arm_rad < arm.lower_limit_rad - tolerance_rad || arm_rad > arm.upper_limit_rad + tolerance_rad)) {
        throw UsageError("--arm-deg {}: beyond the arm's limits, expected {:.6g} to {:.6g} degrees", *arm_deg,
                         arm.lower_limit_rad * degrees_per_radian, arm.upper_limit_rad * degrees_per_radian);
    }
    return arm_rad;
}

int default_threads() {
    return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 64U));
}

std::filesystem::path cache_folder(bool no_cache) {
    if (no_cache) {
        return {};
    }
    if (const auto cache = path_in("XDG_CACHE_HOME"); !cache.empty()) {
        return cache / "downwash";
    }
    const auto home = path_in("HOME");
    return home.empty() ? std::filesystem::path() : home / ".cache" / "downwash";
}

int rotor_option(const std::optional<int>& number, int rotors) {
    const int rotor = number.value_or(1);
    if (rotor < 1 || rotor > rotors) {
        throw UsageError("--rotor {}: expected a number from 1 to {}", rotor, rotors);
    }
    return rotor - 1;
}

double pitch_option(double pitch_deg) {
    constexpr double max_deg = 80;  // beyond it a multirotor is lost: unstable_pitch_rad
    if (!(std::abs(pitch_deg) <= max_deg)) {
        throw UsageError("--pitch-deg {}: expected degrees, at most {} either way, positive nose down", pitch_deg,
                         max_deg);
    }
    return pitch_deg / degrees_per_radian;
}

PictureFormat picture_format(const std::string& option, const std::string& file) {
    const std::optional<PictureFormat> format = picture_format_of(file);
    if (!format) {
        throw UsageError("{} '{}': expected a name that ends in .svg, .png or .pdf", option, excerpt(file));
    }
    return *format;
}

}  // namespace downwash::cli
