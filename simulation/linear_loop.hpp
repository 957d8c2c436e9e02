#pragma once

// Private to simulation/.

#include <Eigen/Core>
#include <vector>

#include "downwash/simulation/stability_margins.hpp"

// A closed loop that was linearised at its hover, and what follows from it.

namespace downwash::simulation {

/// What past motions of one age do to a tick.
struct LatePart {
    int age = 0;        ///< in ticks, from 1
    Eigen::MatrixXd a;  ///< a column for each number of the motion
    Eigen::MatrixXd c;  ///< the same, a row for each loop
};

/// Closed loops from what is added to a command to that command, x' = A x + B u, y = C x, with the parts of what the
/// controller sees late. Each column of B, with the same row of C, is a loop, while nothing is added to the others. A
/// motion of that age is the first numbers of x so many ticks ago, so that x has no others.
struct LinearLoops {
    Eigen::MatrixXd a, b, c;
    std::vector<LatePart> late;
};

/// Margins of each loop from samples of its gain over rising frequencies, between which its logarithm is taken as
/// linear.
[[nodiscard]] std::vector<LoopMargins> margins_of(const LinearLoops& loops, double tick_s);

/// The Jacobian of one tick with past motions among the numbers, as many as the late parts reach.
/// @param a,late as of LinearLoops, without commands
[[nodiscard]] Eigen::MatrixXd with_past(const Eigen::MatrixXd& a, const std::vector<LatePart>& late);

}  // namespace downwash::simulation
