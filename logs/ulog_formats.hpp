#pragma once

// Private to logs/.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace downwash::logs {

/// Types of numbers in binary logs.
enum class NumberType : std::uint8_t { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

/// The number of a type that begins at some little-endian bytes.
[[nodiscard]] double number_of(NumberType type, const char* bytes) noexcept;

/// Where the numbers of a field are in a message.
struct ULogField {
    NumberType type = NumberType::u8;
    std::size_t at = 0;     ///< byte of the first, from the beginning of the message
    std::size_t count = 1;  ///< of an array
};

/// The formats that a ULog defines: "vehicle_attitude:uint64_t timestamp;float[4] q;".
class ULogFormats {
 public:
    /// Adds a definition. @return what is wrong with it; empty: nothing
    [[nodiscard]] std::string add(std::string_view definition);
    [[nodiscard]] bool knows(std::string_view message) const { return formats_.contains(message); }

    /// The fields of a message, by their names; those of nested messages as "outer.inner", and only the first of an
    /// array of these. Bytes without a type of number are no fields.
    struct Layout {
        std::map<std::string, ULogField, std::less<>> fields;
        std::size_t bytes = 0;  ///< of a whole message, without padding behind its last field
        std::string error;      ///< why there is none; empty: there is one
    };
    [[nodiscard]] Layout layout(std::string_view message) const;

 private:
    struct Part {
        std::string type, name;
        std::size_t count;
    };
    /// @param[in,out] parts how many fields were laid out; a format that nests others may ask for any number
    void lay_out(std::string_view message, const std::string& prefix, std::size_t at, int depth, std::size_t& parts,
                 Layout& into) const;

    std::map<std::string, std::vector<Part>, std::less<>> formats_;
};

}  // namespace downwash::logs
