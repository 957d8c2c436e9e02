#pragma once

#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash {

class ProblemCheck;

/// Where a robot can touch what a goal names.
struct TouchPlaces {
    std::vector<Goal> places;  ///< alternatives
    std::string reason;        ///< why there are none
};

/// @pre the goal asks for contact, and its values are sound   @throws InputError when an obstacle cannot be placed
[[nodiscard]] TouchPlaces find_touches(const ProblemCheck& check, const Goal& goal);

/// The problem with the places of all goals that ask for contact (Goal::places): in front of the obstacle, from which
/// the robot can touch it, some at most. A place has a flat surface across its way, and the robot that hovers or
/// touches there keeps clear of everything else. The same problem if no goal asks for contact; without places of one
/// that has none: problem_errors() says why. What reads problem files and plannable() calls it.
/// @pre obstacles can be placed, and the robot has no errors
[[nodiscard]] DOWNWASH_EXPORT Problem with_touches(Problem problem);

}  // namespace downwash
