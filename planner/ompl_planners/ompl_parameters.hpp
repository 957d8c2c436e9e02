#pragma once

#include <ompl/base/Planner.h>

#include "downwash/problems/problem.hpp"

namespace downwash::planning {

/// Gives one of OMPL's planners the parameters of a problem's algorithm: the problem's own values, or the defaults that
/// algorithms() lists.
void set_parameters(ompl::base::Planner& planner, const PlannerSettings& settings);

}  // namespace downwash::planning
