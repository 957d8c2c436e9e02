#pragma once

#include "downwash/simulation/effect_slope.hpp"
#include "downwash/simulation/hover_analysis.hpp"

namespace downwash::simulation {

/// The equilibrium of the closed loop with the vehicle's centre of mass at (x, z) and the arm at an angle, in closed
/// form: at rest nothing moves within a tick, so that weight, joint and rotors must balance, which fixes the commands;
/// and the controller must ask for just these, which fixes its integrals and what error it needs.
[[nodiscard]] HoverTrim hover_trim(const Robot& robot, const TickModel& model, const LinearEffect& effect,
                                   const FlightState& resting);

}  // namespace downwash::simulation
