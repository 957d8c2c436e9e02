#pragma once

#include "downwash/base/export.hpp"
#include "downwash/planner/course.hpp"
#include "downwash/planner/search_result.hpp"
#include "downwash/planner/solve_options.hpp"

namespace downwash::planning {

class ProblemWorlds;
class StopFinder;

/// What plans of a search have to pass beside their own flight.
struct PlanChecks {
    ProblemWorlds* worlds = nullptr;    ///< worlds that edges and plans have to survive; nullptr: the nominal one alone
    StopFinder* stop_finder = nullptr;  ///< says where a whole plan can be left for a hover; nullptr: nobody asks
};

/// MP-ARM-DA and MP-ARM-ADA: searches a flight to the goal of a problem with a single goal.
/// @param part the problem up to that goal   @param whole the problem that it is a part of, or itself
/// @param before what was flown up to the part's start
DOWNWASH_EXPORT SearchResult search_flights(const Problem& part, const Problem& whole, const PlannerModel& model,
                                            const Course& before, const PlanChecks& checks,
                                            const SolveOptions& options);

}  // namespace downwash::planning
