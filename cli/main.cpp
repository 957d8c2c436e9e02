#include <fmt/core.h>

#include <csignal>
#include <exception>

#include "downwash/base/fault.hpp"
#include "downwash/base/version.hpp"
#include "downwash/cli/commands.hpp"
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
    program.failure_message([](const CLI::App* app, const CLI::Error& error) {
        return fmt::format("downwash: {}\nSee {} --help.\n", error.what(), app->get_name());
    });
    Action action;
    add_check(program, action);
    add_solve(program, action);
    add_execute(program, action);
    add_aeromap(program, action);
    add_planners(program, action);
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
        fmt::print(stderr, "{}\n", error.what());
    } catch (const std::exception& error) {
        fmt::print(stderr, "downwash: {}\n", error.what());
    }
    return static_cast<int>(code);
}
