#pragma once

// Private to problems/.

#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/scene/shape_parameters.hpp"

// Checks of what problems of every kind have.

namespace downwash {

/// Obstacles with a name that another has, too.
template <class Model>
std::vector<KeyError> repeated_names(const Model& p) {
    std::vector<KeyError> errors;
    std::set<std::string_view> names;
    for (std::size_t i = 0; i < p.obstacles.size(); ++i) {
        const std::string& name = p.obstacles[i].name;
        if (!name.empty() && !names.insert(name).second) {
            errors.push_back({"environment.obstacles[" + std::to_string(i) + "].name",
                              "is '" + excerpt(name) + "' like an obstacle before it: expected a name used once"});
        }
    }
    return errors;
}

/// Cylinders among the obstacles whose axis has no direction.
template <class Model>
std::vector<KeyError> shapeless_cylinders(const Model& p) {
    return shape_errors(p.obstacles, "environment.obstacles");
}

/// Surface effects that lack what their model needs.
template <class Model>
std::vector<KeyError> incomplete_effects(const Model& p) {
    std::vector<KeyError> errors;
    if (p.aero.enabled && !p.aero.map) {
        for (const auto& [effect, key] :
             {std::pair(&p.aero.ground, "aero.ground"), {&p.aero.ceiling, "aero.ceiling"}}) {
            if (effect->model == EffectModel::table && !effect->table) {
                errors.push_back({std::string(key) + ".file", "is missing: expected the file of the table"});
            }
        }
        if (p.aero.ceiling.model == EffectModel::multirotor_body) {
            errors.push_back({"aero.ceiling.model",
                              "is multirotor-body: expected a model without a fountain, which "
                              "rises from the ground only"});
        }
    }
    return errors;
}

/// A cost of nothing.
template <class Model>
std::vector<KeyError> weightless_objective(const Model& p) {
    if (p.planner.objective == CostFunction::of_nothing()) {
        return {{"planner.objective", "has no weight above 0: expected one at least"}};
    }
    return {};
}

/// Planning without a margin. A warning.
template <class Model>
std::vector<KeyError> no_margin(const Model& problem) {
    if (problem.planner.safety_margin_m > 0 || problem.obstacles.empty()) {
        return {};
    }
    return {{"planner.safety_margin_m",
             "is 0: plans may pass obstacles at any distance above 0, and the least deviation is a collision; expected "
             "what the vehicle may be off its reference, 0.05 by default"}};
}

}  // namespace downwash
