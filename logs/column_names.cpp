#include "downwash/logs/column_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <numbers>

#include "downwash/base/text.hpp"

namespace downwash::logs {
namespace {

constexpr double degree_rad = std::numbers::pi / 180, foot_m = 0.3048, standard_gravity_m_s2 = 9.80665;

struct Unit {
    std::string_view in_brackets;
    std::string_view suffix;  ///< empty: none that says it
    Dimension dimension;
    double factor;
};

/// Of suffixes that end alike the longer one comes first.
constexpr std::array units{
    Unit{"cm/s", "_cm_s", Dimension::speed, 0.01},
    Unit{"mm/s", "_mm_s", Dimension::speed, 0.001},
    Unit{"m/s", "_m_s", Dimension::speed, 1},
    Unit{"rad/s", "_rad_s", Dimension::rate, 1},
    Unit{"deg/s", "_deg_s", Dimension::rate, degree_rad},
    Unit{"\u00b0/s", "", Dimension::rate, degree_rad},
    Unit{"m/s2", "_m_s2", Dimension::acceleration, 1},
    Unit{"m/s^2", "", Dimension::acceleration, 1},
    Unit{"m/s\u00b2", "", Dimension::acceleration, 1},
    Unit{"g", "", Dimension::acceleration, standard_gravity_m_s2},
    Unit{"m", "_m", Dimension::length, 1},
    Unit{"cm", "_cm", Dimension::length, 0.01},
    Unit{"mm", "_mm", Dimension::length, 0.001},
    Unit{"ft", "_ft", Dimension::length, foot_m},
    Unit{"rad", "_rad", Dimension::angle, 1},
    Unit{"deg", "_deg", Dimension::angle, degree_rad},
    Unit{"\u00b0", "", Dimension::angle, degree_rad},
    Unit{"n", "_n", Dimension::force, 1},
    Unit{"s", "_s", Dimension::time, 1},
    Unit{"sec", "_sec", Dimension::time, 1},
    Unit{"ms", "_ms", Dimension::time, 1e-3},
    Unit{"us", "_us", Dimension::time, 1e-6},
    Unit{"usec", "_usec", Dimension::time, 1e-6},
    Unit{"\u00b5s", "", Dimension::time, 1e-6},
    Unit{"\u03bcs", "", Dimension::time, 1e-6},
    Unit{"ns", "_ns", Dimension::time, 1e-9},
};

std::string in_lower_case(std::string_view text) {
    std::string lower(text);
    std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return lower;
}

/// The unit in brackets at the end of a name, which it is taken from; nullptr: there is none.
const Unit* take_bracketed(std::string& name) {
    if (name.empty() || (name.back() != ')' && name.back() != ']')) {
        return nullptr;
    }
    const std::size_t open = name.rfind(name.back() == ')' ? '(' : '[');
    if (open == std::string::npos || open == 0) {
        return nullptr;
    }
    const std::string_view inside = trimmed(std::string_view(name).substr(open + 1, name.size() - open - 2));
    const auto unit = std::ranges::find(units, inside, &Unit::in_brackets);
    if (unit == units.end()) {
        return nullptr;
    }
    name = std::string(trimmed(std::string_view(name).substr(0, open)));
    return &*unit;
}

const Unit* take_suffix(std::string& name) {
    const auto unit = std::ranges::find_if(units, [&name](const Unit& each) {
        return !each.suffix.empty() && name.size() > each.suffix.size() && name.ends_with(each.suffix);
    });
    if (unit == units.end()) {
        return nullptr;
    }
    name.resize(name.size() - unit->suffix.size());
    return &*unit;
}

}  // namespace

ColumnName column_name(std::string_view written) {
    ColumnName name{in_lower_case(trimmed(written))};
    const Unit* unit = take_bracketed(name.plain);
    std::ranges::replace_if(
        name.plain, [](char c) { return c == ' ' || c == '-'; }, '_');
    if (unit == nullptr) {
        unit = take_suffix(name.plain);
    }
    if (unit != nullptr) {
        name.dimension = unit->dimension;
        name.factor = unit->factor;
    }
    return name;
}

}  // namespace downwash::logs
