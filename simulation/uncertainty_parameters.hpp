#pragma once

#include <string>
#include <utility>
#include <vector>

#include "downwash/base/parameter_factories.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash {

/// Adds a key below `uncertainty` to the table of a Model that has an Uncertainty.
/// @param key without a spread: the group itself   @param uncertainty gives that of a model: (auto& model) -> auto&
/// @param robot_of gives the robot of a model
template <class Model, class Member, class RobotOf>
void add_uncertainty_row(std::vector<Parameter<Model>>& rows, const UncertaintyKey& key, Member uncertainty,
                         RobotOf robot_of) {
    const std::string path = "uncertainty." + std::string(key.path);
    if (key.spread == nullptr) {
        rows.push_back(parameters::group<Model>(path, key.description));
        return;
    }
    const auto spread = [ uncertainty, member = key.spread ](auto& model) -> auto& {
        return uncertainty(model).*member;
    };
    rows.push_back(
        parameters::spread<Model>(path, key.description, key.forms, spread).at_least(key.low).at_most(key.high));
    if (key.is_in_effect != nullptr) {
        rows.back() = std::move(rows.back()).only(key.condition, [key, robot_of](const Model& model, std::size_t) {
            return key.is_in_effect(robot_of(model));
        });
    }
}

}  // namespace downwash
