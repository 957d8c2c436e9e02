#pragma once

#include <filesystem>

namespace downwash::cli {

/// Where the user's aero maps are kept between runs: $XDG_CACHE_HOME/downwash, or $HOME/.cache/downwash without an
/// absolute path in that variable. Empty when there is no home either: nowhere.
[[nodiscard]] std::filesystem::path cache_folder();

}  // namespace downwash::cli
