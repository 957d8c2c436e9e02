#pragma once

#include "downwash/controllers/reference_point.hpp"
#include "downwash/controllers/rest.hpp"
#include "downwash/simulation/robot.hpp"
#include "downwash/simulation/tick_model.hpp"
#include "downwash/simulation/vehicle_state.hpp"

namespace downwash {

/// How a vehicle hovers: the equilibrium of its closed loop near surfaces.
struct HoverTrim {
    HoldLimit limit = HoldLimit::none;  ///< anything else: there is no equilibrium; the other members show why
    FlightState state{};                ///< fixed point of the tick: at rest and level, integrators settled
    /// The reference that makes the controller hold the vehicle there. It differs from the vehicle's place on axes
    /// without an integrator, and where an integrator has reached its limit.
    ReferencePoint reference;
    double rotor_command_n[max_rotors] = {};
    double joint_torque_nm = 0;
    double saturation = 0;           ///< greatest demand over its limit, as in a tick
    double pitch_reference_rad = 0;  ///< pitch that the controller asks for in vain, to counter the surfaces' torque
    double height_gain_1_s2 = 0;     ///< vertical acceleration that the controller sets against a metre of error
    double pitch_gain_1_s2 = 0;      ///< pitch acceleration that it sets against a radian of error
    /// The numbers of the state on which later ticks depend: an integrator at its limit is none of them.
    simulation::State<bool> feeds_back{};
};

namespace simulation {

class LinearEffect;

/// The equilibrium of the closed loop where a vehicle rests, in closed form: at rest nothing moves within a tick, so
/// that weight, joint and rotors must balance, which fixes the commands; and the controller must ask for just these,
/// which fixes its integrals and what error it needs.
[[nodiscard]] HoverTrim hover_trim(const Robot& robot, const TickModel& model, LinearEffect& effect,
                                   const FlightState& resting);

/// The rotors' commands [N] of the law for a thrust [N] and a pitch torque [N m] that the vehicle at rest should have
/// by what the law knows: allocated and, with a feed-forward, divided by what it reads. Linear in both.
void command_rotors_at_rest(const TickModel& model, LinearEffect& effect, const dynamics::PlantState<double>& at,
                            double thrust_n, double pitch_torque_nm, double (&command_n)[max_rotors]);

}  // namespace simulation
}  // namespace downwash
