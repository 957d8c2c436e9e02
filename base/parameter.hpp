#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/spread.hpp"
#include "downwash/base/vector3.hpp"

namespace downwash {

/// What a parameter can hold, in SI units and radians. Empty (monostate) stands for `null`.
using Value = std::variant<std::monostate, bool, double, std::uint64_t, std::string, std::vector<double>,
                           std::vector<Vector3>, std::vector<std::uint64_t>, std::vector<std::string>, Spread>;

/// The kind of value that a key of a problem file has.
enum class ParameterKind {
    group,       ///< further keys
    list,        ///< a list of groups; the table has their keys below "path[]"
    number,      ///< a finite number
    integer,     ///< a whole number, not negative
    flag,        ///< true or false
    text,        ///< any text
    identifier,  ///< text that may become part of a path: [A-Za-z0-9_-]{1,64}
    choice,      ///< one of `names`
    numbers,     ///< a list of as many numbers as `elements`; of any number, or none, without them
    points,      ///< a list of [x, y, z]
    file,        ///< path of a file whose content belongs to the model, relative to the file that names it
    samples,     ///< a list of any number of numbers
    choices,     ///< a list of some of `names`
    files,       ///< a list of paths, relative to the file that names them
    spread,      ///< 0, or how far a number may be from its nominal value: {sd: s}, {range: [a, b]}
};

/// The allowed values, in the unit of the file (degrees if the key says so). Empty: no limit.
struct Range {
    std::optional<double> low, high;
    bool excludes_low = false;
    bool excludes_high = false;
};

/// The description of a parameter without access to its value: --help, documentation and schemas come from it.
struct ParameterInfo {
    std::string path;  ///< "start.x_m" or "environment.obstacles[].name"
    ParameterKind kind = ParameterKind::group;
    std::string description;
    bool required = false;
    bool nullable = false;         ///< `null` is allowed: the value is not set
    bool exclusive = false;        ///< exactly one of the exclusive keys of a group must be there
    bool can_be_none = false;      ///< a group that `none` switches off
    bool can_be_file = false;      ///< a group that may be the path of a file instead
    bool can_be_list = false;      ///< a group that may be a list of such groups, their keys below "path[]"
    bool can_be_group = false;     ///< a choice that may be a group of keys instead
    bool can_be_integers = false;  ///< a group that may be a list of whole numbers instead
    bool can_be_single = false;    ///< numbers of any count that may be one number, for all of them
    bool can_be_matrix = false;    ///< three numbers that may be the rows of a 3 x 3 matrix instead, as points
    Range range;
    std::vector<std::string_view> names;     ///< the names of a choice, or of choices
    std::vector<std::string_view> elements;  ///< the names of numbers, for example {"x", "z"}; the forms of a spread
    std::string condition;                   ///< says in words when the parameter applies; empty: always
    std::string_view default_of;             ///< group of keys that may say what the default is; empty: nothing may
    std::string_view former_name;            ///< last name of the path in earlier versions, still read
};

/// Last part of a key path: "x_m" of "start.x_m".
[[nodiscard]] DOWNWASH_EXPORT std::string_view last_name(std::string_view path);

/// Key path of the group that holds a parameter: "start" of "start.x_m", "" at the top.
[[nodiscard]] DOWNWASH_EXPORT std::string_view parent_path(std::string_view path);

/// Unit that the last name of a key path ends in, for example "m/s" of "vx_m_s"; empty when it has none.
[[nodiscard]] DOWNWASH_EXPORT std::string_view unit_of(std::string_view path);

/// Whether a name is `stem` and a unit behind it ("mass_g" of the stem "mass").
[[nodiscard]] DOWNWASH_EXPORT bool is_stem_with_unit(std::string_view name, std::string_view stem);

/// The name without its unit: "mass" of "mass_kg".
[[nodiscard]] DOWNWASH_EXPORT std::string_view without_unit(std::string_view name);

/// Whether the file holds degrees where the code holds radians.
[[nodiscard]] DOWNWASH_EXPORT bool is_in_degrees(std::string_view path);

/// The expected value in words: "a number in m, above 0" or "one of mp-arm, mp-arm-da or mp-arm-ada".
[[nodiscard]] DOWNWASH_EXPORT std::string expectation(const ParameterInfo& info);

/// What is wrong with a value of the right type: not finite, out of range, not one of the names. Empty if it is valid.
[[nodiscard]] DOWNWASH_EXPORT std::optional<std::string> value_error(const ParameterInfo& info, const Value& value);

/// The choice that a misspelt name most likely stands for, as a remedy: "; did you mean 'energy'?". May be empty.
[[nodiscard]] DOWNWASH_EXPORT std::string did_you_mean(std::string_view word,
                                                       const std::vector<std::string_view>& names);

/// The index of a list's element for the parameters below it. A list may stand in an element of another list, whose
/// index is then kept in the upper half.
/// @param around index of the element that the list stands in; 0 where it stands in none
[[nodiscard]] constexpr std::size_t element_index(std::size_t around, std::size_t i) noexcept {
    return around << 32U | i;
}
/// The element itself, and the one around it.
[[nodiscard]] constexpr std::size_t inner_element(std::size_t index) noexcept {
    return index & 0xffffffffU;
}
[[nodiscard]] constexpr std::size_t outer_element(std::size_t index) noexcept {
    return index >> 32U;
}

/// A parameter with access to where it lives in a Model. The index is that of the list element that it belongs to.
template <class Model>
struct Parameter : ParameterInfo {
    std::function<Value(const Model&, std::size_t)> get;  ///< empty function for groups and lists
    /// @pre the value is of the parameter's kind  @throws InputError when a file cannot be used
    std::function<void(Model&, std::size_t, const Value&)> set;
    std::function<std::size_t(const Model&, std::size_t)> count;   ///< elements of a list; 1 or 0 for a group
    std::function<void(Model&, std::size_t, std::size_t)> resize;  ///< the third is the new count
    std::function<bool(const Model&, std::size_t)> applies;        ///< empty function: always
    std::function<std::string(const Model&, std::size_t)> digest;  ///< SHA-256 of what was read from a file

