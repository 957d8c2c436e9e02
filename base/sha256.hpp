#pragma once

#include <string>
#include <string_view>

#include "downwash/base/export.hpp"

namespace downwash {

/// The SHA-256 digest of some bytes as 64 lower-case hexadecimal digits (FIPS 180-4).
[[nodiscard]] DOWNWASH_EXPORT std::string sha256_hex(std::string_view bytes);

}  // namespace downwash
