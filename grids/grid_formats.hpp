#pragma once

// Private to grids. What the formats of grids share; each is read in a file of its own.

#include <string>
#include <string_view>
#include <utility>

#include "downwash/grids/factor_grid_file.hpp"

namespace downwash {

/// @throws InputError as parse_factor_grid
[[nodiscard]] FactorGrid parse_vti(std::string_view bytes, const std::string& name, const GridReading& reading);
[[nodiscard]] FactorGrid parse_grid_csv(std::string_view bytes, const std::string& name, const GridReading& reading);

/// "key: value" for an entry of a provenance.
[[nodiscard]] std::string provenance_line(std::string_view key, std::string_view value);

/// The entry of such a line; what has no key is a "comment".
[[nodiscard]] std::pair<std::string, std::string> provenance_entry(std::string_view line);

}  // namespace downwash
