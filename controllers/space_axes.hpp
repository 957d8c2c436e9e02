#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "downwash/controllers/axes.hpp"
#include "downwash/controllers/space_reference.hpp"

namespace downwash {

/// All axes that a vehicle in space can have, in the order of SpacePoint.
inline constexpr std::array<Axis, space_axes<max_joints>> all_space_axes{
    {{AxisGroup::translation, "x_m", "vx_m_s", "ax_m_s2"},
     {AxisGroup::translation, "y_m", "vy_m_s", "ay_m_s2"},
     {AxisGroup::translation, "z_m", "vz_m_s", "az_m_s2"},
     {AxisGroup::yaw, "yaw_rad", "yaw_rate_rad_s", "yaw_acceleration_rad_s2"},
     {AxisGroup::joint, "joint_1_rad", "joint_1_rate_rad_s", "joint_1_acceleration_rad_s2"},
     {AxisGroup::joint, "joint_2_rad", "joint_2_rate_rad_s", "joint_2_acceleration_rad_s2"},
     {AxisGroup::joint, "joint_3_rad", "joint_3_rate_rad_s", "joint_3_acceleration_rad_s2"},
     {AxisGroup::joint, "joint_4_rad", "joint_4_rate_rad_s", "joint_4_acceleration_rad_s2"},
     {AxisGroup::joint, "joint_5_rad", "joint_5_rate_rad_s", "joint_5_acceleration_rad_s2"},
     {AxisGroup::joint, "joint_6_rad", "joint_6_rate_rad_s", "joint_6_acceleration_rad_s2"}}};

/// The axes of a vehicle with so many joints. @param joints 0 to max_joints
[[nodiscard]] constexpr std::span<const Axis> axes_in_space(int joints) noexcept {
    return std::span(all_space_axes).first(static_cast<std::size_t>(space::first_joint + joints));
}

}  // namespace downwash
