#pragma once

#include "downwash/simulation/effect_slope.hpp"
#include "downwash/simulation/hover_analysis.hpp"

namespace downwash::simulation {

/// The equilibrium of the closed loop with the vehicle's centre of mass at (x, z) and the arm at an angle, in closed
/// form: at rest nothing moves within a tick, so that weight, joint and rotors must balance, which fixes the commands;
/// and the controller must ask for just these, which fixes its integrals and what error it needs.
[[nodiscard]] HoverTrim hover_trim(const Robot& robot, const TickModel& model, const LinearEffect& effect,
                                   const FlightState& resting);

/// The rotors' commands [N] of the law for a thrust [N] and a pitch torque [N m] that the vehicle at rest should have
/// by what the law knows: allocated and, with a feed-forward, divided by what it reads. Linear in both.
void command_rotors_at_rest(const TickModel& model, const LinearEffect& effect, const dynamics::PlantState<double>& at,
                            double thrust_n, double pitch_torque_nm, double (&command_n)[max_rotors]);

}  // namespace downwash::simulation
