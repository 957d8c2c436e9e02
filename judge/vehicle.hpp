#pragma once

#include <array>

#include "downwash/base/export.hpp"
#include "downwash/dynamics/plant.hpp"
#include "downwash/simulation/robot.hpp"
#include "downwash/simulation/world.hpp"

// The numbers of a vehicle as the judge's plant and its controller need them. Private: not installed.

namespace downwash::judge {

/// A vector in the plane of motion [m], or a force in it [N]; components along x and z.
struct Planar {
    double x = 0, z = 0;

    friend Planar operator+(Planar a, Planar b) noexcept { return {a.x + b.x, a.z + b.z}; }
    friend Planar operator-(Planar a, Planar b) noexcept { return {a.x - b.x, a.z - b.z}; }
    friend Planar operator*(double s, Planar a) noexcept { return {s * a.x, s * a.z}; }
};

/// The component of r x F along +y, positive nose down: the moment of a force F at the lever r [N m].
[[nodiscard]] inline double moment_of(Planar lever, Planar force) noexcept {
    return lever.z * force.x - lever.x * force.z;
}
/// The velocity of a point at r in a body that turns about +y with the rate w: w x r.
[[nodiscard]] inline Planar turned(double rate_rad_s, Planar r) noexcept {
    return {rate_rad_s * r.z, -rate_rad_s * r.x};
}
/// A vector of the body frame in the plane, at a pitch (docs/model.md 1).
[[nodiscard]] DOWNWASH_EXPORT Planar from_body(Planar body, double pitch_rad) noexcept;
/// The direction of the arm: (cos a, -sin a) with a = pitch + arm.
[[nodiscard]] DOWNWASH_EXPORT Planar arm_direction(double pitch_rad, double arm_rad) noexcept;

/// Two bodies, a joint and rotors. Points are in the body frame, from the centre of mass of the multirotor.
struct Vehicle {
    double body_mass_kg, body_inertia_kg_m2;
    double arm_mass_kg, arm_inertia_kg_m2;
    Planar joint_m;
    double arm_center_of_mass_m, arm_length_m;
    Planar center_of_mass_m;  ///< the true one, from the point that the robot file calls so

    int rotor_count;
    std::array<Planar, max_rotors> hub_m;
    std::array<double, max_rotors> hub_lateral_m;  ///< to the left of the plane of motion
    double rotor_radius_m;
    Planar hub_center_m;                       ///< mean of the hubs
    std::array<double, max_rotors> thrust_of;  ///< thrust over that of the nominal coefficient
    double rotor_time_constant_s;              ///< 0: no lag
    double power_coefficient_w_n1p5;
    DragParameters body_drag, arm_drag;
    double wash_scale;  ///< speed of the slipstreams over that of momentum theory; 0: none meets the arm

    [[nodiscard]] double mass_kg() const noexcept { return body_mass_kg + arm_mass_kg; }
};

/// The vehicle that flies in a world; that of the robot file in the nominal one.
/// @pre robot_errors(robot) is empty
[[nodiscard]] DOWNWASH_EXPORT Vehicle vehicle_in(const World& world, const Robot& robot);

}  // namespace downwash::judge
