
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

const Plan& plan_to_be_flown(const RunRecord& run) {
    if (!run.plan) {
        throw_input_error("this run found no plan, so there is nothing to fly");
    }
    if (asks_for_contact(run.problem.goal)) {
        throw_input_error(
            "the flight ends with a touch (goal.contact), which follows the measured force: set-points and missions "
            "cannot say that. The formats vtp and glb have the whole flight");
    }
    return *run.plan;
}

double end_of_hover_s(const RunRecord& run) {
    const double plan_s = run.plan->duration_s();
    const double end_s = run.flight.rows() > 0 ? run.flight.find("t_s")->back() : 0;
    return end_s > plan_s ? end_s : plan_s + in_order(run.problem, run.order).goal.hold_s;
}

std::vector<Setpoint> setpoints_of(const RunRecord& run, const ExportSettings& settings) {
    const Plan& plan = plan_to_be_flown(run);
    return setpoints(plan, run.problem.plane, end_of_hover_s(run),
                     settings.rate_hz.value_or(run.problem.robot.controller.rate_hz));
}

std::string setpoint_csv(const RunRecord& run, const ExportSettings& settings) {
    std::string text =
        "t_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,ax_m_s2,ay_m_s2,az_m_s2,yaw_rad,arm_rad,arm_rate_rad_s,"
        "arm_acceleration_rad_s2\n";
    for (const Setpoint& point : setpoints_of(run, settings)) {
        std::string row;
        append(row, {point.t_s});
        append(row, point.position_m);
        append(row, point.velocity_m_s);
        append(row, point.acceleration_m_s2);
        append(row, {point.yaw_rad, point.arm_rad, point.arm_rate_rad_s, point.arm_acceleration_rad_s2});
        text += row + '\n';
    }
    return text;
}

}  // namespace downwash
