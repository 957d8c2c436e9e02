#pragma once

#include <cstdint>
#include <random>

#include "downwash/problems/problem.hpp"

namespace downwash::bench {

/// Between two numbers; the same on every machine, which std::uniform_real_distribution is not.
double uniform_between(std::mt19937_64& engine, double low, double high);

/// The given problem with ten boxes, cylinders and spheres at random places and attitudes in place of its obstacles:
/// what no engineer would build.
Problem with_random_primitives(Problem problem, unsigned seed);

/// The given problem with one obstacle, a pipe of 0.5 m diameter along the plane of motion in the middle of its bounds,
/// as a closed mesh of 2 around (along + 1) triangles.
Problem with_pipe_mesh(Problem problem, std::uint32_t around, std::uint32_t along);

}  // namespace downwash::bench
