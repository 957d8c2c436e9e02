#include "downwash/problems/value_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <type_traits>

#include "downwash/base/text.hpp"
#include "downwash/problems/number_text.hpp"

namespace downwash::problems {
namespace {

[[noreturn]] void refuse(const ParameterInfo& info, const YamlNode& node) {
    throw YamlError(node.mark, found_text(node) + ": expected " + expectation(info));
}

bool is_not_finite(std::string_view text) {
    constexpr std::array<std::string_view, 5> words{"inf", ".inf", "nan", ".nan", "infinity"};
    std::string word(text.substr(text.starts_with('-') || text.starts_with('+') ? 1 : 0));
    std::transform(word.begin(), word.end(), word.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return std::find(words.begin(), words.end(), word) != words.end();
}

/// The text of something that is not quoted, as numbers and flags have to be.
const std::string& bare_text(const ParameterInfo& info, const YamlNode& node) {
    if (node.kind != YamlNode::Kind::scalar) {
        refuse(info, node);
    }
    if (node.is_quoted) {
        throw YamlError(node.mark, "is text in quotes, \"" + excerpt(node.text) + "\": expected " + expectation(info));
    }
    return node.text;
}

double read_number(const ParameterInfo& info, const YamlNode& node) {
    const std::string& text = bare_text(info, node);
    const auto number = is_in_degrees(info.path) ? parse_degrees(text) : parse_number<double>(text);
    if (number) {
        return *number;
    }
    if (is_not_finite(text)) {
        throw YamlError(node.mark, "is not finite: expected " + expectation(info));
    }
    if (const std::size_t comma = text.find(','); comma != std::string::npos) {
        std::string with_point = text;
        with_point[comma] = '.';
        if (parse_number<double>(with_point)) {
            throw YamlError(node.mark, found_text(node) + ": expected " + expectation(info) +
                                           "; numbers have a decimal point: " + with_point);
        }
    }
    refuse(info, node);
}

std::uint64_t read_integer(const ParameterInfo& info, const YamlNode& node) {
    const auto number = parse_number<std::uint64_t>(bare_text(info, node));
    if (!number) {
        refuse(info, node);
    }
    return *number;
}

bool read_flag(const ParameterInfo& info, const YamlNode& node) {
    const std::string& text = bare_text(info, node);
    if (text != "true" && text != "false") {
        refuse(info, node);
    }
    return text == "true";
}

const std::string& read_text(const ParameterInfo& info, const YamlNode& node) {
    if (node.kind != YamlNode::Kind::scalar) {
        refuse(info, node);
    }
    return node.text;
}

/// The elements of a list, each read by `read_element`.
template <class Read>
auto read_elements(const ParameterInfo& info, const YamlNode& node, const Read& read_element) {
    if (node.kind != YamlNode::Kind::list) {
        refuse(info, node);
    }
    std::vector<std::remove_cvref_t<decltype(read_element(info, node))>> elements;
    for (const YamlNode::Pointer& item : node.items) {
        elements.push_back(read_element(info, *item));
    }
    return elements;
}

std::vector<double> read_numbers(const ParameterInfo& info, const YamlNode& node, std::size_t count) {
    if (node.kind == YamlNode::Kind::list && node.items.size() != count) {
        throw YamlError(node.mark, "has " + std::to_string(node.items.size()) +
                                       (node.items.size() == 1 ? " element" : " elements") + ": expected " +
                                       expectation(info));
    }
    return read_elements(info, node, read_number);
}

std::vector<Vector3> read_points(const ParameterInfo& info, const YamlNode& node) {
    if (node.kind != YamlNode::Kind::list) {
        refuse(info, node);
    }
    std::vector<Vector3> points;
    for (const YamlNode::Pointer& item : node.items) {
        const std::vector<double> numbers = read_numbers(info, *item, 3);
        points.push_back({numbers[0], numbers[1], numbers[2]});
    }
    return points;
}

bool is_list_of_lists(const YamlNode& node) {
    return node.kind == YamlNode::Kind::list && !node.items.empty() && node.items.front()->kind == YamlNode::Kind::list;
}

std::vector<Vector3> read_matrix(const ParameterInfo& info, const YamlNode& node) {
    std::vector<Vector3> rows = read_points(info, node);
    if (rows.size() != 3) {
        throw YamlError(node.mark, "has " + std::to_string(rows.size()) + " rows: expected " + expectation(info));
    }
    return rows;
}

/// "{mean: m, sd: s}", in either order; empty if the node is something else.
std::optional<Spread> read_normal(const ParameterInfo& info, const YamlNode& node) {
    if (node.kind != YamlNode::Kind::map || node.entries.size() != 2) {
        return std::nullopt;
    }
    std::optional<double> mean, sd;
    for (const auto& [key, given] : node.entries) {
        if (key->kind != YamlNode::Kind::scalar || (key->text != "mean" && key->text != "sd")) {
            return std::nullopt;
        }
        (key->text == "mean" ? mean : sd) = read_number(info, *given);
    }
    return mean && sd ? std::optional(Spread::of_sd(*sd, *mean)) : std::nullopt;
}

Spread read_spread(const ParameterInfo& info, const YamlNode& node) {
    if (node.kind == YamlNode::Kind::scalar && !node.is_quoted && parse_number<double>(node.text) == 0.0) {
        return {};
    }
    if (const auto normal = read_normal(info, node)) {
        return *normal;
    }
    if (node.kind != YamlNode::Kind::map || node.entries.size() != 1 ||
        node.entries[0].first->kind != YamlNode::Kind::scalar) {
        refuse(info, node);
    }
    const auto& [key, given] = node.entries[0];
    if (std::find(info.elements.begin(), info.elements.end(), key->text) == info.elements.end()) {
        throw YamlError(key->mark, "has the unknown form '" + excerpt(key->text) + "': expected " + expectation(info));
    }
    if (key->text == "sd") {
        return Spread::of_sd(read_number(info, *given));
    }
    if (given->kind != YamlNode::Kind::list || given->items.size() != 2) {
        refuse(info, *given);
    }
    if (key->text == "factor") {
        ParameterInfo without_unit = info;
        without_unit.path = "factor";
        return Spread::of_factor(read_number(without_unit, *given->items[0]),
                                 read_number(without_unit, *given->items[1]));
    }
    return Spread::over(read_number(info, *given->items[0]), read_number(info, *given->items[1]));
}

Value read_typed(const ParameterInfo& info, const YamlNode& node) {
    if (info.nullable && node.kind == YamlNode::Kind::null) {
        return {};
    }
    switch (info.kind) {
        case ParameterKind::number:
            return read_number(info, node);
        case ParameterKind::integer:
            return read_integer(info, node);
        case ParameterKind::flag:
            return read_flag(info, node);
        case ParameterKind::text:
        case ParameterKind::identifier:
        case ParameterKind::choice:
        case ParameterKind::file:
            return read_text(info, node);
        case ParameterKind::numbers:
            if (info.can_be_single && node.kind == YamlNode::Kind::scalar) {
                return std::vector{read_number(info, node)};
            }
            if (info.can_be_matrix && is_list_of_lists(node)) {
                return read_matrix(info, node);
            }
            return info.elements.empty() ? read_elements(info, node, read_number)
                                         : read_numbers(info, node, info.elements.size());
        case ParameterKind::points:
            return read_points(info, node);
        case ParameterKind::samples:
            return read_elements(info, node, read_number);
        case ParameterKind::choices:
        case ParameterKind::files:
            return read_elements(info, node, read_text);
        case ParameterKind::spread:
            return read_spread(info, node);
        case ParameterKind::group:
            if (info.can_be_integers) {
                return read_elements(info, node, read_integer);
            }
            break;
        case ParameterKind::list:
            break;
    }
    refuse(info, node);
}

}  // namespace

std::string found_text(const YamlNode& node) {
    switch (node.kind) {
        case YamlNode::Kind::null:
            return "has no value";
        case YamlNode::Kind::list:
            return "is a list";
        case YamlNode::Kind::map:
            return "is a group of keys";
        case YamlNode::Kind::scalar:
            break;
    }
    return "is '" + excerpt(node.text) + "'";
}

Value read_value(const ParameterInfo& info, const YamlNode& node) {
    Value value = read_typed(info, node);
    if (const auto error = value_error(info, value)) {
        throw YamlError(node.mark, *error);
    }
    return value;
}

}  // namespace downwash::problems
