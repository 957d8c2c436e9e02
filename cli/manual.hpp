#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace downwash::cli {

/// The manual page of a command, as man(1) reads it; of the program as a whole when the command is the program.
[[nodiscard]] std::string man_page(const CLI::App& command);

/// Every command below the program with its options, as one Markdown page.
[[nodiscard]] std::string markdown_page(const CLI::App& program);

}  // namespace downwash::cli
