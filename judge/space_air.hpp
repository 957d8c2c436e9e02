#pragma once

#include <vector>

#include "downwash/judge/space_bodies.hpp"

// The air around a vehicle in space: drag of the multirotor and of the links, and the slipstreams of the rotors on the
// links (docs/model.md 2.8 and 2.9). Private: not installed.

namespace downwash::judge {

/// Adds drag in moving air. @param wind_m_s velocity of the air, world
void add_drag(const SpaceVehicle& vehicle, const BodyMotions& bodies, const Eigen::Vector3d& wind_m_s,
              std::vector<BodyLoad>& loads);

/// Adds what slipstreams change of the links' drag. @param thrust_n of each rotor in free air, as it really acts
void add_wash(const SpaceVehicle& vehicle, const BodyMotions& bodies, const std::vector<double>& thrust_n,
              const Eigen::Vector3d& wind_m_s, std::vector<BodyLoad>& loads);

}  // namespace downwash::judge
