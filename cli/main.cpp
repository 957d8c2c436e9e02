#include <fmt/core.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <exception>
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

/// Reads the command line. Help and version are printed and answered like faults of usage: by an exit code.
std::optional<ExitCode> parse(CLI::App& program, int argc, char** argv) {
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& end) {
        return program.exit(end) == 0 ? ExitCode::done : ExitCode::bad_input;
    }
    return std::nullopt;
}

/// What is wrong with a command line, and where help is.
std::string usage_fault(const CLI::App* program, const CLI::Error& error) {
    std::string command = program->get_name();
    for (auto given = program->get_subcommands(); !given.empty(); given = given.front()->get_subcommands()) {
        command += " " + given.front()->get_name();
    }
    return fmt::format("{}: {}\nSee {} --help.\n", program->get_name(), error.what(), command);
}

/// CLI11 would only say that a command is missing.
void refuse_unknown_command(const CLI::App& program, std::string_view word) {
    std::vector<std::string> names;
    for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
        names.push_back(command->get_name());
    }
    if (word.starts_with("-") || std::find(names.begin(), names.end(), word) != names.end()) {
        return;
    }
    const std::vector<std::string_view> views(names.begin(), names.end());
    throw UsageError(
        fmt::format("there is no command '{}': expected {}{}", word, joined_names(views), did_you_mean(word, views)));
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
    program.failure_message(usage_fault);
    Action action;
    add_check(program, action);
    add_solve(program, action);
    add_execute(program, action);
    add_aeromap(program, action);
    add_planners(program, action);
    if (argc > 1) {
        refuse_unknown_command(program, argv[1]);
    }
    if (const auto code = parse(program, argc, argv)) {
        return *code;
    }
    return checked_output(action());
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
    } catch (const std::exception& error) {
        downwash::cli::print_error(fmt::format("downwash: {}\n", error.what()));
    }
    return static_cast<int>(code);
}
