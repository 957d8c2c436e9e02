#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <string>

namespace downwash {

/// Appends the bytes of a number to others, the lowest first, on every machine.
template <class Number>
void append_little_endian(std::string& bytes, Number number) {
    auto own = std::bit_cast<std::array<char, sizeof(Number)>>(number);
    if (std::endian::native == std::endian::big) {
        std::reverse(own.begin(), own.end());
    }
    bytes.append(own.data(), own.size());
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
