#include "downwash/grids/vtk_data.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>

#include "downwash/base/base64.hpp"
#include "downwash/base/byte_order.hpp"
#include "downwash/base/text.hpp"

namespace downwash {
namespace {

static_assert(std::endian::native == std::endian::little || std::endian::native == std::endian::big);

/// zlib cannot shrink anything more than this.
constexpr std::size_t max_ratio = 1040;

template <class Number>
double as_double(const char* bytes, bool is_big_endian) {
    return static_cast<double>(number_at<Number>(bytes, is_big_endian));
}

constexpr std::array number_types{
    VtkNumberType{"Float32", 4, as_double<float>},      VtkNumberType{"Float64", 8, as_double<double>},
    VtkNumberType{"Int8", 1, as_double<std::int8_t>},   VtkNumberType{"UInt8", 1, as_double<std::uint8_t>},
    VtkNumberType{"Int16", 2, as_double<std::int16_t>}, VtkNumberType{"UInt16", 2, as_double<std::uint16_t>},
    VtkNumberType{"Int32", 4, as_double<std::int32_t>}, VtkNumberType{"UInt32", 4, as_double<std::uint32_t>},
    VtkNumberType{"Int64", 8, as_double<std::int64_t>}, VtkNumberType{"UInt64", 8, as_double<std::uint64_t>},
};

/// Takes decoded bytes from the front of the data of an array.
class Source {
 public:
    Source(std::string_view data, bool is_base64) : rest_(data), is_base64_(is_base64) {}

    /// Bytes that are left at most.
    [[nodiscard]] std::size_t size() const noexcept { return is_base64_ ? rest_.size() / 4 * 3 : rest_.size(); }

    [[nodiscard]] std::string_view rest() const noexcept { return rest_; }

    /// The first bytes, which stay.
    [[nodiscard]] std::string peek(std::size_t bytes) const {
        const std::size_t letters = is_base64_ ? base64_letters(bytes) : bytes;
        if (letters > rest_.size()) {
            throw VtkDataError("ends early: expected " + std::to_string(letters) + " bytes, found " +
                               std::to_string(rest_.size()));
        }
        if (!is_base64_) {
            return std::string(rest_.substr(0, bytes));
        }
        auto decoded = base64_bytes(rest_.substr(0, letters));
        if (!decoded || decoded->size() < bytes) {
            throw VtkDataError("is no base64 text of " + std::to_string(bytes) + " bytes");
        }
        decoded->resize(bytes);
        return *std::move(decoded);
    }

    std::string take(std::size_t bytes) {
        std::string taken = peek(bytes);
        rest_.remove_prefix(is_base64_ ? base64_letters(bytes) : bytes);
        return taken;
    }

 private:
    std::string_view rest_;
    bool is_base64_;
};

std::size_t word_at(std::string_view header, std::size_t index, const VtkEncoding& encoding) {
    const char* word = header.data() + index * encoding.header_bytes;
    return encoding.header_bytes == 8 ? number_at<std::uint64_t>(word, encoding.is_big_endian)
                                      : number_at<std::uint32_t>(word, encoding.is_big_endian);
}

void require_size(std::size_t size, std::size_t min, std::size_t max) {
    if (size < min || size > max) {
        const std::string expected = min == max ? std::to_string(max) : "at most " + std::to_string(max);
        throw VtkDataError("declares " + std::to_string(size) + " bytes: expected " + expected +
                           "; is the byte_order or header_type wrong?");
    }
}

/// One count of bytes, then the bytes; base64 runs through both.
std::string plain_bytes(Source& source, const VtkEncoding& encoding, std::size_t min, std::size_t max) {
    const std::size_t size = word_at(source.peek(encoding.header_bytes), 0, encoding);
    require_size(size, min, max);
    return source.take(encoding.header_bytes + size).erase(0, encoding.header_bytes);
}

void inflate_block(std::string_view block, char* to, std::size_t size) {
    uLongf written = size;
    const int code =
        uncompress(reinterpret_cast<Bytef*>(to), &written, reinterpret_cast<const Bytef*>(block.data()), block.size());
    if (code != Z_OK || written != size) {
        throw VtkDataError("holds a block that zlib cannot turn into " + std::to_string(size) + " bytes");
    }
}

/// What stands before compressed data: counts of blocks, of bytes in a block and in a shorter last one (0: there is
/// none), then of the compressed bytes of each block.
struct BlockSizes {
    std::size_t block, last;
    std::vector<std::size_t> compressed;

