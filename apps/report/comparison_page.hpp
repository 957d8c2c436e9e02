#pragma once

#include <string>

#include "downwash/base/export.hpp"

namespace downwash {

/// A flight log beside the plan that was flown as one self-contained HTML file: figures, tracking by phase, places,
/// clearance and thrust over time.
/// @param comparison JSON of the schema `downwash/comparison-report/v1`
/// @pre has_pages()
[[nodiscard]] DOWNWASH_EXPORT std::string comparison_page(const std::string& comparison);

}  // namespace downwash
