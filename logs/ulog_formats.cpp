#include "downwash/logs/ulog_formats.hpp"

#include <algorithm>
#include <array>

#include "downwash/base/byte_order.hpp"
#include "downwash/base/text.hpp"

namespace downwash::logs {
namespace {

constexpr std::size_t max_message_bytes = 65535;
constexpr std::size_t max_formats = 10'000, max_parts = 5'000;
constexpr int max_depth = 8;

struct TypeName {
    std::string_view name;
    NumberType type;
    std::size_t bytes;
};
constexpr std::array types{
    TypeName{"int8_t", NumberType::i8, 1},   TypeName{"uint8_t", NumberType::u8, 1},
    TypeName{"int16_t", NumberType::i16, 2}, TypeName{"uint16_t", NumberType::u16, 2},
    TypeName{"int32_t", NumberType::i32, 4}, TypeName{"uint32_t", NumberType::u32, 4},
    TypeName{"int64_t", NumberType::i64, 8}, TypeName{"uint64_t", NumberType::u64, 8},
    TypeName{"float", NumberType::f32, 4},   TypeName{"double", NumberType::f64, 8},
    TypeName{"bool", NumberType::u8, 1},     TypeName{"char", NumberType::u8, 1},
};

bool is_name(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
               c == '/';
    });
}

}  // namespace

double number_of(NumberType type, const char* bytes) noexcept {
    switch (type) {
        case NumberType::i8:
            return number_at<std::int8_t>(bytes);
        case NumberType::u8:
            return number_at<std::uint8_t>(bytes);
        case NumberType::i16:
            return number_at<std::int16_t>(bytes);
        case NumberType::u16:
            return number_at<std::uint16_t>(bytes);
        case NumberType::i32:
            return number_at<std::int32_t>(bytes);
        case NumberType::u32:
            return number_at<std::uint32_t>(bytes);
        case NumberType::i64:
            return static_cast<double>(number_at<std::int64_t>(bytes));
        case NumberType::u64:
            return static_cast<double>(number_at<std::uint64_t>(bytes));
        case NumberType::f32:
            return static_cast<double>(number_at<float>(bytes));
        case NumberType::f64:
            return number_at<double>(bytes);
    }
    return 0;
}

std::string ULogFormats::add(std::string_view definition) {
    const std::size_t colon = definition.find(':');
    const std::string_view name = definition.substr(0, colon);
    if (colon == std::string_view::npos || !is_name(name)) {
        return "the format '" + excerpt(definition) + "' has no name: expected name:type field;...";
    }
    if (formats_.size() == max_formats) {
        return "more than " + std::to_string(max_formats) + " formats";
    }
    std::vector<Part> parts;
    for (std::string_view rest = definition.substr(colon + 1); !rest.empty();) {
        const std::size_t end = std::min(rest.find(';'), rest.size());
        const std::string_view field = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        const std::size_t blank = field.find(' ');
        std::string_view type = field.substr(0, blank);
        std::size_t count = 1;
        if (const std::size_t bracket = type.find('['); bracket != std::string_view::npos) {
            const std::string_view inside = type.substr(bracket + 1);
            const auto number =
                inside.ends_with(']') ? parse_number<std::uint32_t>(inside.substr(0, inside.size() - 1)) : std::nullopt;
            count = number && *number <= max_message_bytes ? *number : 0;
            type = type.substr(0, bracket);
        }
        if (blank == std::string_view::npos || !is_name(type) || !is_name(field.substr(blank + 1)) || count == 0) {
            return "the format of " + excerpt(name) + " has the field '" + excerpt(field) +
                   "': expected a type, such as float or float[4], and a name";
        }
        if (parts.size() == max_parts) {
            return "the format of " + excerpt(name) + " has more than " + std::to_string(max_parts) + " fields";
        }
        parts.push_back({std::string(type), std::string(field.substr(blank + 1)), count});
    }
    formats_[std::string(name)] = std::move(parts);
    return {};
}

ULogFormats::Layout ULogFormats::layout(std::string_view message) const {
    Layout layout;
    std::size_t parts = 0;
    lay_out(message, "", 0, 0, parts, layout);
    return layout;
}

void ULogFormats::lay_out(std::string_view message, const std::string& prefix, std::size_t at, int depth,
                          std::size_t& parts, Layout& into) const {
    const auto format = formats_.find(message);
    if (format == formats_.end()) {
        into.error = "there is no format of " + excerpt(message);
        return;
    }
    if (depth == max_depth) {
        into.error = "formats are nested deeper than " + std::to_string(max_depth) + " times";
        return;
    }
    const std::size_t begin = at;
    std::size_t end = at;  // without padding
    for (const Part& part : format->second) {
        if (++parts > max_message_bytes) {
            into.error = excerpt(message) + " has more fields than a message can hold";
            return;
        }
        const auto type = std::ranges::find(types, part.type, &TypeName::name);
        std::size_t bytes = 0;
        if (type != types.end()) {
            bytes = type->bytes;
            if (!part.name.starts_with("_padding")) {
                into.fields[prefix + part.name] = {type->type, at, part.count};
            }
        } else {
            Layout inner;
            lay_out(part.type, prefix + part.name + ".", at, depth + 1, parts, inner);
            if (!inner.error.empty()) {
                into.error = inner.error;
                return;
            }
            bytes = inner.bytes;
            into.fields.merge(inner.fields);
        }
        at += bytes * part.count;
        if (at > max_message_bytes) {
            into.error = "a message of " + excerpt(message) + " is longer than a message can be";
            return;
        }
        // Padding behind the last field of a message is not written; within a nested one it is.
        end = part.name.starts_with("_padding") && depth == 0 ? end : at;
    }
    into.bytes = end - begin;
}

}  // namespace downwash::logs
