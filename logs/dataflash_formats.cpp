#include "downwash/logs/dataflash_formats.hpp"

#include <algorithm>

#include "downwash/base/text.hpp"

namespace downwash::logs {
namespace {

/// A letter of a FMT's format (ArduPilot, libraries/AP_Logger/LogStructure.h).
struct Letter {
    char letter;
    NumberType type;
    std::size_t bytes;
    double scale;
    bool is_number;
};
constexpr std::array letters{
    Letter{'a', NumberType::i16, 64, 1, false},  Letter{'b', NumberType::i8, 1, 1, true},
    Letter{'B', NumberType::u8, 1, 1, true},     Letter{'h', NumberType::i16, 2, 1, true},
    Letter{'H', NumberType::u16, 2, 1, true},    Letter{'i', NumberType::i32, 4, 1, true},
    Letter{'I', NumberType::u32, 4, 1, true},    Letter{'f', NumberType::f32, 4, 1, true},
    Letter{'d', NumberType::f64, 8, 1, true},    Letter{'n', NumberType::u8, 4, 1, false},
    Letter{'N', NumberType::u8, 16, 1, false},   Letter{'Z', NumberType::u8, 64, 1, false},
    Letter{'c', NumberType::i16, 2, 0.01, true}, Letter{'C', NumberType::u16, 2, 0.01, true},
    Letter{'e', NumberType::i32, 4, 0.01, true}, Letter{'E', NumberType::u32, 4, 0.01, true},
    Letter{'L', NumberType::i32, 4, 1e-7, true}, Letter{'M', NumberType::u8, 1, 1, true},
    Letter{'q', NumberType::i64, 8, 1, true},    Letter{'Q', NumberType::u64, 8, 1, true},
};

/// A text of fixed size, up to its first zero.
std::string_view text_in(std::string_view bytes) {
    return bytes.substr(0, bytes.find('\0'));
}

}  // namespace

const DataFlashField* DataFlashFormat::find(std::string_view field) const {
    const auto found = std::ranges::find(fields, field, &DataFlashField::name);
    return found == fields.end() ? nullptr : &*found;
}

DataFlashDefinition read_definition(std::string_view message) {
    DataFlashDefinition definition;
    definition.type = static_cast<unsigned char>(message[3]);
    DataFlashFormat& format = definition.format;
    format.bytes = static_cast<unsigned char>(message[4]);
    format.name = text_in(message.substr(5, 4));
    const std::string_view types = text_in(message.substr(9, 16));
    std::string_view labels = text_in(message.substr(25, 64));
    std::size_t at = dataflash_head_bytes;
    for (const char each : types) {
        const auto letter = std::ranges::find(letters, each, &Letter::letter);
        if (letter == letters.end()) {
            definition.error = "the format of " + excerpt(format.name) + " is '" + excerpt(types) + "', where '" +
                               excerpt(std::string_view(&each, 1)) + "' is no type";
            return definition;
        }
        const std::size_t end = std::min(labels.find(','), labels.size());
        format.fields.push_back(
            {std::string(labels.substr(0, end)), letter->type, letter->scale, at, letter->is_number});
        labels.remove_prefix(std::min(end + 1, labels.size()));
        at += letter->bytes;
    }
    if (at != format.bytes) {
        definition.error = "messages of " + excerpt(format.name) + " are said to have " + std::to_string(format.bytes) +
                           " bytes, but the format '" + excerpt(types) + "' has " + std::to_string(at);
    } else if (!labels.empty()) {
        definition.error = "the format of " + excerpt(format.name) + " has more labels than types";
    }
    return definition;
}

}  // namespace downwash::logs
