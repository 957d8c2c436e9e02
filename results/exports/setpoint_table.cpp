#include "downwash/exports/setpoint_table.hpp"

#include <cstddef>

namespace downwash {
namespace {

/// The columns of a vector: a name for each of its coordinates.
void add_vector(std::vector<SetpointColumn>& columns, Vector3 Setpoint::*vector,
                const std::vector<std::string>& names) {
    for (std::size_t axis = 0; axis < names.size(); ++axis) {
        columns.push_back({names[axis], [=](Setpoint& point) -> double& { return (point.*vector)[axis]; }});
    }
}

void add_number(std::vector<SetpointColumn>& columns, double Setpoint::*number, std::string_view name) {
    columns.push_back({std::string(name), [=](Setpoint& point) -> double& { return point.*number; }});
}

std::vector<SetpointColumn> arm_columns(const std::vector<JointInWorld>& joints) {
    std::vector<SetpointColumn> columns;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const auto add = [&](std::string_view name, double JointSetpoint::*number) {
            columns.push_back({std::string(name), [=](Setpoint& point) -> double& { return point.joints[i].*number; }});
        };
        add(joints[i].axis.position, &JointSetpoint::angle_rad);
        add(joints[i].axis.velocity, &JointSetpoint::rate_rad_s);
        add(joints[i].axis.acceleration, &JointSetpoint::acceleration_rad_s2);
    }
    return columns;
}

}  // namespace

SetpointTable world_table(const std::vector<JointInWorld>& joints, bool turns) {
    SetpointTable table{.format = "csv",
                        .time = "t_s",
                        .has_yaw_rate = turns,
                        .has_yaw_acceleration = turns,
                        .arm = arm_columns(joints)};
    add_vector(table.vehicle, &Setpoint::position_m, {"x_m", "y_m", "z_m"});
    add_vector(table.vehicle, &Setpoint::velocity_m_s, {"vx_m_s", "vy_m_s", "vz_m_s"});
    add_vector(table.vehicle, &Setpoint::acceleration_m_s2, {"ax_m_s2", "ay_m_s2", "az_m_s2"});
    add_number(table.vehicle, &Setpoint::yaw_rad, "yaw_rad");
    if (turns) {
        add_number(table.vehicle, &Setpoint::yaw_rate_rad_s, "yaw_rate_rad_s");
        add_number(table.vehicle, &Setpoint::yaw_acceleration_rad_s2, "yaw_acceleration_rad_s2");
    }
    return table;
}

SetpointTable px4_table(const std::vector<JointInWorld>& joints) {
    SetpointTable table{.format = "px4-csv",
                        .frame = SetpointFrame::north_east_down,
                        .time = "timestamp",
                        .is_in_us = true,
                        .has_yaw_rate = true,
                        .arm = arm_columns(joints)};
    add_vector(table.vehicle, &Setpoint::position_m, {"position[0]", "position[1]", "position[2]"});
    add_vector(table.vehicle, &Setpoint::velocity_m_s, {"velocity[0]", "velocity[1]", "velocity[2]"});
    add_vector(table.vehicle, &Setpoint::acceleration_m_s2, {"acceleration[0]", "acceleration[1]", "acceleration[2]"});
    add_number(table.vehicle, &Setpoint::yaw_rad, "yaw");
    add_number(table.vehicle, &Setpoint::yaw_rate_rad_s, "yawspeed");
    add_vector(table.jerk, &Setpoint::jerk_m_s3, {"jerk[0]", "jerk[1]", "jerk[2]"});
    return table;
}

}  // namespace downwash
