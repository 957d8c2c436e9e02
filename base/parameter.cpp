#include "downwash/base/parameter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <type_traits>
#include <utility>

#include "downwash/base/text.hpp"

namespace downwash {
namespace {

/// Units as keys end in them and as people read them; a longer suffix stands before its own tail.
constexpr std::array<std::pair<std::string_view, std::string_view>, 25> our_units{{
    {"_kg_m2", "kg m2"},
    {"_w_n1p5", "W/N^1.5"},
    {"_over_radius", "rotor radii"},
    {"_radii", "rotor radii"},
    {"_n_s2_m2", "N s2/m2"},
    {"_n_s_m", "N s/m"},
    {"_nm_s", "Nm s"},
    {"_n_s2", "N s2"},
    {"_rad_s", "rad/s"},
    {"_deg_s2", "deg/s2"},
    {"_rad_s2", "rad/s2"},
    {"_deg_s", "deg/s"},
    {"_m_s2", "m/s2"},
    {"_m_s", "m/s"},
    {"_deg", "deg"},
    {"_kg", "kg"},
    {"_nm", "Nm"},
    {"_hz", "Hz"},
    {"_m", "m"},
    {"_j", "J"},
    {"_n", "N"},
    {"_1_s", "1/s"},
    {"_s", "s"},
    {"_ratio", ""},
    {"_factor", ""},
}};

/// Units that people write by mistake.
constexpr std::array<std::string_view, 32> other_units{
    "g",   "mm",  "cm",     "km",   "in",   "ft",  "lb",     "rad", "rad_s2", "ms",      "us",
    "min", "h",   "kmh",    "km_h", "mph",  "kn",  "knots",  "khz", "rpm",    "degrees", "rads",
    "mnm", "n_m", "newton", "g_m2", "kgm2", "nms", "meters", "s2",  "w",      "deg2"};

std::string_view suffix_of(std::string_view name) {
    for (const auto& [suffix, unit] : our_units) {
        if (!unit.empty() && name.size() > suffix.size() && name.ends_with(suffix)) {
            return suffix;
        }
    }
    return {};
}

bool is_identifier(std::string_view text) {
    return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
}

std::string range_text(const Range& range) {
    if (range.low && range.high && !range.excludes_low && !range.excludes_high) {
        return "from " + to_text(*range.low) + " to " + to_text(*range.high);
    }
    std::string text;
    if (range.low) {
        text += (range.excludes_low ? "above " : "at least ") + to_text(*range.low);
    }
    if (range.high) {
        text += text.empty() ? "" : " and ";
        text += (range.excludes_high ? "below " : "at most ") + to_text(*range.high);
    }
    return text;
}

bool is_within(const Range& range, double value) {
    const bool is_low = range.low && (range.excludes_low ? value <= *range.low : value < *range.low);
    const bool is_high = range.high && (range.excludes_high ? value >= *range.high : value > *range.high);
    return !is_low && !is_high;
}

std::string elements_text(const std::vector<std::string_view>& elements) {
    std::string text = "[";
    for (const std::string_view element : elements) {
        text += (text.size() > 1 ? ", " : "") + std::string(element);
    }
    return text + "]";
}

/// "{sd: number} or {range: [low, high]}".
std::string forms_text(const std::vector<std::string_view>& forms) {
    std::string text;
    for (const std::string_view form : forms) {
        text += (text.empty() ? "" : " or ") +
                (form == "sd" ? std::string("{sd: number}") : "{" + std::string(form) + ": [low, high]}");
    }
    return text;
}

std::optional<std::string> number_error(const ParameterInfo& info, double value) {
    const double written =
        is_in_degrees(info.path)
            ? static_cast<double>(static_cast<long double>(value) * 180 / std::numbers::pi_v<long double>)
            : value;
    if (!std::isfinite(value)) {
        return "is not finite: expected " + expectation(info);
    }
    if (!is_within(info.range, written)) {
        return "is " + to_text(written, 12) + ": expected " + expectation(info);
    }
    return std::nullopt;
}

std::optional<std::string> text_error(const ParameterInfo& info, const std::string& text) {
    if (info.kind == ParameterKind::identifier && !is_identifier(text)) {
        return "is '" + excerpt(text) + "': expected " + expectation(info);
    }
    if (info.kind == ParameterKind::choice &&
        std::find(info.names.begin(), info.names.end(), text) == info.names.end()) {
        return "is '" + excerpt(text) + "': expected " + expectation(info) + did_you_mean(text, info.names);
    }
    return std::nullopt;
}

/// A list of which every element stands for itself, so that none is superfluous.
template <class Element>
std::optional<std::string> set_error(const ParameterInfo& info, const std::vector<Element>& elements) {
    if (elements.empty()) {
        return "is empty: expected " + expectation(info);
    }
    std::set<Element> seen;
    for (const Element& element : elements) {
        if (!seen.insert(element).second) {
            if constexpr (std::is_same_v<Element, std::string>) {
                return "has '" + excerpt(element) + "' twice: expected " + expectation(info);
            } else {
                return "has " + to_text(static_cast<double>(element)) + " twice: expected " + expectation(info);
            }
        }
    }
    return std::nullopt;
}

std::optional<std::string> texts_error(const ParameterInfo& info, const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
        if (info.kind == ParameterKind::choices &&
            std::find(info.names.begin(), info.names.end(), text) == info.names.end()) {
            return "has '" + excerpt(text) + "': expected " + expectation(info) + did_you_mean(text, info.names);
        }
    }
    return set_error(info, texts);
}

/// The ends of a spread have to be within the range of the parameter, factors above 0.
std::optional<std::string> spread_error(const ParameterInfo& info, const Spread& spread) {
    const auto form = spread.form == Spread::Form::sd ? "sd" : spread.form == Spread::Form::range ? "range" : "factor";
    if (spread.form == Spread::Form::exact) {
        return std::nullopt;
    }
    if (std::find(info.elements.begin(), info.elements.end(), form) == info.elements.end()) {
        return std::string("is a ") + form + ": expected " + expectation(info);
    }
    if (!std::isfinite(spread.low) || !std::isfinite(spread.high)) {
        return "is not finite: expected " + expectation(info);
    }
    if (spread.form == Spread::Form::sd && spread.high < 0) {
        return "has a negative sd: expected a standard deviation of at least 0";
    }
    if (spread.form != Spread::Form::sd && spread.low > spread.high) {
        return std::string("has a ") + form + " upside down: expected [low, high]";
    }
    if (spread.form == Spread::Form::factor) {
        return spread.low > 0 && spread.high <= 10
                   ? std::nullopt
                   : std::optional<std::string>("has factors beyond their range: expected above 0 and at most 10");
    }
    if (spread.form == Spread::Form::range) {
        const auto error = number_error(info, spread.low);
        return error ? error : number_error(info, spread.high);
    }
    if (spread.low != 0 && std::find(info.elements.begin(), info.elements.end(), "range") == info.elements.end()) {
        return "has a mean, though only its sd has a meaning: expected " + expectation(info);
    }
    for (const double end : {spread.low - 3 * spread.high, spread.low + 3 * spread.high}) {
        if (info.range.low.value_or(0) < 0 && number_error(info, end)) {
            return "has an sd so large that 3 of it leave the range: expected " + expectation(info);
        }
    }
    return info.range.high && number_error(info, spread.high) ? number_error(info, spread.high) : std::nullopt;
}

template <class Numbers>
std::optional<std::string> first_error(const ParameterInfo& info, const Numbers& numbers) {
    for (const auto number : numbers) {
        if (auto error = number_error(info, static_cast<double>(number))) {
            return error;
        }
    }
    return std::nullopt;
}

/// The range is that of what stands on the diagonal.
std::optional<std::string> matrix_error(const ParameterInfo& info, const std::vector<Vector3>& rows) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!is_finite(rows[i])) {
            return "is not finite: expected " + expectation(info);
        }
        if (auto error = number_error(info, rows[i][i])) {
            return error;
        }
    }
    return std::nullopt;
}

}  // namespace

