#pragma once

#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/effects/surface_effect.hpp"

// The planar quadrotor of chapter 3 and its three controllers, flown by the same closed loop as everything else.

namespace downwash::studies {

/// Which rotors lie in front: one of four ("+"), or two of them ("x").
enum class RotorLayout { plus, cross };

/// The thesis gives neither masses nor sizes. **Choice**: a quadrotor of a common size.
struct PlanarVehicle {
    double mass_kg = 1.5;
    double pitch_inertia_kg_m2 = 0.02;
    double arm_m = 0.25;  ///< from the centre to each hub
    double radius_m = 0.12;
    RotorLayout layout = RotorLayout::plus;
};

/// The cascade of thesis 3.4.2, and what 3.4.3 and 3.4.4 add to it. The thesis gives no gains. **Choice**: those of a
/// well-damped loop, without integrators.
struct PlanarControl {
    double position_kp = 0.8;  ///< [1/s]
    double velocity_kp = 1.5;  ///< [1/s]
    double pitch_kp = 4;       ///< [1/s]
    double rate_kp = 8;        ///< [1/s]
    /// L of the disturbance observer [1/s].
    std::optional<double> observer_gain_1_s;
    /// Feed-forward through a map that lies this far off along x [m]; negative: its plate begins sooner.
    std::optional<double> map_offset_m;
};

/// A flight along x at constant height over a plate between two places; the ground elsewhere is out of reach.
struct PlanarExperiment {
    PlanarVehicle vehicle;
    PlanarControl control;
    SurfaceEffect ground;   ///< ground effect on each rotor
    double z_over_r = 2;    ///< height of the rotors over the plate
    bool has_plate = true;  ///< false: out of ground effect
    double plate_from_m = 3, plate_to_m = 5;
    double target_m = 7;          ///< the flight begins at x = 0
    double speed_m_s = 0.2;       ///< most that the position loop may ask for
    double gyro_noise_rad_s = 0;  ///< standard deviation of every tick
    double duration_s = 80;
};

/// What comes of it, at 100 Hz.
struct PlanarFlight {
    std::vector<double> time_s, x_m, z_m, pitch_deg;
    bool is_lost = false;  ///< it tilted beyond 60 degrees or left the plate's surroundings; the flight ends there

    /// From the last `seconds`: least and greatest x, and the greatest size of the pitch.
    struct Range {
        double least_x_m, greatest_x_m, greatest_pitch_deg;
    };
    [[nodiscard]] DOWNWASH_EXPORT Range over_last(double seconds) const;
};

[[nodiscard]] DOWNWASH_EXPORT PlanarFlight fly(const PlanarExperiment& experiment);

/// A ground model for every rotor by itself, as chapter 3's simulator has it: K over z/R, scaled with the share of the
/// disc over the plate. The multirotor models see the vehicle's other rotors.
[[nodiscard]] DOWNWASH_EXPORT SurfaceEffect effect_on_each_rotor(const SurfaceEffect& model,
                                                                 const PlanarVehicle& vehicle);

/// The pitch torque [N m] of the vehicle with a pitch over a wide plate at hover; positive: further nose down.
[[nodiscard]] DOWNWASH_EXPORT double torque_over_wide_plate(const PlanarExperiment& experiment, double pitch_rad);

}  // namespace downwash::studies
