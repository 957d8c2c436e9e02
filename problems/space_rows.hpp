#pragma once

// Private to problems/.

#include <optional>
#include <string_view>
#include <type_traits>
#include <vector>

#include "downwash/base/parameter_factories.hpp"

// Kinds of rows that problems in space have beside those of all models.

namespace downwash {

/// [x, y, z]; null where the member is an optional one.
template <class Model, class Member>
Parameter<Model> space_vector(std::string_view path, std::string_view description, Member member) {
    using Type = parameters::MemberType<Model, Member>;
    if constexpr (std::is_same_v<Type, std::optional<Vector3>>) {
        auto row = parameters::row<Model>(ParameterKind::numbers, path, description);
        row.elements = {"x", "y", "z"};
        row.nullable = true;
        row.get = [member](const Model& model, std::size_t i) {
            const std::optional<Vector3>& held = parameters::at(member, model, i);
            return held ? Value(std::vector<double>(held->begin(), held->end())) : Value();
        };
        row.set = [member](Model& model, std::size_t i, const Value& value) {
            std::optional<Vector3>& held = parameters::at(member, model, i);
            held.reset();
            if (const auto* given = std::get_if<std::vector<double>>(&value)) {
                held = Vector3{(*given)[0], (*given)[1], (*given)[2]};
            }
        };
        return row;
    } else {
        return parameters::vector<Model>(path, description, {"x", "y", "z"}, member);
    }
}

/// A list of any number of numbers.
template <class Model, class Member>
Parameter<Model> number_list(std::string_view path, std::string_view description, Member member) {
    return parameters::numbers<Model>(
        path, description, {},
        [member](const Model& model, std::size_t i) { return Value(parameters::at(member, model, i)); },
        [member](Model& model, std::size_t i, const std::vector<double>& given) {
            parameters::at(member, model, i) = given;
        });
}

}  // namespace downwash
