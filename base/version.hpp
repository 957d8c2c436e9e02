#pragma once

#include <string_view>

#include "downwash/base/export.hpp"

namespace downwash {

/// The version of this library and program, for example "0.1.0"; what CMakeLists.txt of the whole project says.
[[nodiscard]] DOWNWASH_EXPORT std::string_view version();

}  // namespace downwash
