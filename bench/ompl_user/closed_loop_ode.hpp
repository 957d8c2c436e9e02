#pragma once

#include <vector>

#include "downwash/simulation/flight_model.hpp"

namespace downwash::bench {

/// The closed loop as a user of OMPL's ODESolver writes it down: one right-hand side with plant and controller,
/// matrices by Eigen, an LDLT solve in every stage. Equations, gains and limits are those of our tick (docs/model.md 2,
/// 3, 5); the controller runs in continuous time, and the reference moves at the velocity that is the control.
class ClosedLoopOde {
 public:
    /// What a state consists of; SI units.
    enum Index : std::size_t {
        x,
        z,
        pitch,
        arm,
        vx,
        vz,
        pitch_rate,
        arm_rate,
        integral_x,
        integral_z,
        integral_pitch_rate,
        integral_arm,
        filtered_pitch_reference,
        reference_x,
        reference_z,
        reference_arm,
        energy,
        size
    };

    /// @param map surface effects; nullptr for none. Both outlive this object.
    /// @param world differences of the plant from the nominal one: masses, inertias, centre of mass, thrust
    /// of all rotors and of each, K - 1 (its change below surfaces, for the whole map), place of the scene. Lag, delay,
    /// drag with its wind, bias and noise are unknown to this model. nullptr: nothing; it outlives this object
    ClosedLoopOde(const FlightModel& model, const AeroMap* map, const FlownWorld* world = nullptr)
        : model_(model), map_(map), world_(world) {}

    /// The time derivative of a state.
    /// @param velocity of the reference, (x, z, arm)   @param rates resized to the state
    void operator()(const std::vector<double>& state, const double velocity[3], std::vector<double>& rates) const {
        rates.resize(size);
        (*this)(state.data(), velocity, rates.data());
    }
    void operator()(const double* state, const double velocity[3], double* rates) const;

    /// A state after a hover of so many seconds, no energy spent: classical Runge-Kutta steps of 10 ms.
    [[nodiscard]] std::vector<double> hovered(std::vector<double> state, double seconds) const;

    /// Level and at rest at a configuration, the reference with it.
    [[nodiscard]] static std::vector<double> resting_at(double x_m, double z_m, double arm_rad);

 private:
    /// K at a hub in the plane.
    [[nodiscard]] double factor_at(int rotor, double x_m, double z_m, double pitch_rad) const;

    const FlightModel& model_;
    const AeroMap* map_;
    const FlownWorld* world_;
};

}  // namespace downwash::bench
