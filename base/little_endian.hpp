#pragma once

#include <concepts>
#include <cstddef>
#include <string>

namespace downwash {

/// Puts the bytes of a number behind others, the lowest first, on every machine.
template <std::unsigned_integral Word>
void append_little_endian(std::string& bytes, Word word) {
    for (std::size_t i = 0; i < sizeof(Word); ++i) {
        bytes.push_back(static_cast<char>((word >> (8 * i)) & 0xFFU));
    }
}

}  // namespace downwash
