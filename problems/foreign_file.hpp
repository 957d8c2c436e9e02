#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace downwash::problems {

/// What to say of a file of another program that stands where a file of keys and values should: a URDF, a mesh, a
/// table. Empty where it is none that is known.
[[nodiscard]] std::string foreign_file_text(const std::filesystem::path& file, std::string_view text);

}  // namespace downwash::problems
