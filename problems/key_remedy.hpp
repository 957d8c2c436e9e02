#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace downwash::problems {

/// What to write instead of a key that does not exist.
struct KeyRemedy {
    std::string text;                     ///< text for people
    std::vector<std::string_view> meant;  ///< the valid keys that it most likely stands for; may be empty
};

/// Looks for a missing unit ("mass" for mass_kg), a wrong one ("mass_g") and then for a misspelling.
[[nodiscard]] KeyRemedy remedy_for_key(std::string_view key, const std::vector<std::string_view>& valid);

}  // namespace downwash::problems
