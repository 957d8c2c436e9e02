#include "downwash/cli/cache_folder.hpp"

#include <cstdlib>

namespace downwash::cli {
namespace {

/// The absolute path in an environment variable; empty without one.
std::filesystem::path path_in(const char* variable) {
    const char* text = std::getenv(variable);
    std::filesystem::path path = text == nullptr ? "" : text;
    return path.is_absolute() ? path : std::filesystem::path();
}

}  // namespace

std::filesystem::path cache_folder() {
    const std::filesystem::path cache = path_in("XDG_CACHE_HOME");
    if (!cache.empty()) {
        return cache / "downwash";
    }
    const std::filesystem::path home = path_in("HOME");
    return home.empty() ? std::filesystem::path() : home / ".cache" / "downwash";
}

}  // namespace downwash::cli
