#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/dynamics/ceiling_contact.hpp"
#include "downwash/dynamics/space_plant.hpp"
#include "downwash/dynamics/space_surroundings.hpp"

// A quadrotor in space under a wide ceiling that it may touch: the flights of thesis 4.7.

namespace downwash::studies {

/// Who commands the thrust. Roll, pitch and yaw are the Lyapunov laws' in both.
enum class AltitudeLaw : std::uint8_t {
    lyapunov,          ///< (4.30) with the ceiling factor K_c of the height that it sees
    lyapunov_unaware,  ///< the Lyapunov law with K_c = 1
    pid,               ///< height to climb rate to acceleration, with an integral
};

/// The thesis gives neither mass nor inertia nor gains. **Choice**: a quadrotor of the size of its platform.
struct CeilingVehicle {
    double mass_kg = 1.5;
    double rotor_height_m = 0.01;  ///< height of the hubs over the centre of mass
    double arm_m = 0.24;           ///< 480 mm between opposite axes (thesis 4.3)
    double radius_m = 0.1194;      ///< radius of the rotor in the fit (2.18)
    double guard_m = 0.04;         ///< how far the frame reaches above the rotors (thesis 4.4)
};

/// Gains of the altitude PID. **Choice**: no thesis numbers; as quick in free air as the Lyapunov law.
struct AltitudePid {
    double height_kp = 2;  ///< [1/s]
    double climb_kp = 4;   ///< [1/s]
    double climb_ki = 1;   ///< [1/s2]
    double integral_limit_m_s2 = 6;
};

/// A flight: climb to the ceiling, press against it, leave.
struct CeilingExperiment {
    CeilingVehicle vehicle;
    AltitudeLaw law = AltitudeLaw::lyapunov;
    AltitudePid pid;
    double gain_scale = 1;   ///< factor of the law's gains of height
    double start_m = -0.6;   ///< height of the frame from the ceiling, negative
    double press_m = 0.02;   ///< how far above the ceiling the reference goes
    double speed_m_s = 0.3;  ///< speed of the reference
    double contact_s = 10;   ///< from the reference's arrival to its leaving
    double leave_to_m = -0.4;
    double after_s = 10;        ///< duration of the flight once the reference leaves
    double sample_s = 0;        ///< between two measurements of the height; 0: every tick
    double height_noise_m = 0;  ///< standard deviation of each
    double height_bias_m = 0;   ///< added to the height that K_c is taken at
};

/// What comes of it, at 100 Hz. Heights are those of the frame below the ceiling.
struct CeilingFlight {
    std::vector<double> time_s, height_m, reference_m, climb_m_s, reference_climb_m_s, command_over_weight,
        ceiling_factor;
    double leaves_s = 0;     ///< when the reference begins to leave
    double max_depth_m = 0;  ///< depth of the frame in the ceiling

    /// How much later than the reference the frame passes 5 cm below the ceiling on its way down [s]; empty: never.
    [[nodiscard]] DOWNWASH_EXPORT std::optional<double> delay_s() const;
    /// How far the frame falls below where the reference ends [m].
    [[nodiscard]] DOWNWASH_EXPORT double overshoot_m(double leave_to_m) const;
    /// The mean of command_over_weight over the last three seconds of contact.
    [[nodiscard]] DOWNWASH_EXPORT double command_in_contact() const;
};

[[nodiscard]] DOWNWASH_EXPORT CeilingFlight fly(const CeilingExperiment& experiment);

/// The vehicle as a plant in space.
[[nodiscard]] DOWNWASH_EXPORT SpacePlant plant_of(const CeilingVehicle& vehicle);

/// Its frame: four points over the rotors touch.
[[nodiscard]] DOWNWASH_EXPORT dynamics::CeilingContact frame_of(const CeilingVehicle& vehicle);

/// K of (2.18) with the rotors `distance_m` below the ceiling.
[[nodiscard]] DOWNWASH_EXPORT double ceiling_factor_at(const CeilingVehicle& vehicle, double distance_m);

/// The surroundings in space of a vehicle under a wide ceiling at z = 0.
struct UnderWideCeiling : dynamics::CalmSpace {
    explicit UnderWideCeiling(const CeilingVehicle& the_vehicle = {}) : vehicle(the_vehicle) {}
    CeilingVehicle vehicle;
    [[nodiscard]] double thrust_ratio(int /*rotor*/, const dynamics::LaneVector<double>& hub_m,
                                      const dynamics::LaneVector<double>& /*axis*/) const {
        return ceiling_factor_at(vehicle, -hub_m.z);
    }
};

}  // namespace downwash::studies
