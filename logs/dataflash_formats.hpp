#pragma once

// Private to logs/.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/logs/ulog_formats.hpp"

namespace downwash::logs {

/// A field of a DataFlash message.
struct DataFlashField {
    std::string name;
    NumberType type = NumberType::u8;
    double scale = 1;    ///< what its number is to be multiplied by
    std::size_t at = 0;  ///< byte, from the head of the message
    bool is_number = true;
};

/// A message of a DataFlash log as its FMT defines it.
struct DataFlashFormat {
    std::string name;
    std::size_t bytes = 0;  ///< of a message with its head
    std::vector<DataFlashField> fields;

    [[nodiscard]] const DataFlashField* find(std::string_view field) const;
};

inline constexpr std::size_t dataflash_head_bytes = 3;
inline constexpr unsigned dataflash_format_type = 128;
inline constexpr std::size_t dataflash_format_bytes = 89;

/// What a FMT message says.
struct DataFlashDefinition {
    unsigned type = 0;
    DataFlashFormat format;
    std::string error;  ///< why it is none; empty: it is one
};

/// Reads a FMT message. @param message dataflash_format_bytes of them, with the head
[[nodiscard]] DataFlashDefinition read_definition(std::string_view message);

}  // namespace downwash::logs
