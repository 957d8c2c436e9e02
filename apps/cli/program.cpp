#include "downwash/cli/program.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
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

/// A program that has commands of an optional component, and the Debian packages that it needs beside those of
/// downwash; empty: none.
struct Part {
    std::string_view name, packages;
};

constexpr std::array parts{
    Part{"aeromap", "libceres-dev"},
    Part{"bench", "libsqlite3-dev"},
    Part{"compare", ""},
    Part{"export", "libgeographiclib-dev"},
    Part{"identify", "libceres-dev"},
    Part{"robot", "liburdfdom-dev, libsdformat-dev, libmujoco-dev and libpugixml-dev"},
    Part{"study", "libsqlite3-dev"},
    Part{"validate", ""},
};

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

/// As much of a description as fits on a line.
std::string beginning_of(const std::string& description) {
    constexpr std::size_t longest = 88;
    const std::string first = description.substr(0, description.find(';'));
    return first.size() <= longest ? first : first.substr(0, first.rfind(' ', longest)) + " ...";
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
        std::string list;
        for (const Command& one : known) {
            list += fmt::format("\n  {:<11} {}", one.name(), beginning_of(one.description()));
        }
        throw UsageError("{}a command is missing, expected one of{}\nSee {} --help.",
                         command.is_program() ? "" : command.full_name() + ": ", list, command.full_name());
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

/// Results that do not reach standard output are an error, unless its reader went away.
ExitCode checked_output(ExitCode code) {
    errno = 0;
    const bool has_failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
    if (has_failed && errno != EPIPE) {
        throw UsageError("standard output cannot be written");
    }
    return code;
}

/// Executes the program of an optional component: downwash-bench for `bench`. @throws UsageError if it is not there
[[noreturn]] void execute_part(std::span<char*> words) {
    const std::string name = words[1];
    const auto part = std::find_if(parts.begin(), parts.end(), [&](const Part& one) { return one.name == name; });
    if (part == parts.end()) {
        throw std::logic_error("the command " + name + " does nothing");
    }
    const std::filesystem::path program = program_folder() / ("downwash-" + name);
    std::vector<char*> passed(words.begin() + 1, words.end());
    passed.push_back(nullptr);
    execv(program.c_str(), passed.data());
    if (errno != ENOENT) {
        throw UsageError("{} cannot be executed: {}", program.string(), std::strerror(errno));
    }
    throw UsageError(
        "this command is in the program downwash-{}, which is not in {}: `./dev build` builds it, as does `cmake "
        "--build`{}",
        name, program.parent_path().string(),
        part->packages.empty() ? "" : " with " + std::string(part->packages) + " installed");
}

ExitCode run(std::span<char*> words, void (*add_commands)(Command program, Action& action)) {
    CommandLine line(about, "downwash " + std::string(version()), exit_codes);
    Action action;
    add_commands(line.program(), action);
    reject_unknown_command(line.program(), words.subspan(words.empty() ? 0 : 1));
    const std::optional<ExitCode> end = line.parse(static_cast<int>(words.size()), words.data());
    if (end == ExitCode::bad_input) {
        return *end;
    }
    if (!end && !action) {
        execute_part(words);
    }
    try {
        return checked_output(end ? *end : action());
    } catch (const LeftToPart&) {
        execute_part(words);
    }
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

int run_program(std::span<char*> words, void (*add_commands)(Command program, Action& action)) {
    // A closed pipe shows as a failed write instead of ending the program.
    std::signal(SIGPIPE, SIG_IGN);
    // So does a file that may not grow any more (ulimit -f).
    std::signal(SIGXFSZ, SIG_IGN);
    ExitCode code = ExitCode::bad_input;
    try {
        code = run(words, add_commands);
    } catch (const ProblemFileError& error) {
        print_error(fmt::format("{}\n", error.what()));
    } catch (const std::logic_error& error) {
        print_error(fmt::format("downwash: this is a bug in downwash, please report it: {}\n", error.what()));
        std::abort();
    } catch (const std::bad_alloc&) {
        print_errors(
            "out of memory: choose a larger aero.grid_m or --step, smaller bounds, a smaller --width, fewer obstacles "
            "or a shorter search");
    } catch (const std::system_error& error) {
        if (error.code() == std::errc::broken_pipe) {  // who reads standard output has seen enough
            return static_cast<int>(ExitCode::done);
        }
        print_errors(error.what());
    } catch (const std::exception& error) {
        print_errors(error.what());
    }
    return static_cast<int>(code);
}

int run_part(const char* name, int argc, char** argv, void (*add_commands)(Command program, Action& action)) {
    std::string command = name;
    std::vector<char*> words(argv, argv + argc);
    words.insert(words.begin() + std::min(argc, 1), command.data());
    return run_program(words, add_commands);
}

std::filesystem::path program_folder() {
    return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

}  // namespace downwash::cli
