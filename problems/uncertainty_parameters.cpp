#include "downwash/problems/uncertainty_parameters.hpp"

#include "downwash/base/parameter_factories.hpp"
#include "downwash/simulation/uncertainty_parameters.hpp"

namespace downwash {
namespace {

/// Gives a problem an uncertainty. What the problem itself says of vehicle and sensors comes after what the robot says.
Uncertainty& begin(Problem& problem) {
    return problem.uncertainty.emplace(problem.robot.uncertainty.value_or(Uncertainty{}));
}

/// That of a problem; the defaults where it has none.
const Uncertainty& uncertainty_of(const Problem& problem) {
    static const Uncertainty usual;
    return problem.uncertainty ? *problem.uncertainty : usual;
}
Uncertainty& uncertainty_of(Problem& problem) {
    return problem.uncertainty ? *problem.uncertainty : begin(problem);
}

}  // namespace

void add_uncertainty_rows(std::vector<Parameter<Problem>>& rows) {
    rows.push_back(parameters::group<Problem>(
                       "uncertainty", "what is not known exactly; plans survive it. none: everything is nominal",
                       [](const Problem& p, std::size_t) { return p.uncertainty.has_value(); },
                       [](Problem& p, std::size_t, bool is_there) {
                           p.uncertainty.reset();
                           if (is_there) {
                               begin(p);
                           }
                       })
                       .or_none());
    for (const UncertaintyKey& key : uncertainty_keys()) {
        add_uncertainty_row(
            rows, key, [](auto& p) -> auto& { return uncertainty_of(p); },
            [](const Problem& problem) -> const Robot& { return problem.robot; });
        if (key.is_of_robot && key.spread != nullptr) {
            rows.back().default_of = "robot.uncertainty";
        }
    }
    rows.push_back(parameters::pair<Problem>(
                       "uncertainty.wind.gust_length_m", "length scales of the gusts; default: 3 m above ground",
                       {"x", "z"}, [](auto& p) -> auto& { return uncertainty_of(p).gust_length_x_m; },
                       [](auto& p) -> auto& { return uncertainty_of(p).gust_length_z_m; })
                       .at_least(0.1)
                       .at_most(1000));
}

}  // namespace downwash
