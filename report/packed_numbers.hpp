#pragma once

// Private: not installed.

#include <cstdint>
#include <span>
#include <string>

namespace downwash {

/// Numbers in the form that a page contains: one list after the other, little-endian, deflated (zlib), then base64.
class PackedNumbers {
 public:
    void add(std::span<const std::uint8_t> list);
    void add(std::span<const float> list);
    void add(std::span<const std::int32_t> list);
    /// Lossless, for smooth lists: the exclusive or of neighbours compresses well, byte by byte from lowest to highest.
    void add_smooth(std::span<const double> list);

    [[nodiscard]] std::string text() const;

 private:
    std::string bytes_;
};

}  // namespace downwash
