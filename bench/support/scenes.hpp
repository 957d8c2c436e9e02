#pragma once

#include <cstdint>

#include "downwash/problems/problem.hpp"

namespace downwash::bench {

/// The given problem with ten boxes, cylinders and spheres at random places and attitudes in place of its obstacles.
Problem with_random_primitives(Problem problem, unsigned seed);

/// The given problem with one obstacle, a pipe of 0.5 m diameter along the plane of motion in the middle of its bounds,
/// as a closed mesh of 2 around (along + 1) triangles.
Problem with_pipe_mesh(Problem problem, std::uint32_t around, std::uint32_t along);

}  // namespace downwash::bench
