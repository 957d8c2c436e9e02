#pragma once

#include "downwash/ompl_planners/ompl_search.hpp"
#include "downwash/ompl_planners/steered_flights.hpp"
#include "downwash/search/random.hpp"

namespace downwash::planning {

/// OMPL's planners over controls on steered flights, with algorithm, seed and parameters of the task's problem: `rrt`,
/// `sst`, `kpiece1` or `est`. An iteration is one turn of the planner's own loop. `sst` goes on for better plans; the
/// others end with the first that is accepted. Nodes of the tree are where references would come to rest.
template <class Family>
[[nodiscard]] OmplResultOf<Family> plan_by_controls(const SteeredFlightsOf<Family>& flights, Random& random,
                                                    const OmplHooksOf<Family>& hooks);

}  // namespace downwash::planning
