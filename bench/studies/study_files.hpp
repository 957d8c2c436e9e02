#pragma once

#include <string>
#include <utility>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/studies/study.hpp"

namespace downwash::studies {

/// `{"study": NAME, "findings": [{"name", "thesis", "measured", "reproduced", "note"}]}`
[[nodiscard]] DOWNWASH_EXPORT std::string json_of(const Study& study);

/// Findings and tables as a page for terminals and repositories.
[[nodiscard]] DOWNWASH_EXPORT std::string markdown_of(const Study& study);

/// All files of a study by name: study.json, study.md, study.html (one page with every picture in it), and a file for
/// each figure (SVG) and table (CSV).
/// @throws PictureError when gnuplot cannot draw
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::pair<std::string, std::string>> files_of(const Study& study);

}  // namespace downwash::studies
