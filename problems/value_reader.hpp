#pragma once

#include "downwash/base/parameter.hpp"
#include "downwash/problems/yaml_document.hpp"

namespace downwash::problems {

/// The value that is written for a parameter, angles in radians. A choice is one of its names.
/// @throws YamlError where the type is wrong; the message continues the parameter's name: "is text: expected ..."
[[nodiscard]] Value read_value(const ParameterInfo& info, const YamlNode& node);

/// What stands there, for people: "is a list", "is 'abc'".
[[nodiscard]] std::string found_text(const YamlNode& node);

/// Text as it may stand in a message: short, on one line.
[[nodiscard]] std::string excerpt(std::string_view text);

}  // namespace downwash::problems
