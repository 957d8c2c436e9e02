#pragma once

#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"

namespace downwash {

/// The velocity field of a rotor over the ground as a potential flow: a source at the rotor's hub, (0, 0, height), and
/// its image below the ground, (0, 0, -height); thesis (2.10) to (2.12) with the strength s = R^2 v_i / 4 of (2.8).
/// The thesis draws it as figure 2.2. It illustrates the model behind K = 1 / (1 - (R / 4z)^2), not the real flow.
/// @param position_radii from the ground point below the hub, z upwards, in rotor radii
/// @param height_radii of the rotor over the ground, > 0
/// @return the velocity, in units of the induced velocity v_i of the rotor in free air; not finite at the two sources
[[nodiscard]] DOWNWASH_EXPORT Vector3 potential_flow_velocity(const Vector3& position_radii, double height_radii);

}  // namespace downwash
