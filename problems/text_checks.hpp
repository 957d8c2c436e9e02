#pragma once

#include <string_view>

namespace downwash::problems {

/// Refuses what a YAML parser should never see.
/// @throws YamlError when the text is too large, holds NUL or other control bytes, invalid UTF-8 or tabs in indentation
void check_text(std::string_view text);

}  // namespace downwash::problems
