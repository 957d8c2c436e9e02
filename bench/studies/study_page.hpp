#pragma once

// Private: not installed.

#include <string>
#include <vector>

#include "downwash/studies/study.hpp"

namespace downwash::studies {

/// A study as one HTML file without references to others.
/// @param pictures SVG of each figure, in their order
[[nodiscard]] std::string page_of(const Study& study, const std::vector<std::string>& pictures);

}  // namespace downwash::studies
