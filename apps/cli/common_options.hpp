#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/cli/commands.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/report/picture.hpp"

namespace downwash::cli {

/// Adds a command: if it is given, `run` is called with the values of its options. Without `run` it sets no action.
/// @return the command and those values, for its options to be added
template <class Arguments>
std::pair<Command, Arguments&> add_command(Command parent, Action& action, const std::string& name,
                                           const std::string& description, ExitCode (*run)(const Arguments&)) {
    const auto given = std::make_shared<Arguments>();
    Command command = parent.add_command(name, description);
    // The values live as long as the command line, with or without something to run.
    command.on_given([=, &action] {
        if (run != nullptr) {
            action = [=] { return run(*given); };
        }
    });
    return {command, *given};
}

// Options that several commands have, each with the same name and short form everywhere. The description begins with
// the meaning, which is the same everywhere too; what differs between commands follows a semicolon.

/// "meaning; detail", or the meaning alone.
[[nodiscard]] std::string meaning_and(std::string meaning, const std::string& detail);

void add_problem(Command command, std::string& file);
void add_json(Command command, bool& as_json, const std::string& detail = "");
void add_quiet(Command command, bool& is_quiet);
void add_no_cache(Command command, bool& no_cache);
void add_threads(Command command, int& threads);
/// @param otherwise how many there are without the option, in words
void add_jobs(Command command, std::optional<std::uint64_t>& jobs, const std::string& otherwise);
/// --wall-limit. @param detail what happens when the limit is reached
void add_wall_limit(Command command, std::optional<double>& limit_s, const std::string& detail);
/// Its value: see plan_file().
Option add_plan(Command command, std::string& plan);
/// Its value: see run_folder().
Option add_run(Command command, std::string& folder);
/// See arm_option().
Option add_arm(Command command, std::optional<double>& arm_deg);
/// --pilot. @param needs which option it requires, for the help
void add_pilot(Command command, std::optional<std::string>& folder, const std::string& needs);
void add_width(Command command, std::optional<int>& width_px);
void add_no_labels(Command command, bool& no_labels);

/// -o,--out. @param placeholder FILE or DIR   @param detail what it holds, and where it is without the option
template <class Value>
Option add_out(Command command, const std::string& placeholder, Value& out, const std::string& detail) {
    return command.add_option("-o,--out " + placeholder, out, meaning_and("where to write", detail));
}

/// --at with `size` coordinates; it may be repeated.
template <std::size_t size>
Option add_points(Command command, std::vector<std::array<double, size>>& points, const std::string& detail) {
    return command
        .add_option(size == 2 ? "--at X Z" : "--at X Y Z", points, meaning_and("a point; may be repeated", detail))
        .repeated();
}

/// Checks a coordinate that a user gave [m]. @param where it was given, for the message
/// @throws UsageError unless it is finite and within +-1e6
void require_coordinate(double coordinate_m, const std::string& where);

/// The number of threads that a command uses unless told otherwise: one per processor, 64 at most.
[[nodiscard]] int default_threads();

/// The folder that keeps the user's aero maps between runs: $XDG_CACHE_HOME/downwash, or $HOME/.cache/downwash if
/// that variable holds no absolute path. Empty when there is no home either, or no cache is wanted.
[[nodiscard]] std::filesystem::path cache_folder(bool no_cache = false);

/// The file of a plan that --plan gives: the given file, or solution.json in the given folder.
[[nodiscard]] std::string plan_file(const std::string& given);

/// The folder of a run: the given folder, or the one that holds the given solution.json.
[[nodiscard]] std::string run_folder(const std::string& given);

/// The arm angle that --arm-deg gives [rad]; that of the start without one. @throws UsageError beyond the arm's limits
[[nodiscard]] double arm_option(const std::optional<double>& arm_deg, const Problem& problem);

/// The index of the rotor that --rotor N names, counted from 0; that of the first rotor without a number.
/// @throws UsageError when the vehicle has no such rotor
[[nodiscard]] int rotor_option(const std::optional<int>& number, int rotors);

/// The pitch that --pitch-deg gives [rad]. @throws UsageError for one at which no vehicle flies
[[nodiscard]] double pitch_option(double pitch_deg);

/// The format that the name of a picture's file asks for. @throws UsageError when it is none
[[nodiscard]] PictureFormat picture_format(const std::string& option, const std::string& file);

}  // namespace downwash::cli
