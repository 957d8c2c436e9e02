#pragma once

#include <string>
#include <string_view>

#include "downwash/base/export.hpp"

namespace downwash {

/// What to do about a text that is nearly a number: "; write its minus sign as -". Empty if it is not nearly one.
/// @param decimal_sign `.` or `,`
[[nodiscard]] DOWNWASH_EXPORT std::string number_remedy(std::string_view text, char decimal_sign = '.');

}  // namespace downwash
