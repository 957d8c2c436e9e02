#pragma once

// Private: not installed.

#include <chrono>
#include <string>
#include <string_view>

#include "downwash/base/export.hpp"

namespace downwash {

/// Runs gnuplot with a script on its standard input and no settings of the user, and gives what it writes on its
/// standard output. No shell is involved. The script is trusted: text of others goes into it through in_quotes() only.
/// @throws PictureError when gnuplot is not installed, fails, or takes longer than `limit`
[[nodiscard]] DOWNWASH_EXPORT std::string run_gnuplot(std::string_view script,
                                                      std::chrono::milliseconds limit = std::chrono::minutes(2));

}  // namespace downwash
