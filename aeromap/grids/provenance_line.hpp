#pragma once

// Private to grids.

#include <string>
#include <string_view>
#include <utility>

namespace downwash {

/// "key: value" for an entry of a provenance.
[[nodiscard]] std::string provenance_line(std::string_view key, std::string_view value);

/// The entry of such a line; what has no key is a "comment".
[[nodiscard]] std::pair<std::string, std::string> provenance_entry(std::string_view line);

}  // namespace downwash
