#pragma once

#include <vector>

#include "downwash/controllers/plan.hpp"
#include "downwash/ompl_planners/ompl_search.hpp"
#include "downwash/search/query_counts.hpp"
#include "downwash/search/random.hpp"
#include "downwash/search/search_task.hpp"

namespace downwash::planning {

/// How a geometric search ended. Its cost is the variant's estimate: level hover along the reference and through the
/// hold.
template <class Family>
struct GeometricResultOf : OmplResultOf<Family> {
    QueryCounts counts;
    std::uint64_t discarded = 0;  ///< paths to the goal that did not count
};

/// For MP-ARM: OMPL's geometric planners in (x, z, arm) or (x, y, z, yaw, joints) with the vehicle level and straight
/// edges; blind to dynamics (thesis C.2). An iteration is one turn of the planner's own loop. Anytime planners go on
/// for better plans; RRT-Connect ends with the first that is accepted, and begins anew after one that is not.
template <class Family>
[[nodiscard]] GeometricResultOf<Family> plan_geometrically(const SearchTaskOf<Family>& task, Random& random,
                                                           const OmplHooksOf<Family>& hooks);

}  // namespace downwash::planning
