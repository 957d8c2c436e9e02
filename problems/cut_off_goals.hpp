#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/scene/scene.hpp"

namespace downwash {

/// A goal to which no way leads in the plane of motion.
struct CutOffGoal {
    std::size_t goal = 0;                ///< its number in goals_of()
    std::vector<std::size_t> obstacles;  ///< that close the way, by their numbers in Problem::obstacles
};

/// Goals that are proven to be out of reach, because the scene parts the plane within the bounds; see
/// cut_off_regions(). Where a goal has alternatives, all of them are. Nothing is said of contacts.
/// @param scene of the problem's obstacles
[[nodiscard]] DOWNWASH_EXPORT std::vector<CutOffGoal> cut_off_goals(const Problem& problem, const Scene& scene);

/// Whether goals that are cut off leave no plan at all: one in a row, the place to return to, or all targets.
[[nodiscard]] DOWNWASH_EXPORT bool leave_no_plan(const std::vector<CutOffGoal>& cut_off, const Problem& problem);

/// Labels of obstacles in quotation marks, for messages: "'deck', 'pier' and 'wall'".
[[nodiscard]] DOWNWASH_EXPORT std::string quoted_labels(const std::vector<std::string>& labels);

}  // namespace downwash
