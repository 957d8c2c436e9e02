#include <algorithm>
#include <string_view>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/exports/formats.hpp"

namespace downwash {
namespace {

void append(std::string& row, std::initializer_list<double> numbers) {
    for (const double number : numbers) {
        row += (row.empty() ? "" : ",") + to_text(number);
    }
}

void append(std::string& row, const Vector3& vector) {
    append(row, {vector[0], vector[1], vector[2]});
}

}  // namespace

const WayInWorld& plan_to_be_flown(const RunInWorld& run) {
    if (!run.plan) {
        throw_input_error("this run found no plan, so there is nothing to fly");
    }
    if (run.has_touch) {
        throw_input_error(
            "the flight has a touch (goal.contact), which follows the measured force: set-points and missions "
            "cannot say that. The formats vtp and glb have the whole flight");
    }
    return *run.plan;
}

std::vector<Setpoint> setpoints_of(const RunInWorld& run, const ExportSettings& settings) {
    const WayInWorld& plan = plan_to_be_flown(run);
    return setpoints(plan.at, std::max(plan.end_s, plan.duration_s()), settings.rate_hz.value_or(run.rate_hz));
}

std::string setpoint_csv(const RunInWorld& run, const ExportSettings& settings) {
    std::string text = "t_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,ax_m_s2,ay_m_s2,az_m_s2,yaw_rad";
    if (run.turns) {
        text += ",yaw_rate_rad_s,yaw_acceleration_rad_s2";
    }
    for (const JointInWorld& joint : run.joints) {
        for (const std::string_view name : {joint.axis.position, joint.axis.velocity, joint.axis.acceleration}) {
            (text += ',') += name;
        }
    }
    text += '\n';
    for (const Setpoint& point : setpoints_of(run, settings)) {
        std::string row;
        append(row, {point.t_s});
        append(row, point.position_m);
        append(row, point.velocity_m_s);
        append(row, point.acceleration_m_s2);
        append(row, {point.yaw_rad});
        if (run.turns) {
            append(row, {point.yaw_rate_rad_s, point.yaw_acceleration_rad_s2});
        }
        for (const JointSetpoint& joint : point.joints) {
            append(row, {joint.angle_rad, joint.rate_rad_s, joint.acceleration_rad_s2});
        }
        text += row + '\n';
    }
    return text;
}

}  // namespace downwash
