#pragma once

#include <cstdint>
#include <string_view>

namespace downwash::mavlink {

/// CRC-16/MCRF4XX, which MAVLink calls X.25: polynomial 0x1021, bits reversed, no final exclusive or.
/// @param before checksum of the bytes before these
[[nodiscard]] constexpr std::uint16_t checksum(std::string_view bytes, std::uint16_t before = 0xffff) noexcept {
    constexpr unsigned reversed_polynomial = 0x8408;
    constexpr int bits = 8;
    unsigned sum = before;
    for (const char byte : bytes) {
        sum ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < bits; ++bit) {
            sum = (sum >> 1U) ^ ((sum & 1U) != 0 ? reversed_polynomial : 0U);
        }
    }
    return static_cast<std::uint16_t>(sum);
}

}  // namespace downwash::mavlink
