#pragma once

// Private to problems/.

#include <span>
#include <vector>

#include "downwash/base/parameter_factories.hpp"
#include "downwash/simulation/uncertainty_parameters.hpp"

namespace downwash {

/// Gives a problem an uncertainty. What the problem itself says of vehicle and sensors comes after what the robot says.
template <class Model>
Uncertainty& begin_uncertainty(Model& problem) {
    return problem.uncertainty.emplace(problem.robot.uncertainty.value_or(Uncertainty{}));
}

/// That of a problem; the defaults where it has none.
template <class Model>
const Uncertainty& uncertainty_of(const Model& problem) {
    static const Uncertainty usual;
    return problem.uncertainty ? *problem.uncertainty : usual;
}
template <class Model>
Uncertainty& uncertainty_of(Model& problem) {
    return problem.uncertainty ? *problem.uncertainty : begin_uncertainty(problem);
}

/// Adds uncertainty with everything in it to a problem's table.
/// @param keys below `uncertainty`
/// @param robot_of gives the Robot that conditions ask: (const Model&) -> const Robot& or Robot
template <class Model, class RobotOf>
void add_uncertainty_rows(std::vector<Parameter<Model>>& rows, std::span<const UncertaintyKey> keys, RobotOf robot_of) {
    rows.push_back(parameters::group<Model>(
                       "uncertainty", "what is not known exactly; plans survive it. none: everything is nominal",
                       [](const Model& p, std::size_t) { return p.uncertainty.has_value(); },
                       [](Model& p, std::size_t, bool is_there) {
                           p.uncertainty.reset();
                           if (is_there) {
                               begin_uncertainty(p);
                           }
                       })
                       .or_none());
    for (const UncertaintyKey& key : keys) {
        add_uncertainty_row(
            rows, key, [](auto& p) -> auto& { return uncertainty_of(p); }, robot_of);
        if (key.is_of_robot && key.spread != nullptr) {
            rows.back().default_of = "robot.uncertainty";
        }
    }
    rows.push_back(parameters::pair<Model>(
                       "uncertainty.wind.gust_length_m", "length scales of the gusts; default: 3 m above ground",
                       {"x", "z"}, [](auto& p) -> auto& { return uncertainty_of(p).gust_length_x_m; },
                       [](auto& p) -> auto& { return uncertainty_of(p).gust_length_z_m; })
                       .at_least(0.1)
                       .at_most(1000));
}

}  // namespace downwash
