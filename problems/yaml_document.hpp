#pragma once

// Private to problems/: only yaml_document.cpp knows the parser.

#include <string>

#include "downwash/problems/yaml_node.hpp"

namespace downwash::problems {

/// Deeper nesting is refused.
inline constexpr int deepest_nesting = 32;

/// Reads exactly one document. Lines may end with LF, CR LF or CR.
/// @throws YamlError for anything else, binary data, invalid UTF-8, tabs in indentation, tags, self-referring aliases
[[nodiscard]] YamlNode::Pointer parse_yaml(const std::string& bytes);

}  // namespace downwash::problems
