#pragma once

#include <filesystem>
#include <span>

#include "downwash/cli/command_line.hpp"

namespace downwash::cli {

/// What an action throws that the program of an optional component has to do, with the same words.
struct LeftToPart {};

/// Reads a command line, does what it asks for, prints errors. A given command without an action, or one that
/// throws LeftToPart, is left to the program of an optional component, which stands beside this one: `downwash bench`
/// executes downwash-bench.
/// @param words the name of the program, then its arguments   @return the exit code
[[nodiscard]] int run_program(std::span<char*> words, void (*add_commands)(Command program, Action& action));

/// Runs the program of an optional component: `downwash-bench run` does what `downwash bench run` does.
/// @param name of the command that stands before its arguments: "bench"
[[nodiscard]] int run_part(const char* name, int argc, char** argv,
                           void (*add_commands)(Command program, Action& action));

/// The folder that holds this program.
[[nodiscard]] std::filesystem::path program_folder();

}  // namespace downwash::cli
