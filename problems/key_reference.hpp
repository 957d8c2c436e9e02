#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/parameter.hpp"

namespace downwash {

/// The kinds of YAML files that are read.
enum class FileKind { problem, robot, campaign, space_problem, space_robot };

/// Their names, in that order.
inline constexpr std::array<std::string_view, 5> file_kind_names{"problem", "robot", "campaign", "space-problem",
                                                                 "space-robot"};

/// The kind of that name, one of file_kind_names; empty for any other name.
[[nodiscard]] DOWNWASH_EXPORT std::optional<FileKind> file_kind_named(std::string_view name);

/// A key of a file with what it holds when nobody writes it.
struct KeyReference {
    ParameterInfo info;
    /// In the units of the file (degrees); empty for groups and lists, and where a file has to say.
    std::optional<Value> default_value;
    std::string default_text;  ///< For people; "required" or "one of its group" where a file has to say.
};

/// Why no file has a key of that name, as it is one of a motion out of the plane ("y_m", "yaw_deg"); empty for others.
[[nodiscard]] DOWNWASH_EXPORT std::string_view out_of_plane_remark(std::string_view name);

/// Every key of a kind of file, in the order in which they are documented, a group before what is in it.
[[nodiscard]] DOWNWASH_EXPORT const std::vector<KeyReference>& key_reference(FileKind kind);

/// A JSON Schema (draft 7) by which editors complete and check a kind of file. It knows types, ranges, names and what
/// is required; what depends on other values only `downwash check` knows.
[[nodiscard]] DOWNWASH_EXPORT std::string json_schema(FileKind kind);

}  // namespace downwash
