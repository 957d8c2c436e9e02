#pragma once

#include "downwash/simulation/robot.hpp"
#include "downwash/simulation/world.hpp"

// How stiffly a vehicle is held at its place, and how far it is beside its plane (docs/model.md 9). Private: not
// installed.

namespace downwash::judge {

/// What a law answers to a metre along an axis, x or z [1/s2].
[[nodiscard]] double answer_1_s2(const ::downwash::ControlLaw& law, bool is_height);

/// How far a vehicle is to the left of where the obstacles of its world have its plane [m].
[[nodiscard]] double lateral_m(const World& world, const Robot& robot);

}  // namespace downwash::judge
