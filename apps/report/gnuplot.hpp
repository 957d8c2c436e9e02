#pragma once

// Private: not installed.

#include <chrono>
#include <string>
#include <string_view>

#include "downwash/base/export.hpp"

namespace downwash {

/// Runs gnuplot without the settings of the user, with a script on its standard input, and returns its standard output.
/// No shell is involved. The script is trusted: foreign text must pass through in_quotes().
/// @throws PictureError when gnuplot is not installed, fails, or takes longer than `limit`
[[nodiscard]] DOWNWASH_EXPORT std::string run_gnuplot(std::string_view script,
                                                      std::chrono::milliseconds limit = std::chrono::minutes(2));

}  // namespace downwash
