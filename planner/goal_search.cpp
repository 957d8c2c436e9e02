#include "downwash/planner/goal_search.hpp"

#include "downwash/planner/line_search.hpp"

namespace downwash::planning {

SearchResult search_goal(const Problem& part, const Problem& whole, const PlannerModel& model, const Course& before,
                         const PlanChecks& checks, const SolveOptions& options) {
    if (part.planner.variant != Variant::mp_arm) {
        return search_flights(part, whole, model, before, checks, options);
    }
    SearchResult result = search_lines(part, *model.flight, options);
    result.attempts = before.attempts;
    return result;
}

}  // namespace downwash::planning
