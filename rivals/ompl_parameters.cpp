#include "downwash/rivals/ompl_parameters.hpp"

#include <span>
#include <string>

#include "downwash/base/text.hpp"
#include "downwash/problems/algorithms.hpp"

namespace downwash::planning {
namespace {

std::span<const AlgorithmParameter> parameters_of(std::string_view algorithm) {
    for (const AlgorithmInfo& info : algorithms()) {
        if (info.name == algorithm) {
            return info.parameters;
        }
    }
    return {};
}

}  // namespace

std::optional<double> parameter_of(std::string_view algorithm, std::string_view parameter) {
    for (const AlgorithmParameter& known : parameters_of(algorithm)) {
        if (known.name == parameter) {
            return known.value;
        }
    }
    return std::nullopt;
}

void set_parameters(ompl::base::Planner& planner, std::string_view algorithm) {
    for (const AlgorithmParameter& parameter : parameters_of(algorithm)) {
        const std::string name(parameter.name);
        if (planner.params().hasParam(name)) {
            planner.params().setParam(name, to_text(parameter.value));
        }
    }
}

}  // namespace downwash::planning