    /// Allows values greater than `low`.
    Parameter above(double low) && { return range.low = low, range.excludes_low = true, std::move(*this); }
    /// Allows `low` and greater values.
    Parameter at_least(double low) && { return range.low = low, std::move(*this); }
    /// Allows values less than `high`.
    Parameter below(double high) && { return range.high = high, range.excludes_high = true, std::move(*this); }
    /// Allows `high` and lesser values.
    Parameter at_most(double high) && { return range.high = high, std::move(*this); }
    /// Allows values from `low` to `high`, both included.
    Parameter between(double low, double high) && { return range.low = low, range.high = high, std::move(*this); }
    /// Every file must contain the key.
    Parameter is_required() && { return required = true, std::move(*this); }
    /// See ParameterInfo::former_name.
    Parameter formerly(std::string_view name) && { return former_name = name, std::move(*this); }
    /// See ParameterInfo::exclusive.
    Parameter is_exclusive() && { return exclusive = true, std::move(*this); }
    /// See ParameterInfo::can_be_none.
    Parameter or_none() && { return can_be_none = true, std::move(*this); }
    /// See ParameterInfo::can_be_file.
    Parameter or_file() && { return can_be_file = true, std::move(*this); }
    /// See ParameterInfo::can_be_single.
    Parameter or_single() && { return can_be_single = true, std::move(*this); }
    /// See ParameterInfo::can_be_matrix.
    Parameter or_matrix() && { return can_be_matrix = true, std::move(*this); }
    /// @param is_group whether it has the form of a group now   @param begin gives it that form
    Parameter or_group(std::function<bool(const Model&)> is_group, std::function<void(Model&)> begin) && {
        can_be_group = true;
        count = [is_group = std::move(is_group)](const Model& model, std::size_t) -> std::size_t {
            return is_group(model) ? 1 : 0;
        };
        resize = [begin = std::move(begin)](Model& model, std::size_t, std::size_t) { begin(model); };
        return std::move(*this);
    }
    /// The parameter applies only if a test of the model is true. `when` says so in words: see
    /// ParameterInfo::condition.
    Parameter only(std::string_view when, std::function<bool(const Model&, std::size_t)> test) && {
        return condition = when, applies = std::move(test), std::move(*this);
    }

    /// Whether a model has a list of groups here now.
    [[nodiscard]] bool has_list(const Model& model, std::size_t index) const {
        return kind == ParameterKind::list || (can_be_list && count(model, index) > 1);
    }
    /// Whether a model has one value here now, not keys below.
    [[nodiscard]] bool has_value(const Model& model, std::size_t index) const {
        return get && !(can_be_group && count(model, index) > 0);
    }
};

}  // namespace downwash
