#pragma once

// How the rows of a parameter table are written. A member is named by a pointer to it (&Robot::name), by in() and
// in_each(), or by a generic lambda that returns a reference to it, [](auto& model, std::size_t i) -> auto&.

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <type_traits>
#include <utility>
#include <vector>

#include "downwash/base/parameter.hpp"

namespace downwash::parameters {

/// The member of a model that a pointer or a lambda names.
template <class Model, class Member>
decltype(auto) at(const Member& member, Model& model, std::size_t index) {
    if constexpr (std::is_invocable_v<const Member&, Model&, std::size_t>) {
        return member(model, index);
    } else {
        return std::invoke(member, model);
    }
}

/// Names a member of a part: in(&Robot::arm, &ArmParameters::length_m). What names the part may itself be in(),
/// in_each() or a lambda.
template <class Part, class Member>
auto in(Part part, Member member) {
    return [ part, member ](auto& model, std::size_t i) -> auto& {
        return std::invoke(member, at(part, model, i));
    };
}

/// Names a member of a list's element: in_each(&Campaign::expect, &CampaignExpectation::variant).
template <class List, class Member>
auto in_each(List list, Member member) {
    return [ list, member ](auto& model, std::size_t i) -> auto& {
        return std::invoke(member, at(list, model, i)[i]);
    };
}

/// Adds rows to a table.
template <class Model>
void append(std::vector<Parameter<Model>>& rows, std::initializer_list<Parameter<Model>> more) {
    rows.insert(rows.end(), more);
}

/// The type of a member that a pointer or a lambda names.
template <class Model, class Member>
using MemberType = std::remove_cvref_t<decltype(at(std::declval<const Member&>(), std::declval<Model&>(), 0))>;

/// Whether a member may hold nothing: `null` in a file.
template <class T>
struct IsOptional : std::false_type {};
/// One that may.
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {
    /// What it holds otherwise.
    using Inner = T;
};

/// A row that says what stands where, without access to it.
template <class Model>
Parameter<Model> row(ParameterKind kind, std::string_view path, std::string_view description) {
    Parameter<Model> parameter;
    parameter.path = path;
    parameter.kind = kind;
    parameter.description = description;
    return parameter;
}

/// A value that lives in one member; Stored is how a Value holds it.
template <class Model, class Stored, class Member>
Parameter<Model> member_row(ParameterKind kind, std::string_view path, std::string_view description, Member member) {
    using Type = MemberType<Model, Member>;
    auto parameter = row<Model>(kind, path, description);
    if constexpr (IsOptional<Type>::value) {
        parameter.nullable = true;
        parameter.get = [member](const Model& model, std::size_t i) {
            const auto& held = at(member, model, i);
            return held ? Value(static_cast<Stored>(*held)) : Value();
        };
        parameter.set = [member](Model& model, std::size_t i, const Value& value) {
            auto& held = at(member, model, i);
            held.reset();
            if (const auto* given = std::get_if<Stored>(&value)) {
                held = static_cast<typename IsOptional<Type>::Inner>(*given);
            }
        };
    } else {
        parameter.get = [member](const Model& model, std::size_t i) {
            return Value(static_cast<Stored>(at(member, model, i)));
        };
        parameter.set = [member](Model& model, std::size_t i, const Value& value) {
            at(member, model, i) = static_cast<Type>(std::get<Stored>(value));
        };
    }
    return parameter;
}

/// A finite number; the member is a double or an optional one.
template <class Model, class Member>
Parameter<Model> number(std::string_view path, std::string_view description, Member member) {
    return member_row<Model, double>(ParameterKind::number, path, description, member);
}
/// A whole number that is not negative; the member is of an integer type or an optional one.
template <class Model, class Member>
Parameter<Model> integer(std::string_view path, std::string_view description, Member member) {
    return member_row<Model, std::uint64_t>(ParameterKind::integer, path, description, member);
}
/// True or false.
template <class Model, class Member>
Parameter<Model> flag(std::string_view path, std::string_view description, Member member) {
    return member_row<Model, bool>(ParameterKind::flag, path, description, member);
}
/// Any text.
template <class Model, class Member>
Parameter<Model> text(std::string_view path, std::string_view description, Member member) {
    return member_row<Model, std::string>(ParameterKind::text, path, description, member);
}
/// Text that may become part of a path.
template <class Model, class Member>
Parameter<Model> identifier(std::string_view path, std::string_view description, Member member) {
    return member_row<Model, std::string>(ParameterKind::identifier, path, description, member);
}
/// A list of points of three coordinates.
template <class Model, class Member>
Parameter<Model> points(std::string_view path, std::string_view description, Member member) {
    return member_row<Model, std::vector<Vector3>>(ParameterKind::points, path, description, member);
}

/// A text out of a list.
template <class Model, class Member>
Parameter<Model> choice(std::string_view path, std::string_view description, const std::vector<std::string_view>& names,
                        Member member) {
    auto parameter = member_row<Model, std::string>(ParameterKind::choice, path, description, member);
    parameter.names = names;
    return parameter;
}

/// A list of texts out of a list.
template <class Model, class Member>
Parameter<Model> choices(std::string_view path, std::string_view description,
                         const std::vector<std::string_view>& names, Member member) {
    auto parameter = member_row<Model, std::vector<std::string>>(ParameterKind::choices, path, description, member);
    parameter.names = names;
    return parameter;
}

/// The values of an enumeration with what name_of() calls them.
template <class Values>
auto named(const Values& values) {
    std::vector<std::pair<typename Values::value_type, std::string_view>> named;
    named.reserve(std::size(values));
    for (const auto value : values) {
        named.emplace_back(value, name_of(value));
    }
    return named;
}

/// A list of enumerations whose values have names; the vector may be optional.
template <class Model, class Enumeration, class Member>
Parameter<Model> choices(std::string_view path, std::string_view description,
                         std::vector<std::pair<Enumeration, std::string_view>> named, Member member) {
    using Type = MemberType<Model, Member>;
    auto parameter = row<Model>(ParameterKind::choices, path, description);
    parameter.nullable = IsOptional<Type>::value;
    for (const auto& entry : named) {
        parameter.names.push_back(entry.second);
    }
    parameter.get = [member, named](const Model& model, std::size_t i) {
        const auto names_of = [&](const std::vector<Enumeration>& values) {
            std::vector<std::string> names;
            for (const Enumeration value : values) {
                const auto found =
                    std::find_if(named.begin(), named.end(), [&](const auto& e) { return e.first == value; });
                names.emplace_back(found == named.end() ? std::string_view() : found->second);
            }
            return names;
        };
        if constexpr (IsOptional<Type>::value) {
            const auto& held = at(member, model, i);
            return held ? Value(names_of(*held)) : Value();
        } else {
            return Value(names_of(at(member, model, i)));
        }
    };
    parameter.set = [member, named](Model& model, std::size_t i, const Value& value) {
        Type& held = at(member, model, i);
        held = Type();
        if (const auto* given = std::get_if<std::vector<std::string>>(&value)) {
            std::vector<Enumeration> values;
            for (const std::string& name : *given) {
                const auto found =
                    std::find_if(named.begin(), named.end(), [&](const auto& e) { return e.second == name; });
                if (found != named.end()) {
                    values.push_back(found->first);
                }
            }
            held = std::move(values);
        }
    };
    return parameter;
}

/// A list of any number of numbers.
template <class Model, class Member>
Parameter<Model> samples(std::string_view path, std::string_view description, Member member) {
    return member_row<Model, std::vector<double>>(ParameterKind::samples, path, description, member);
}

/// A Spread.
/// @param forms in which it can be written: sd, range, factor
template <class Model, class Member>
Parameter<Model> spread(std::string_view path, std::string_view description, const std::vector<std::string_view>& forms,
                        Member member) {
    auto parameter = member_row<Model, Spread>(ParameterKind::spread, path, description, member);
    parameter.elements = forms;
    return parameter;
}

/// A list of paths of files.
template <class Model, class Member>
Parameter<Model> files(std::string_view path, std::string_view description, Member member) {
    return member_row<Model, std::vector<std::string>>(ParameterKind::files, path, description, member);
}

/// An enumeration whose values have names.
template <class Model, class Enumeration, class Member>
Parameter<Model> choice(std::string_view path, std::string_view description,
                        std::vector<std::pair<Enumeration, std::string_view>> named, Member member) {
    auto parameter = row<Model>(ParameterKind::choice, path, description);
    for (const auto& entry : named) {
        parameter.names.push_back(entry.second);
    }
    parameter.get = [member, named](const Model& model, std::size_t i) {
        const auto value = at(member, model, i);
        const auto found = std::find_if(named.begin(), named.end(), [&](const auto& e) { return e.first == value; });
        return Value(found == named.end() ? std::string() : std::string(found->second));
    };
    parameter.set = [member, named](Model& model, std::size_t i, const Value& value) {
        const auto& name = std::get<std::string>(value);
        const auto found = std::find_if(named.begin(), named.end(), [&](const auto& e) { return e.second == name; });
        if (found != named.end()) {
            at(member, model, i) = found->first;
        }
    };
    return parameter;
}

/// A list of numbers that are read and written together.
/// @param get (const Model&, index) -> std::vector<double>, or a Value  @param set (Model&, index, const vector&)
template <class Model, class Get, class Set>
Parameter<Model> numbers(std::string_view path, std::string_view description,
                         const std::vector<std::string_view>& elements, Get get, Set set) {
    auto parameter = row<Model>(ParameterKind::numbers, path, description);
    parameter.elements = elements;
    parameter.get = [get](const Model& model, std::size_t i) { return Value(get(model, i)); };
    parameter.set = [set](Model& model, std::size_t i, const Value& value) {
        set(model, i, std::get<std::vector<double>>(value));
    };
    return parameter;
}

/// A Vector3 as [x, y, z] or other names of its elements.
template <class Model, class Member>
Parameter<Model> vector(std::string_view path, std::string_view description,
                        const std::vector<std::string_view>& elements, Member member) {
    return numbers<Model>(
        path, description, elements,
        [member](const Model& model, std::size_t i) {
            const Vector3& v = at(member, model, i);
            return std::vector<double>(v.begin(), v.end());
        },
        [member](Model& model, std::size_t i, const std::vector<double>& given) {
            at(member, model, i) = {given[0], given[1], given[2]};
        });
}

/// Two members as a list of two numbers.
template <class Model, class First, class Second>
Parameter<Model> pair(std::string_view path, std::string_view description,
                      const std::vector<std::string_view>& elements, First first, Second second) {
    return numbers<Model>(
        path, description, elements,
        [first, second](const Model& model, std::size_t i) {
            return std::vector<double>{at(first, model, i), at(second, model, i)};
        },
        [first, second](Model& model, std::size_t i, const std::vector<double>& given) {
            at(first, model, i) = given[0];
            at(second, model, i) = given[1];
        });
}

/// A text that can only be what it is.
template <class Model>
Parameter<Model> constant(std::string_view path, std::string_view description, std::string_view only) {
    auto parameter = row<Model>(ParameterKind::choice, path, description);
    parameter.names = {only};
    parameter.get = [only](const Model&, std::size_t) { return Value(std::string(only)); };
    parameter.set = [](Model&, std::size_t, const Value&) {};
    return parameter;
}

/// Keys that may be there.
/// @param is_there (const Model&, index) -> bool   @param set (Model&, index, bool) makes it so
template <class Model, class IsThere, class Set>
Parameter<Model> group(std::string_view path, std::string_view description, IsThere is_there, Set set) {
    auto parameter = row<Model>(ParameterKind::group, path, description);
    parameter.count = [is_there](const Model& model, std::size_t i) -> std::size_t {
        return is_there(model, i) ? 1 : 0;
    };
    parameter.resize = [set](Model& model, std::size_t i, std::size_t count) { set(model, i, count > 0); };
    return parameter;
}

/// Keys that are always there.
template <class Model>
Parameter<Model> group(std::string_view path, std::string_view description) {
    return group<Model>(
        path, description, [](const Model&, std::size_t) { return true; }, [](Model&, std::size_t, bool) {});
}

/// Keys of a member that may be absent.
template <class Model, class Member>
Parameter<Model> optional_group(std::string_view path, std::string_view description, Member member) {
    return group<Model>(
        path, description, [member](const Model& model, std::size_t i) { return at(member, model, i).has_value(); },
        [member](Model& model, std::size_t i, bool is_there) {
            at(member, model, i).reset();
            if (is_there) {
                at(member, model, i).emplace();
            }
        });
}

/// Keys of one alternative of a variant.
template <class Alternative, class Model, class Member>
Parameter<Model> alternative(std::string_view path, std::string_view description, Member member) {
    auto parameter = group<Model>(
        path, description,
        [member](const Model& model, std::size_t i) {
            return std::holds_alternative<Alternative>(at(member, model, i));
        },
        [member](Model& model, std::size_t i, bool is_there) {
            if (is_there) {
                at(member, model, i) = Alternative{};
            }
        });
    parameter.exclusive = true;
    return parameter;
}

/// A std::vector of groups.
template <class Model, class Member>
Parameter<Model> list(std::string_view path, std::string_view description, Member member) {
    auto parameter = row<Model>(ParameterKind::list, path, description);
    parameter.count = [member](const Model& model, std::size_t i) { return at(member, model, i).size(); };
    parameter.resize = [member](Model& model, std::size_t i, std::size_t count) { at(member, model, i).resize(count); };
    return parameter;
}

/// A file that is read when its path is set, in the one place that knows how.
/// @param path_of names the std::string that keeps the path, an optional one where there need be no file
/// @param read (Model&, index, path) keeps what is in the file and throws InputError when it cannot be used
/// @param digest (const Model&, index) -> SHA-256 of what was read: it stands for the file wherever that lies
template <class Model, class PathOf, class Read, class Digest>
Parameter<Model> file(std::string_view path, std::string_view description, PathOf path_of, Read read, Digest digest) {
    auto parameter = member_row<Model, std::string>(ParameterKind::file, path, description, path_of);
    parameter.set = [path_of, read](Model& model, std::size_t i, const Value& value) {
        if (const auto* given = std::get_if<std::string>(&value)) {
            read(model, i, *given);
            at(path_of, model, i) = *given;
        }
    };
    parameter.digest = digest;
    return parameter;
}

/// A function of a part as one of the whole; empty if the part's is.
template <class Whole, class Member, class Result, class Part, class... Arguments>
auto through(const Member& member, const std::function<Result(Part&, std::size_t, Arguments...)>& of_part) {
    using Of = std::conditional_t<std::is_const_v<Part>, const Whole, Whole>;
    std::function<Result(Of&, std::size_t, Arguments...)> of_whole;
    if (of_part) {
        of_whole = [member, of_part](Of& whole, std::size_t i, Arguments... arguments) {
            return of_part(at(member, whole, i), i, arguments...);
        };
    }
    return of_whole;
}

/// The parameter of a part, seen from the whole. `member` names the part in the whole.
template <class Whole, class Part, class Member>
Parameter<Whole> nested(const Parameter<Part>& inner, std::string_view prefix, Member member) {
    Parameter<Whole> outer;
    const ParameterInfo& info = inner;
    static_cast<ParameterInfo&>(outer) = info;
    outer.path = std::string(prefix) + inner.path;
    outer.get = through<Whole>(member, inner.get);
    outer.set = through<Whole>(member, inner.set);
    outer.count = through<Whole>(member, inner.count);
    outer.resize = through<Whole>(member, inner.resize);
    outer.digest = through<Whole>(member, inner.digest);
    outer.applies = through<Whole>(member, inner.applies);
    return outer;
}

}  // namespace downwash::parameters
