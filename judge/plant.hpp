#pragma once

#include <array>

#include "downwash/judge/equations_of_motion.hpp"
#include "downwash/judge/surroundings.hpp"
#include "downwash/judge/touching.hpp"

// The plant over time, integrated by Boost.Odeint. Private: not installed.

namespace downwash::judge {

/// What is held over one control tick: free-air thrust of each rotor and the joint torque.
struct Command {
    std::array<double, max_rotors> thrust_n{};
    double joint_torque_nm = 0;
};

/// The state of the plant.
struct PlantState {
    Motion motion;
    std::array<double, max_rotors> thrust_n{};  ///< free-air thrust that the rotors' lag has reached
    double energy_j = 0;                        ///< spent by rotors and joint
    double contact_n = 0;                       ///< normal force of a surface, mean over the last step
};

/// A vehicle among surfaces in moving air.
class Plant {
 public:
    /// @param touched a surface that the robot touches; nullptr: none
    Plant(const Vehicle& vehicle, const Surroundings& surroundings, const TouchSurface* touched = nullptr)
        : vehicle_(vehicle), surroundings_(surroundings), touched_(touched) {}

    [[nodiscard]] const Vehicle& vehicle() const noexcept { return vehicle_; }

    /// The accelerations under rotor thrusts (free air, nominal coefficient) [N] and a joint torque [N m].
    /// @param[out] contact_n normal force of the surface, if asked for
    /// @param near the effect of surfaces near this motion, where it is known
    [[nodiscard]] DOWNWASH_EXPORT Acceleration acceleration(const Motion& motion,
                                                            const std::array<double, max_rotors>& thrust_n,
                                                            double joint_torque_nm, Planar wind_m_s,
                                                            double* contact_n = nullptr,
                                                            const Surroundings::Tangents& near = {}) const;

    /// The state after `duration_s` with the command held and a steady wind: Dormand and Prince's method of fifth order
    /// with steps controlled to 1e-8 (relative and absolute, SI units), restarted here.
    [[nodiscard]] DOWNWASH_EXPORT PlantState after(const PlantState& state, const Command& command, Planar wind_m_s,
                                                   double duration_s) const;

 private:
    const Vehicle& vehicle_;
    const Surroundings& surroundings_;
    const TouchSurface* touched_;
};

/// Power of rotors with these free-air thrusts [W] (docs/model.md 3).
[[nodiscard]] double rotor_power_w(const Vehicle& vehicle, const std::array<double, max_rotors>& thrust_n);

}  // namespace downwash::judge
