#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace downwash {

/// What kind of coordinate an axis is.
enum class AxisGroup : std::uint8_t {
    translation,  ///< a coordinate of the multirotor's centre of mass [m]
    yaw,          ///< the angle about the vertical [rad]
    joint,        ///< an angle of the arm [rad]
};

/// One of the coordinates that a reference prescribes: how files and messages call it.
struct Axis {
    AxisGroup group;
    std::string_view position;      ///< the coordinate: "x_m"
    std::string_view velocity;      ///< its first time derivative: "vx_m_s"
    std::string_view acceleration;  ///< its second time derivative: "ax_m_s2"
};

/// The greatest number of axes of any vehicle.
inline constexpr std::size_t max_axes = 3;

/// The axes of a vehicle in its plane of motion, in the order of all arrays over axes.
inline constexpr std::array<Axis, 3> planar_axes{
    {{AxisGroup::translation, "x_m", "vx_m_s", "ax_m_s2"},
     {AxisGroup::translation, "z_m", "vz_m_s", "az_m_s2"},
     {AxisGroup::joint, "arm_rad", "arm_rate_rad_s", "arm_acceleration_rad_s2"}}};

/// Indices of the planar axes, for code that belongs to the plane of motion.
namespace plane {
inline constexpr std::size_t x = 0, z = 1, arm = 2;
}  // namespace plane

}  // namespace downwash
