#pragma once

#include <string>

#include "downwash/base/export.hpp"

namespace downwash {

/// A text as a cell of comma-separated text: with commas, quotation marks or ends of lines, it stands in quotation
/// marks (RFC 4180).
[[nodiscard]] DOWNWASH_EXPORT std::string csv_cell(const std::string& text);

}  // namespace downwash
