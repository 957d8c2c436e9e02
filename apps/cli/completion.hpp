#pragma once

#include <string>

#include "downwash/cli/command_line.hpp"

namespace downwash::cli {

/// A script that completes the program's command line in a shell: "bash", "zsh" or "fish".
[[nodiscard]] std::string completion_script(const Command& program, const std::string& shell);

}  // namespace downwash::cli
