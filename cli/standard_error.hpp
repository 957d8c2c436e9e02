#pragma once

#include <string_view>

namespace downwash::cli {

/// Writes text to standard error. Where that cannot be written nothing is said, and the exit code still tells.
void print_error(std::string_view text) noexcept;

}  // namespace downwash::cli
