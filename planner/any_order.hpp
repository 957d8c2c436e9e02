#pragma once

#include <cstdint>
#include <functional>

#include "downwash/base/export.hpp"
#include "downwash/planner/leg_table.hpp"

namespace downwash::planning {

/// Plans a problem without targets: its goals one after the other. Fills what it finds into the solution.
/// @param least_round as for solve_in_turn()
/// @param attempts plans that asked for a certificate before, and then with those of this search
using SequenceSearch = std::function<void(const Problem& in_order, const SolveOptions&, double least_round,
                                          std::uint64_t& attempts, Solution&)>;

/// Chooses in which order the targets of a problem are visited, which of their alternatives are approached and, under
/// an energy budget, which targets are left out; and plans the flight. First a whole flight in the order that is best
/// by lower bounds, then orders are compared by flown legs (LegTable): the best order by what is known is flown leg by
/// leg until it consists of flown legs. What is left of the limits goes into the flight in that order. The best flight
/// counts: most targets, then the lowest cost. A target to which no flight is found makes it `approximate`; one for
/// which the energy is not enough does not.
/// @param map of the planner's own model; nullptr for none
/// @pre the problem has targets
DOWNWASH_EXPORT void solve_in_any_order(const Problem& problem, const FlightModel& model, const AeroMap* map,
                                        const SolveOptions& options, const LegSearch& search_leg,
                                        const SequenceSearch& search_sequence, Solution& solution);

}  // namespace downwash::planning
