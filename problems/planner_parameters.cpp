#include "downwash/problems/planner_parameters.hpp"

#include <string>
#include <utility>

#include "downwash/base/text.hpp"
#include "downwash/problems/algorithms.hpp"

namespace downwash {
namespace {

using Rows = std::vector<Parameter<PlannerSettings>>;
using parameters::append;

template <class Member>
Parameter<PlannerSettings> number(std::string_view path, std::string_view description, Member member) {
    return parameters::number<PlannerSettings>(path, description, member);
}
Parameter<PlannerSettings> group(std::string_view path, std::string_view description) {
    return parameters::group<PlannerSettings>(path, description);
}

void add_objective(Rows& rows) {
    rows.push_back(parameters::choice<PlannerSettings>("objective", "what a plan should keep small",
                                                       parameters::named(all_objectives), &PlannerSettings::objective)
                       .or_group([](const PlannerSettings& p) { return !p.objective.single(); },
                                 [](PlannerSettings& p) { p.objective = CostFunction::of_nothing(); }));
    for (const Objective objective : all_objectives) {
        rows.push_back(number("objective." + std::string(name_of(objective)),
                              "weight of 1 " + std::string(unit_of(objective)),
                              [objective](auto& p) -> decltype(auto) { return p.objective.weight(objective); })
                           .between(0, 1e9));
    }
}

/// A row for each name; what it means depends on the algorithm, and so does its default.
void add_algorithm_parameters(Rows& rows) {
    rows.push_back(group(
        "parameters", "parameters of the algorithm; `downwash planners` shows each algorithm's with their defaults"));
    for (const auto& [known, algorithms] : known_parameters()) {
        const AlgorithmParameter& parameter = *known;
        const std::string_view name = parameter.name;
        Parameter<PlannerSettings> row = parameters::row<PlannerSettings>(
            ParameterKind::number, "parameters." + std::string(name), parameter.description);
        row.range = {parameter.low, parameter.high};
        row.get = [name = name, usual = parameter.value](const PlannerSettings& p, std::size_t) {
            return Value(algorithm_parameter(p, name) != nullptr ? parameter_value(p, name) : usual);
        };
        row.set = [name = std::string(name)](PlannerSettings& p, std::size_t, const Value& value) {
            p.parameters[name] = std::get<double>(value);
        };
        rows.push_back(std::move(row).only(
            "with " + joined_names(algorithms),
            [name = name](const PlannerSettings& p, std::size_t) { return algorithm_parameter(p, name) != nullptr; }));
    }
}

}  // namespace

Rows planner_rows() {
    Rows rows;
    using Settings = PlannerSettings;
    const auto integer = [&](std::string_view path, std::string_view description, auto member) {
        return parameters::integer<PlannerSettings>(path, description, member);
    };
    append(rows, {parameters::choice<PlannerSettings>("variant", "what the planner knows of the physics",
                                                      parameters::named(all_variants), &Settings::variant),
                  parameters::choice<PlannerSettings>(
                      "algorithm", "how it searches; some plan for some variants only, see `downwash planners`",
                      algorithm_names(), &Settings::algorithm)});
    add_objective(rows);
    append(
        rows,
        {number("time_limit_s",
                "for the search alone, without the last flight; null: 10 s, or none where max_iterations "
                "is set",
                &Settings::time_limit_s)
             .above(0)
             .at_most(1e6),
         integer("max_iterations", "limit for a run that is repeatable bit for bit", &Settings::max_iterations)
             .between(1, 1e15),
         integer("seed", "every random number of the search follows from it", &Settings::seed).between(0, 4294967295.0),
         number("safety_margin_m", "least clearance while planning", &Settings::safety_margin_m).between(0, 100),
         parameters::choice<PlannerSettings>(
             "collision_checker",
             "who computes collisions and clearances; in executed flights FCL decides contact "
             "whatever stands here",
             parameters::named(all_collision_checkers), &Settings::collision_checker),
         number("max_saturation",
                "greatest demand on a rotor or the joint over its limit while planning; above 1 it is clipped",
                &Settings::max_saturation)
             .between(1, 1000),
         number("max_pitch_rate_deg_s",
                "how fast the vehicle may turn while planning, in space in roll and pitch together; an edge that turns "
                "faster is rejected as unstable; null: at any rate",
                &Settings::max_pitch_rate_rad_s)
             .between(1e-3, 1e5),
         parameters::flag<PlannerSettings>(
             "check_execution",
             "a plan counts only once it was executed well, with direct aerodynamics; false: "
             "also where that flight fails",
             &Settings::check_execution),
         integer("worlds", "in which every edge has to succeed, the nominal one included", &Settings::worlds)
             .between(1, 64),
         parameters::flag<PlannerSettings>("certify", "only a plan that gets its certificate counts",
                                           &Settings::certify),
         number("max_failure_probability", "share of worlds in which a plan may fail",
                &Settings::max_failure_probability)
             .between(1e-4, 0.5),
         number("confidence", "that a plan which is called solved does not fail more often", &Settings::confidence)
             .between(0.5, 0.999999)});
    add_algorithm_parameters(rows);
    return rows;
}

bool is_about_uncertainty(std::string_view path) {
    return path == "worlds" || path == "certify" || path == "max_failure_probability" || path == "confidence";
}

}  // namespace downwash
