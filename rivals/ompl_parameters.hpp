#pragma once

#include <ompl/base/Planner.h>

#include <optional>
#include <string_view>

namespace downwash::planning {

/// The value of an algorithm's parameter as algorithms() lists it.
[[nodiscard]] std::optional<double> parameter_of(std::string_view algorithm, std::string_view parameter);

/// Gives one of OMPL's planners the parameters that algorithms() lists for it and that are OMPL's.
void set_parameters(ompl::base::Planner& planner, std::string_view algorithm);

}  // namespace downwash::planning
