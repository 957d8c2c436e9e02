#pragma once

// Private to problems/.

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/algorithms.hpp"
#include "downwash/problems/number_text.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/scene/shape_parameters.hpp"
#include "downwash/scene/shapes.hpp"

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

/// A start in contact with an obstacle, or nearer to one than the planner's margin.
/// @param checker,pose of the robot at the start, in a plane or in space
template <class Model, class Checker, class Pose>
std::vector<KeyError> start_near_obstacle(const Model& p, const Checker& checker, const Pose& pose) {
    if (!checker.is_nearer_than(pose, p.planner.safety_margin_m)) {
        return {};
    }
    const double clearance_m = checker.clearance_m(pose);
    const std::string remedy = ": move the start or the obstacle";
    constexpr double accuracy_m = 1e-7;  // of distances, with a reserve
    const auto nearest = checker.nearest_obstacle(pose, std::max(clearance_m, 0.0) + accuracy_m);
    const std::string obstacle =
        nearest ? "the obstacle '" + excerpt(label_of(p.obstacles, *nearest)) + "'" : std::string("an obstacle");
    if (clearance_m < accuracy_m) {
        return {{"start", "is in collision with " + obstacle + remedy}};
    }
    const bool can_be_told = p.planner.safety_margin_m - clearance_m > accuracy_m;
    return {{"start", "is " + problems::rounded(clearance_m) + " m from " + obstacle + ", " +
                          (can_be_told ? "nearer than" : "up to rounding not beyond") + " planner.safety_margin_m, " +
                          to_text(p.planner.safety_margin_m) + remedy}};
}

/// A cost of nothing.
template <class Model>
std::vector<KeyError> weightless_objective(const Model& p) {
    if (p.planner.objective == CostFunction::of_nothing()) {
        return {{"planner.objective", "has no weight above 0: expected one at least"}};
    }
    return {};
}

/// An algorithm that does not plan for the variant.
template <class Model>
std::vector<KeyError> algorithm_of_another_variant(const Model& p) {
    std::vector<std::string_view> names;
    for (const AlgorithmInfo& algorithm : algorithms()) {
        if (algorithm.plans_for(p.planner.variant)) {
            names.push_back(algorithm.name);
        }
    }
    if (std::find(names.begin(), names.end(), p.planner.algorithm) != names.end()) {
        return {};
    }
    std::string hint = did_you_mean(p.planner.algorithm, names);
    if (hint.empty()) {
        hint = "; did you mean '" + std::string(names.front()) + "'?";
    }
    return {{"planner.algorithm", "is '" + excerpt(p.planner.algorithm) + "', which does not plan for " +
                                      std::string(name_of(p.planner.variant)) + ": expected " + joined_names(names) +
                                      hint}};
}

/// Settings of flights under the variant that flies nothing.
template <class Model>
std::vector<KeyError> flights_without_flying(const Model& p) {
    const PlannerSettings& given = p.planner;
    const PlannerSettings defaults;
    std::vector<KeyError> errors;
    if (plans_flights(given.variant)) {
        return errors;
    }
    const auto reject = [&errors](const char* key) {
        errors.push_back({key,
                          "is about flights, and the edges of mp-arm are lines: expected mp-arm-da or mp-arm-ada, or "
                          "no such key"});
    };
    if (given.worlds != defaults.worlds) {
        reject("planner.worlds");
    }
    if (given.max_saturation != defaults.max_saturation) {
        reject("planner.max_saturation");
    }
    if (given.max_pitch_rate_rad_s) {
        reject("planner.max_pitch_rate_deg_s");
    }
    return errors;
}

/// Parameters of an algorithm that are no whole numbers and should be.
template <class Model>
std::vector<KeyError> split_whole_numbers(const Model& p) {
    std::vector<KeyError> errors;
    for (const auto& [name, value] : p.planner.parameters) {
        const AlgorithmParameter* parameter = algorithm_parameter(p.planner, name);
        if (parameter != nullptr && parameter->is_whole && value != std::floor(value)) {
            errors.push_back({"planner.parameters." + name, "is " + to_text(value) + ": expected a whole number"});
        }
    }
    return errors;
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
