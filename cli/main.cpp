#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <vector>

#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/base/version.hpp"
#include "downwash/cli/command_line.hpp"
#include "downwash/cli/commands.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash::cli {
namespace {

constexpr char about[] =
    "Motion planning for aerial manipulators that considers the aerodynamic effects of nearby surfaces";
constexpr char exit_codes[] =
    "Exit codes: 0 done; 1 no solution within the limits; 2 bad input or usage; 3 a plan exists, but its flight "
    "failed;\n"
    "130 after SIGINT, 143 after SIGTERM: the best solution so far is written; a second signal ends at once.";

/// CLI11 would call an unknown option an argument that was not expected.
/// @param words what follows the command's name
void reject_unknown_option(const Command& command, std::span<char* const> words) {
    std::vector<std::string> known;
    for (const Option& option : command.options()) {
        for (const std::string& name : option.names()) {
            if (name.starts_with("--")) {
                known.push_back(name);
            }
        }
    }
    const std::vector<std::string_view> names(known.begin(), known.end());
    for (const std::string_view word : words) {
        if (word == "--") {
            return;
        }
        const std::string_view name = word.substr(0, word.find('='));
        if (name.starts_with("--") && std::find(names.begin(), names.end(), name) == names.end()) {
            const bool was_out = name == "--output" || name == "--plot";  // in earlier versions
            const bool has_out = std::find(names.begin(), names.end(), "--out") != names.end();
            const std::string hint = was_out && has_out ? "; did you mean '--out'?" : did_you_mean(name, names);
            throw UsageError("{} has no option {}: expected {}{}\nSee {} --help.", command.full_name(), excerpt(name),
                             joined_names(names), hint, command.full_name());
        }
    }
}

/// CLI11 would only say that a command is missing. Rejects options that the command does not have, too.
/// @param words what follows the command's name
void reject_unknown_command(const Command& command, std::span<char* const> words) {
    const std::vector<Command> known = command.commands();
    if (known.empty() || (!words.empty() && std::string_view(words[0]).starts_with("-"))) {
        reject_unknown_option(command, words);
        return;
    }
    if (words.empty()) {
        return;
    }
    const std::string_view word = words[0];
    std::vector<std::string_view> names;
    for (const Command& one : known) {
        if (one.name() == word) {
            reject_unknown_command(one, words.subspan(1));
            return;
        }
        names.push_back(one.name());
    }
    const std::string parent = command.is_program() ? "" : command.name() + " ";
    throw UsageError("there is no command '{}{}': expected {}{}", parent, excerpt(word), joined_names(names),
                     did_you_mean(word, names));
}

void add_aeromap(Command program, Action& action) {
    Command aeromap = program.add_command("aeromap", "Show how surfaces change the thrust of a rotor");
    aeromap.require_command();
    for (const auto add : {add_aeromap_query, add_aeromap_build, add_aeromap_info, add_aeromap_plot, add_aeromap_fit,
                           add_aeromap_compare, add_aeromap_hold}) {
        add(aeromap, action);
    }
}

void add_bench(Command program, Action& action) {
    Command bench = program.add_command("bench", "Run campaigns: many searches, their success, times and costs");
    bench.require_command();
    for (const auto add : {add_bench_run, add_bench_slurm, add_bench_parallel, add_bench_merge, add_bench_report}) {
        add(bench, action);
    }
}

void add_study(Command program, Action& action) {
    Command study = program.add_command("study", "Check claims by runs of our own");
    study.require_command();
    add_study_uncertainty(study, action);
    add_thesis_studies(study, action);
}

/// Results that do not reach standard output are an error, unless its reader went away.
ExitCode checked_output(ExitCode code) {
    errno = 0;
    const bool has_failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
    if (has_failed && errno != EPIPE) {
        throw UsageError("standard output cannot be written");
    }
    return code;
}

ExitCode run(int argc, char** argv) {
    CommandLine line(about, "downwash " + std::string(version()), exit_codes);
    Action action;
    for (const auto add :
         {add_init, add_check, add_explain, add_solve, add_execute, add_validate, add_aeromap, add_bench, add_study,
          add_report, add_export, add_margins, add_planners, add_manual, add_completion}) {
        add(line.program(), action);
    }
    reject_unknown_command(line.program(), std::span(argv, static_cast<std::size_t>(argc)).subspan(argc > 0 ? 1 : 0));
    const std::optional<ExitCode> end = line.parse(argc, argv);
    if (end && *end != ExitCode::done) {
        return *end;
    }
    return checked_output(end ? *end : action());
}

/// Prints errors, each line with the name of the program.
void print_errors(std::string_view errors) {
    while (!errors.empty()) {
        const std::size_t end = std::min(errors.find('\n'), errors.size());
        print_error(fmt::format("downwash: {}\n", errors.substr(0, end)));
        errors.remove_prefix(std::min(end + 1, errors.size()));
    }
}

}  // namespace
}  // namespace downwash::cli

int main(int argc, char** argv) {
    using downwash::cli::ExitCode;
    // A closed pipe shows as a failed write instead of ending the program.
    std::signal(SIGPIPE, SIG_IGN);
    // So does a file that may not grow any more (ulimit -f).
    std::signal(SIGXFSZ, SIG_IGN);
    ExitCode code = ExitCode::bad_input;
    try {
        code = downwash::cli::run(argc, argv);
    } catch (const downwash::ProblemFileError& error) {
        downwash::cli::print_error(fmt::format("{}\n", error.what()));
    } catch (const std::logic_error& error) {
        downwash::cli::print_error(
            fmt::format("downwash: this is a bug in downwash, please report it: {}\n", error.what()));
        std::abort();
    } catch (const std::bad_alloc&) {
        downwash::cli::print_errors(
            "out of memory: choose a larger aero.grid_m or --step, smaller bounds, a smaller --width, fewer obstacles "
            "or a shorter search");
    } catch (const std::system_error& error) {
        if (error.code() == std::errc::broken_pipe) {  // who reads standard output has seen enough
            return static_cast<int>(ExitCode::done);
        }
        downwash::cli::print_errors(error.what());
    } catch (const std::exception& error) {
        downwash::cli::print_errors(error.what());
    }
    return static_cast<int>(code);
}
