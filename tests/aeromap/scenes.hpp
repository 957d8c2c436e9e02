#pragma once

#include <memory>
#include <vector>

#include "../support/random.hpp"
#include "downwash/aeromap/aero_map.hpp"
#include "downwash/scene/scene.hpp"

namespace downwash::test {

/// Any shape in any attitude, a good part of them level, about half a metre to one and a half large.
Obstacle any_obstacle(Random& random, const Vector3& center_m);

/// Some of them, with centres up to `half_m` from the origin along each axis.
std::vector<Obstacle> any_obstacles(Random& random, int count, const Vector3& half_m);

/// Any point up to `half_m` from the origin along each axis.
Vector3 any_point(Random& random, const Vector3& half_m);

/// Ground, deck with girders, pier, pipes, a ball and a tilted block, over 24 m by 12 m.
std::vector<Obstacle> bridge();

/// The same effect at some lateral offsets, as layers of a map.
std::vector<MapLayer> layers(const std::shared_ptr<const DirectEffect>& effect, const std::vector<double>& lateral_m);

/// The disc average of k by 10^6 rays on a square grid (fewer for a smaller `side`), from vertical extents only.
DirectEffect::Factors by_rays(const DirectEffect& effect, const Vector3& hub_m, int side = 1128);

std::shared_ptr<const Scene> scene_of(std::vector<Obstacle> obstacles);

/// The effect on a rotor of 0.2 m.
DirectEffect effect_of(std::vector<Obstacle> obstacles, const AeroSettings& settings = {});

/// Triangles apart from each other, about points up to `half_m` from the origin along each axis.
Mesh some_triangles(Random& random, int count, const Vector3& half_m = {0.6, 0.6, 0.8}, double size_m = 0.2);

/// The effect on a rotor among obstacles.
std::shared_ptr<const DirectEffect> effect_in(std::vector<Obstacle> obstacles, double radius_m,
                                              const AeroSettings& settings = {});

}  // namespace downwash::test