    [[nodiscard]] std::size_t of(std::size_t index) const {
        return last != 0 && index + 1 == compressed.size() ? last : block;
    }
};

BlockSizes take_block_sizes(Source& source, const VtkEncoding& encoding, std::size_t min, std::size_t max) {
    constexpr std::size_t fixed_words = 3;
    constexpr std::size_t max_block = UINT32_MAX;
    const std::string head = source.peek(fixed_words * encoding.header_bytes);
    const std::size_t count = word_at(head, 0, encoding);
    BlockSizes sizes{word_at(head, 1, encoding), word_at(head, 2, encoding), {}};
    if (count > source.size() / encoding.header_bytes || sizes.block > max_block || sizes.last > sizes.block) {
        throw VtkDataError("declares " + std::to_string(count) + " blocks of " + std::to_string(sizes.block) +
                           " bytes and a last one of " + std::to_string(sizes.last) +
                           "; is the byte_order or header_type wrong?");
    }
    require_size(count * sizes.block - (sizes.last == 0 || count == 0 ? 0 : sizes.block - sizes.last), min, max);
    const std::string words = source.take((fixed_words + count) * encoding.header_bytes);
    for (std::size_t block = 0; block < count; ++block) {
        sizes.compressed.push_back(word_at(words, fixed_words + block, encoding));
    }
    return sizes;
}

/// The sizes, then the blocks, in base64 each for itself.
std::string inflated_bytes(Source& source, const VtkEncoding& encoding, std::size_t min, std::size_t max) {
    const BlockSizes sizes = take_block_sizes(source, encoding, min, max);
    std::size_t size = 0;
    std::size_t compressed_size = 0;
    for (std::size_t block = 0; block < sizes.compressed.size(); ++block) {
        if (sizes.compressed[block] > source.size() - compressed_size) {
            throw VtkDataError("ends early: block " + std::to_string(block + 1) + " of " +
                               std::to_string(sizes.compressed.size()) + " should have " +
                               std::to_string(sizes.compressed[block]) + " bytes");
        }
        compressed_size += sizes.compressed[block];
        size += sizes.of(block);
    }
    if (size / max_ratio > compressed_size) {
        throw VtkDataError("declares " + std::to_string(size) + " bytes out of " + std::to_string(compressed_size) +
                           " compressed ones: more than zlib can");
    }
    const std::string compressed = source.take(compressed_size);
    std::string bytes(size, '\0');
    std::size_t from = 0;
    std::size_t to = 0;
    for (std::size_t block = 0; block < sizes.compressed.size(); ++block) {
        inflate_block(std::string_view(compressed).substr(from, sizes.compressed[block]), bytes.data() + to,
                      sizes.of(block));
        from += sizes.compressed[block];
        to += sizes.of(block);
    }
    return bytes;
}

}  // namespace

const VtkNumberType* find_vtk_number_type(std::string_view name) {
    const auto* found = std::find_if(number_types.begin(), number_types.end(),
                                     [name](const VtkNumberType& type) { return type.name == name; });
    return found == number_types.end() ? nullptr : found;
}

std::string vtk_bytes(std::string_view data, bool is_base64, const VtkEncoding& encoding, std::size_t min,
                      std::size_t max) {
    Source source(data, is_base64);
    std::string bytes =
        encoding.is_compressed ? inflated_bytes(source, encoding, min, max) : plain_bytes(source, encoding, min, max);
    if (!trimmed(source.rest()).empty()) {
        throw VtkDataError("continues for " + std::to_string(source.rest().size()) +
                           " bytes after its end; is the header_type wrong?");
    }
    return bytes;
}

std::vector<double> vtk_ascii_numbers(std::string_view text, std::size_t count) {
    if (text.size() < 2 * count - std::min<std::size_t>(1, count)) {  // a digit and a blank each, the last blank aside
        throw VtkDataError("ends early: expected " + std::to_string(count) + " numbers, found " +
                           std::to_string(text.size()) + " letters");
    }
    std::vector<double> numbers;
    numbers.reserve(count);
    for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) {
        double value = 0;
        const auto [parsed, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || parsed != word.data() + word.size()) {
            throw VtkDataError("number " + std::to_string(numbers.size() + 1) + " is '" + excerpt(word) +
                               "': expected a number");
        }
        if (numbers.size() == count) {
            throw VtkDataError("holds more than " + std::to_string(count) + " numbers");
        }
        numbers.push_back(value);
    }
    if (numbers.size() != count) {
        throw VtkDataError("holds " + std::to_string(numbers.size()) + " numbers: expected " + std::to_string(count));
    }
    return numbers;
}

std::vector<double> vtk_numbers(std::string_view bytes, const VtkNumberType& type, bool is_big_endian) {
    std::vector<double> numbers(bytes.size() / type.bytes);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        numbers[i] = type.read(bytes.data() + i * type.bytes, is_big_endian);
    }
    return numbers;
}

}  // namespace downwash
