#include <fmt/core.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/base/version.hpp"
#include "downwash/cli/commands.hpp"
#include "downwash/cli/standard_error.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash::cli {
namespace {

constexpr char about[] = "Motion planning for aerial manipulators that know their own downwash";
constexpr char exit_codes[] =
    "Exit codes: 0 done; 1 no solution within the limits; 2 bad input or usage; 3 a plan exists and its flight "
    "failed;\n"
    "130 after SIGINT, 143 after SIGTERM, with the best solution so far written; a second signal ends at once.";

/// Reads the command line. Help and version are printed and answered like errors of usage: by an exit code.
std::optional<ExitCode> parse(CLI::App& program, int argc, char** argv) {
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& end) {
        return program.exit(end) == 0 ? ExitCode::done : ExitCode::bad_input;
    }
    return std::nullopt;
}

/// What is wrong with a command line, and where help is.
std::string usage_error(const CLI::App* program, const CLI::Error& error) {
    std::string command = program->get_name();
    for (auto given = program->get_subcommands(); !given.empty(); given = given.front()->get_subcommands()) {
        command += " " + given.front()->get_name();
    }
    return fmt::format("{}: {}\nSee {} --help.\n", program->get_name(), error.what(), command);
}

/// CLI11 would only say that a command is missing.
/// @param words what follows the command's name
void refuse_unknown_command(const CLI::App& command, std::span<char* const> words) {
    const std::vector<const CLI::App*> known = command.get_subcommands([](const CLI::App*) { return true; });
    if (words.empty() || known.empty() || std::string_view(words[0]).starts_with("-")) {
        return;
    }
    const std::string_view word = words[0];
    std::vector<std::string_view> names;
    for (const CLI::App* one : known) {
        names.push_back(one->get_name());
        if (names.back() == word) {
            refuse_unknown_command(*one, words.subspan(1));
            return;
        }
    }
    throw UsageError(fmt::format("there is no command '{}{}': expected {}{}",
                                 command.get_parent() != nullptr ? command.get_name() + " " : "", excerpt(word),
                                 joined_names(names), did_you_mean(word, names)));
}

/// Results that did not reach standard output are no results.
ExitCode checked_output(ExitCode code) {
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
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
    add_init(program, action);
    add_check(program, action);
    add_explain(program, action);
    add_solve(program, action);
    add_execute(program, action);
    add_aeromap(program, action);
    add_bench(program, action);
    add_report(program, action);
    add_export(program, action);
    add_planners(program, action);
    add_manual(program, action);
    refuse_unknown_command(program, std::span(argv, static_cast<std::size_t>(argc)).subspan(argc > 0 ? 1 : 0));
    if (const auto code = parse(program, argc, argv)) {
        return *code;
    }
    return checked_output(action());
}

/// Says what is wrong, each line of it as this program's.
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
    // A reader that goes away shows as a failed write, not as a sudden end.
    std::signal(SIGPIPE, SIG_IGN);
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
            "memory ran out: ask for less, by a larger aero.grid_m or --step, smaller bounds, a smaller --width, fewer "
            "obstacles or a search that ends sooner");
    } catch (const std::exception& error) {
        downwash::cli::print_errors(error.what());
    }
    return static_cast<int>(code);
}
