#pragma once

#include <cstddef>
#include <string_view>

#include "downwash/base/export.hpp"

namespace downwash::problems {

/// Line and column, counted from 1 in bytes.
struct TextPlace {
    int line = 1;
    int column = 1;
};

/// The place of a byte of a text.
[[nodiscard]] DOWNWASH_EXPORT TextPlace place_of_byte(std::string_view text, std::size_t byte);

/// The place of the value with a key path ("plan.reference[3].t_s"; "" is the whole) in a text that is valid JSON;
/// of the last value before the text's end when there is none.
[[nodiscard]] DOWNWASH_EXPORT TextPlace json_place(std::string_view text, std::string_view key_path);

}  // namespace downwash::problems
