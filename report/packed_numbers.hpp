#pragma once

// Private: not installed.

#include <cstdint>
#include <span>
#include <string>

namespace downwash {

/// Numbers as a page carries them: one list after the other, little-endian, deflated (zlib), then base64.
class PackedNumbers {
 public:
    void add(std::span<const std::uint8_t> list);
    void add(std::span<const float> list);
    void add(std::span<const std::int32_t> list);
    /// To the last bit, though smooth lists shrink well: the exclusive or of neighbours, first the lowest byte of each,
    /// the highest last.
    void add_smooth(std::span<const double> list);

    [[nodiscard]] std::string text() const;

 private:
    std::string bytes_;
};

}  // namespace downwash
