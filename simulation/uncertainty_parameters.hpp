#pragma once

#include <string>
#include <vector>

#include "downwash/base/parameter_factories.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash {

/// Adds a key below `uncertainty` to the table of a Model that has an Uncertainty.
/// @param key without a spread: the group itself   @param uncertainty gives that of a model: (auto& model) -> auto&
template <class Model, class Member>
void add_uncertainty_row(std::vector<Parameter<Model>>& rows, const UncertaintyKey& key, Member uncertainty) {
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
}

}  // namespace downwash
