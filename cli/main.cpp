#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>
#include <span>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <vector>

#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/base/version.hpp"
#include "downwash/cli/command_walk.hpp"
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

/// The command that was given, at any depth.
const CLI::App& given_command(const CLI::App& program) {
    const CLI::App* command = &program;
    for (auto given = command->get_subcommands(); !given.empty(); given = command->get_subcommands()) {
        command = given.front();
    }
    return *command;
}

/// "N" of an option that takes a number; a check that follows is in the description, too.
std::string placeholder_of(const CLI::Option& option) {
    const std::string name = option.get_type_name();
    return name.substr(0, name.find(':'));
}

/// What is wrong in a command line, with a remedy. CLI11 says which option and which value, but not what it expects.
std::string explained(const CLI::App& command, const CLI::Error& error) {
    const std::string message = error.what();
    std::string_view name = message;
    if (error.get_name() == "ConversionError" && name.starts_with("Could not convert: ")) {
        name.remove_prefix(std::string_view("Could not convert: ").size());
    }
    for (const CLI::Option* option : command.get_options()) {
        const std::string spelled = option->get_name();
        if (!name.starts_with(spelled) ||
            (name.size() > spelled.size() && name[spelled.size()] != ' ' && name[spelled.size()] != ':')) {
            continue;
        }
        const std::string expected = fmt::format(
            "{}: {}", option->get_positional() ? option->get_name(true) : spelled + " " + placeholder_of(*option),
            option->get_description());
        const std::string_view value = name.substr(spelled.size());
        if (error.get_name() == "ConversionError" && value.starts_with(" = ")) {
            return fmt::format("{} is '{}': expected {}", spelled, excerpt(value.substr(3)), expected);
        }
        if (error.get_name() == "RequiredError") {
            return fmt::format("{} is required: expected {}", spelled, expected);
        }
        if (error.get_name() == "ArgumentMismatch" && option->get_items_expected_min() > 1) {
            return fmt::format("{} takes {} values: expected {}", spelled, option->get_items_expected_min(), expected);
        }
        if (error.get_name() == "ValidationError" || error.get_name() == "ArgumentMismatch") {
            return fmt::format("{}; expected {}", message, expected);
        }
    }
    return error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)
               ? fmt::format("{}: expected {}", message, usage_line(command))
               : message;
}

/// The error in a command line, and the command that prints help.
std::string usage_error(const CLI::App* program, const CLI::Error& error) {
    const CLI::App& command = given_command(*program);
    return fmt::format("{}: {}\nSee {} --help.\n", program->get_name(), explained(command, error), full_name(command));
}

/// CLI11 would call an unknown option an argument that was not expected.
/// @param words what follows the command's name
void reject_unknown_option(const CLI::App& command, std::span<char* const> words) {
    std::vector<std::string> known;
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            known.push_back("--" + name);
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
            throw UsageError("{} has no option {}: expected {}{}\nSee {} --help.", full_name(command), excerpt(name),
                             joined_names(names), hint, full_name(command));
        }
    }
}

/// CLI11 would only say that a command is missing. Rejects options that the command does not have, too.
/// @param words what follows the command's name
void reject_unknown_command(const CLI::App& command, std::span<char* const> words) {
    const std::vector<const CLI::App*> known = commands_of(command);
    if (known.empty() || (!words.empty() && std::string_view(words[0]).starts_with("-"))) {
        reject_unknown_option(command, words);
        return;
    }
    if (words.empty()) {
        return;
    }
    const std::string_view word = words[0];
    std::vector<std::string_view> names;
    for (const CLI::App* one : known) {
        if (one->get_name() == word) {
            reject_unknown_command(*one, words.subspan(1));
            return;
        }
        names.push_back(one->get_name());
    }
    const std::string parent = command.get_parent() != nullptr ? command.get_name() + " " : "";
    throw UsageError("there is no command '{}{}': expected {}{}", parent, excerpt(word), joined_names(names),
                     did_you_mean(word, names));
}

void add_aeromap(CLI::App& program, Action& action) {
    CLI::App* aeromap = program.add_subcommand("aeromap", "Show how surfaces change the thrust of a rotor");
    aeromap->require_subcommand(1);
    for (const auto add : {add_aeromap_query, add_aeromap_build, add_aeromap_info, add_aeromap_plot, add_aeromap_fit,
                           add_aeromap_compare, add_aeromap_hold}) {
        add(*aeromap, action);
    }
}

void add_bench(CLI::App& program, Action& action) {
    CLI::App* bench = program.add_subcommand("bench", "Run campaigns: many searches, their success, times and costs");
    bench->require_subcommand(1);
    for (const auto add : {add_bench_run, add_bench_slurm, add_bench_parallel, add_bench_merge, add_bench_report}) {
        add(*bench, action);
    }
}

void add_study(CLI::App& program, Action& action) {
    CLI::App* study = program.add_subcommand("study", "Check claims by runs of our own");
    study->require_subcommand(1);
    add_study_uncertainty(*study, action);
    add_thesis_studies(*study, action);
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
    CLI::App program(about, "downwash");
    program.set_version_flag("--version", "downwash " + std::string(version()));
    program.require_subcommand(1);
    program.footer(exit_codes);
    program.failure_message(usage_error);
    Action action;
    for (const auto add :
         {add_init, add_check, add_explain, add_solve, add_execute, add_validate, add_aeromap, add_bench, add_study,
          add_report, add_export, add_margins, add_planners, add_manual, add_completion}) {
        add(program, action);
    }
    reject_unknown_command(program, std::span(argv, static_cast<std::size_t>(argc)).subspan(argc > 0 ? 1 : 0));
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& end) {  // help and version too
        return program.exit(end) == 0 ? checked_output(ExitCode::done) : ExitCode::bad_input;
    }
    return checked_output(action());
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