std::string_view last_name(std::string_view path) {
    return path.substr(path.rfind('.') + 1);  // npos + 1 is 0
}

std::string_view parent_path(std::string_view path) {
    const std::size_t dot = path.rfind('.');
    return dot == std::string_view::npos ? std::string_view{} : path.substr(0, dot);
}

std::string_view unit_of(std::string_view path) {
    const std::string_view suffix = suffix_of(last_name(path));
    for (const auto& [known, unit] : our_units) {
        if (known == suffix) {
            return unit;
        }
    }
    return {};
}

std::string_view without_unit(std::string_view name) {
    return name.substr(0, name.size() - suffix_of(name).size());
}

bool is_stem_with_unit(std::string_view name, std::string_view stem) {
    if (!name.starts_with(stem) || name.size() <= stem.size() + 1 || name[stem.size()] != '_') {
        return false;
    }
    const std::string_view suffix = name.substr(stem.size());
    return std::any_of(our_units.begin(), our_units.end(), [&](const auto& known) { return known.first == suffix; }) ||
           std::find(other_units.begin(), other_units.end(), suffix.substr(1)) != other_units.end();
}

bool is_in_degrees(std::string_view path) {
    return unit_of(path).starts_with("deg");
}

std::string expectation(const ParameterInfo& info) {
    const std::string unit(unit_of(info.path));
    const std::string in_unit = unit.empty() ? "" : " in " + unit;
    const std::string range = range_text(info.range).empty() ? "" : " " + range_text(info.range);
    const std::string or_null = info.nullable ? ", or null" : "";
    switch (info.kind) {
        case ParameterKind::group:
            return std::string("a group of keys") + (info.can_be_none ? " or none" : "") +
                   (info.can_be_file ? " or the path of a file" : "") + (info.can_be_list ? " or a list of them" : "") +
                   (info.can_be_integers ? " or a list of whole numbers" + range : "");
        case ParameterKind::list:
            return "a list";
        case ParameterKind::number:
            return "a number" + in_unit + range + or_null;
        case ParameterKind::integer:
            return "a whole number" + in_unit + range + or_null;
        case ParameterKind::flag:
            return "true or false";
        case ParameterKind::text:
            return "text";
        case ParameterKind::identifier:
            return "1 to 64 letters, digits, '_' or '-'";
        case ParameterKind::choice:
            return (info.names.size() > 1 ? "one of " : "") + joined_names(info.names) +
                   (info.can_be_group ? ", or a group of keys" : "");
        case ParameterKind::numbers:
            return (info.elements.empty()
                        ? std::string(info.can_be_single ? "one number for all or a list of them" : "a list of numbers")
                        : elements_text(info.elements)) +
                   (info.can_be_matrix ? " or the rows of a 3 x 3 matrix" : "") + in_unit + range + or_null;
        case ParameterKind::points:
            return "a list of [x, y, z]" + in_unit + range;
        case ParameterKind::file:
            return "the path of a file";
        case ParameterKind::samples:
            return "a list of different numbers" + in_unit + range + or_null;
        case ParameterKind::choices:
            return "a list of " + joined_names(info.names) + or_null;
        case ParameterKind::files:
            return "a list of paths of files";
        case ParameterKind::spread:
            return "0 or " + forms_text(info.elements) + in_unit + range;
    }
    return "";
}

