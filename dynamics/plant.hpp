#pragma once

#include <optional>
#include <vector>

#include "downwash/base/vector3.hpp"

namespace downwash {

/// Most rotors a multirotor may have; lag states are stored in place.
inline constexpr int max_rotors = 8;

/// Air drag D(v) = (linear + quadratic |v|) v against the speed v through the air (docs/model.md 2.1); zeros: none.
struct DragParameters {
    double linear_n_s_m = 0;       ///< >= 0, of the rotors above all
    double quadratic_n_s2_m2 = 0;  ///< >= 0, rho cd A / 2
    /// Whether there is any.
    [[nodiscard]] bool is_any() const noexcept { return linear_n_s_m > 0 || quadratic_n_s2_m2 > 0; }
};

/// The rotors' slipstreams on the arm (docs/model.md 2.7). They act through the arm's drag.
struct WashParameters {
    double scale = 1;  ///< speed of the slipstreams over that of momentum theory, >= 0

    friend constexpr bool operator==(const WashParameters&, const WashParameters&) = default;
};

/// The multirotor's rigid body A (thesis C.1).
struct MultirotorParameters {
    double mass_kg = 0;              ///< > 0, rotors and battery included, arm excluded
    double pitch_inertia_kg_m2 = 0;  ///< about +y through its centre of mass, > 0
    DragParameters drag = {};        ///< acts at its centre of mass, the same in every direction
};

/// The arm B with its end effector, one rigid body that turns about a joint fixed to the multirotor (thesis C.1).
struct ArmParameters {
    double joint_x_m = 0;  ///< joint in the body frame, from the multirotor's centre of mass
    double joint_z_m = 0;
    double length_m = 0;          ///< joint to end effector, > 0
    double mass_kg = 0;           ///< > 0
    double center_of_mass_m = 0;  ///< distance of its centre of mass from the joint, in [0, length]
    double inertia_kg_m2 = 0;     ///< about its own centre of mass, > 0
    double radius_m = 0;          ///< radius of the capsule that encloses the arm, > 0
    bool is_limited = false;      ///< without limits the arm turns through 360 degrees
    double lower_limit_rad = 0;   ///< smallest angle relative to the multirotor, when limited
    double upper_limit_rad = 0;
    double max_torque_nm = 0;                 ///< largest torque of the joint, > 0
    DragParameters drag = {};                 ///< drag of the whole arm in a stream across it; one along it has none
    std::optional<WashParameters> wash = {};  ///< empty: rotors blow past the arm
};

/// Rotors that spin in the body's b1-b2 plane. A command is the free-air thrust of one rotor (a PWM level).
struct RotorParameters {
    double radius_m = 0;                  ///< > 0
    std::vector<Vector3> positions_m;     ///< hub positions in the body frame, 2 to max_rotors of them
    double min_thrust_n = 0;              ///< least command, >= 0
    double max_thrust_n = 0;              ///< greatest command, > min
    double time_constant_s = 0;           ///< time constant of the first-order thrust lag; 0 switches the lag off
    double power_coefficient_w_n1p5 = 0;  ///< P = coefficient * thrust^1.5 (docs/model.md 3), > 0
};

}  // namespace downwash
