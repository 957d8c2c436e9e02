#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <string>

namespace downwash {

/// Appends the bytes of a number to others, the lowest first, on every machine.
template <std::unsigned_integral Word>
void append_little_endian(std::string& bytes, Word word) {
    for (std::size_t i = 0; i < sizeof(Word); ++i) {
        bytes.push_back(static_cast<char>((word >> (8 * i)) & 0xFFU));
    }
}

/// The number that begins at `bytes`, in the byte order given.
template <class Number>
[[nodiscard]] Number number_at(const char* bytes, bool is_big_endian = false) {
    std::array<char, sizeof(Number)> own;
    std::copy_n(bytes, own.size(), own.begin());
    if (is_big_endian != (std::endian::native == std::endian::big)) {
        std::reverse(own.begin(), own.end());
    }
    return std::bit_cast<Number>(own);
}

}  // namespace downwash
