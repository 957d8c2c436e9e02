#pragma once

#include "downwash/base/parameter.hpp"
#include "downwash/problems/yaml_node.hpp"

namespace downwash::problems {

/// The value that is written for a parameter, angles in radians.
/// @throws YamlError when it has the wrong type or is out of range; the message continues the parameter's name: "is a
///     list: expected ..."
[[nodiscard]] Value read_value(const ParameterInfo& info, const YamlNode& node);

/// What stands there, for people: "is a list", "is 'abc'".
[[nodiscard]] std::string found_text(const YamlNode& node);

}  // namespace downwash::problems
