#include "downwash/ompl_planners/ompl_parameters.hpp"

#include <string>

#include "downwash/base/text.hpp"
#include "downwash/problems/algorithms.hpp"

namespace downwash::planning {

void set_parameters(ompl::base::Planner& planner, const PlannerSettings& settings) {
    for (const AlgorithmParameter& parameter : algorithm_parameters(settings)) {
        const std::string name(parameter.name);
        if (planner.params().hasParam(name)) {
            planner.params().setParam(name, to_text(parameter_value(settings, name)));
        }
    }
}

}  // namespace downwash::planning
