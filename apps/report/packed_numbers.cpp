#include "downwash/report/packed_numbers.hpp"

#include <zlib.h>

#include <bit>
#include <cstdint>
#include <new>

#include "downwash/base/base64.hpp"

namespace downwash {

void PackedNumbers::add_smooth(std::span<const double> list) {
    for (std::size_t byte = 0; byte < sizeof(double); ++byte) {
        std::uint64_t before = 0;
        for (const double number : list) {
            const auto bits = std::bit_cast<std::uint64_t>(number);
            bytes_.push_back(static_cast<char>(((bits ^ before) >> (8 * byte)) & 0xFFU));
            before = bits;
        }
    }
}

std::string PackedNumbers::text() const {
    uLongf size = compressBound(static_cast<uLong>(bytes_.size()));
    std::string packed(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes_.data()),
                  static_cast<uLong>(bytes_.size()), Z_BEST_COMPRESSION) != Z_OK) {
        throw std::bad_alloc();  // the only error left when the buffer is large enough
    }
    packed.resize(size);
    return base64_text(packed);
}

}  // namespace downwash
