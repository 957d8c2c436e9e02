#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "downwash/planner/certificate.hpp"
#include "downwash/planner/solve_options.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash {

/// A change of a problem for which a search found no certified plan, and what came of trying it.
struct Remedy {
    std::string change;                  ///< change in words, for example "the goal 0.2 m lower"
    std::string error;                   ///< why the changed problem cannot be planned; empty if it can
    std::vector<std::string> closed_by;  ///< obstacles past which no way leads in the plane; see cut_off_goals()
    /// Edges that collisions stopped, by obstacle; see SearchRecord.
    std::map<std::string, std::uint64_t> stopped_by;
    bool helps = false;  ///< whether a plan got its certificate
    /// Certificate of that plan or, without one, of the plan that failed least.
    std::optional<Certificate> certificate;
    double cost = 0;    ///< cost of that plan, in the objective's unit
    double wall_s = 0;  ///< time that the search took [s]
};

/// Tries what may help where a search found no certified plan: another place or tolerance of the goal, a larger margin,
/// slower motion, a stiffer controller, and all uncertainties halved. Each change is tried alone; its search ends at
/// the first certified plan. The result does not say that nothing else would help.
/// @param limit_s wall time of each search per goal [s], > 0; a limit of iterations stays. Together the searches take
/// no more than one and a half times what they may for one goal.
/// @param on_tried called after each
/// @pre the problem has an uncertainty
/// @return in the order in which they were tried; fewer than all when options.stop was requested
[[nodiscard]] DOWNWASH_EXPORT std::vector<Remedy> try_remedies(const Problem& problem, const SolveOptions& options,
                                                               double limit_s,
                                                               const std::function<void(const Remedy&)>& on_tried = {});

}  // namespace downwash
