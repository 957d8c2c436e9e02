#pragma once

#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "downwash/base/export.hpp"

namespace downwash {

/// The SHA-256 digest of some bytes as 64 lower-case hexadecimal digits (FIPS 180-4).
[[nodiscard]] DOWNWASH_EXPORT std::string sha256_hex(std::string_view bytes);

/// The digest of numbers as they lie in memory, which is the same on all little-endian machines.
/// @tparam Numbers plain numbers, or arrays of them without bytes in between
template <class Numbers>
[[nodiscard]] std::string sha256_hex_of(std::span<const Numbers> numbers) {
    static_assert(std::is_trivially_copyable_v<Numbers>);
    return sha256_hex({reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()});
}

}  // namespace downwash
