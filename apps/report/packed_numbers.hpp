#pragma once

// Private: not installed.

#include <span>
#include <string>
#include <vector>

#include "downwash/base/byte_order.hpp"

namespace downwash {

/// Numbers in the form that a page contains: one list after the other, little-endian, deflated (zlib), then base64.
class PackedNumbers {
 public:
    template <class Number>
    void add(const std::vector<Number>& list) {
        for (const Number number : list) {
            append_little_endian(bytes_, number);
        }
    }
    /// Lossless, for smooth lists: the exclusive or of neighbours compresses well, byte by byte from lowest to highest.
    void add_smooth(std::span<const double> list);
    [[nodiscard]] std::string text() const;

 private:
    std::string bytes_;
};

}  // namespace downwash
