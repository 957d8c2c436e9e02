#pragma once

#include <cstdint>
#include <span>

#include "downwash/base/export.hpp"

namespace downwash {

/// Instructions that the flights of a batch are computed with. The results are the same to the last bit.
enum class Instructions : std::uint8_t {
    baseline,  ///< what every processor of the architecture has
    avx2,      ///< x86-64 only
    avx512,    ///< x86-64 only: AVX-512 F
};

/// The instructions that this build and this processor have, the widest last.
[[nodiscard]] DOWNWASH_EXPORT std::span<const Instructions> known_instructions() noexcept;
/// The widest of the known instructions.
[[nodiscard]] inline Instructions best_instructions() noexcept {
    return known_instructions().back();
}

}  // namespace downwash