std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& names) {
    const std::string_view nearest = nearest_name(word, names);
    return nearest.empty() ? "" : "; did you mean '" + std::string(nearest) + "'?";
}

std::optional<std::string> value_error(const ParameterInfo& info, const Value& value) {
    if (const auto* number = std::get_if<double>(&value)) {
        return number_error(info, *number);
    }
    if (const auto* number = std::get_if<std::uint64_t>(&value)) {
        return number_error(info, static_cast<double>(*number));
    }
    if (const auto* text = std::get_if<std::string>(&value)) {
        return text_error(info, *text);
    }
    if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
        const auto error = info.kind == ParameterKind::samples ? set_error(info, *numbers) : std::nullopt;
        return error ? error : first_error(info, *numbers);
    }
    if (const auto* integers = std::get_if<std::vector<std::uint64_t>>(&value)) {
        const auto error = set_error(info, *integers);
        return error ? error : first_error(info, *integers);
    }
    if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) {
        return texts_error(info, *texts);
    }
    if (const auto* spread = std::get_if<Spread>(&value)) {
        return spread_error(info, *spread);
    }
    if (const auto* points = std::get_if<std::vector<Vector3>>(&value)) {
        if (info.can_be_matrix) {
            return matrix_error(info, *points);
        }
        for (const Vector3& point : *points) {
            if (auto error = first_error(info, point)) {
                return error;
            }
        }
    }
    return std::nullopt;
}

}  // namespace downwash
