#pragma once

#include <string>
#include <variant>
#include <vector>

#include "downwash/base/direction.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/parameter_factories.hpp"
#include "downwash/scene/shapes.hpp"

namespace downwash {

/// Adds the primitive shapes that a solid can have to a parameter table, each with what add_place(rows, path) adds to
/// it.
/// @param path of the list element that the shape is in, for example "environment.obstacles[]"
/// @param shape a lambda (model, index) -> Shape&
template <class Model, class ShapeOf, class AddPlace>
void add_shape_rows(std::vector<Parameter<Model>>& rows, const std::string& path, ShapeOf shape, AddPlace add_place) {
    using parameters::alternative;
    using parameters::number;
    using parameters::vector;
    const auto of = [shape]<class Kind, class Number>(Number Kind::*member) {
        return parameters::in(
            [shape](auto& m, std::size_t i) -> auto& { return std::get<Kind>(shape(m, i)); }, member);
    };
    const auto add_length = [&](Parameter<Model> row) {
        rows.push_back(std::move(row).between(1e-6, 1e5).is_required());
    };
    rows.push_back(alternative<Box, Model>(path + ".box", "a solid box", shape));
    add_length(
        vector<Model>(path + ".box.size_m", "edge lengths along its own axes", {"x", "y", "z"}, of(&Box::size_m)));
    add_place(rows, path + ".box");
    rows.push_back(alternative<Cylinder, Model>(path + ".cylinder", "a solid cylinder with flat ends", shape));
    add_length(number<Model>(path + ".cylinder.radius_m", "radius", of(&Cylinder::radius_m)));
    add_length(number<Model>(path + ".cylinder.length_m", "length from end to end", of(&Cylinder::length_m)));
    rows.push_back(vector<Model>(path + ".cylinder.axis", "direction of its length, of any length but zero",
                                 {"x", "y", "z"}, of(&Cylinder::axis))
                       .between(-1e5, 1e5));
    add_place(rows, path + ".cylinder");
    rows.push_back(alternative<Sphere, Model>(path + ".sphere", "a solid sphere", shape));
    add_length(number<Model>(path + ".sphere.radius_m", "radius", of(&Sphere::radius_m)));
    add_place(rows, path + ".sphere");
}

/// What the ranges of single values cannot say of such solids. @param list their key
template <class Solid>
std::vector<KeyError> shape_errors(const std::vector<Solid>& solids, const std::string& list) {
    std::vector<KeyError> errors;
    for (std::size_t i = 0; i < solids.size(); ++i) {
        const auto* cylinder = std::get_if<Cylinder>(&solids[i].shape);
        if (cylinder && !has_direction(cylinder->axis)) {
            errors.push_back({list + "[" + std::to_string(i) + "].cylinder.axis",
                              "has no direction: expected a vector other than [0, 0, 0]"});
        }
    }
    return errors;
}

}  // namespace downwash
