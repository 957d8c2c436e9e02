#include <algorithm>
#include <cmath>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/exports/formats.hpp"
#include "downwash/exports/setpoint_table.hpp"

namespace downwash {
namespace {

std::string text_of(const SetpointTable& table, std::vector<Setpoint> points) {
    std::vector<SetpointColumn> columns = table.vehicle;
    columns.insert(columns.end(), table.jerk.begin(), table.jerk.end());
    columns.insert(columns.end(), table.arm.begin(), table.arm.end());
    std::string text(table.time);
    for (const SetpointColumn& column : columns) {
        (text += ',') += column.name;
    }
    text += '\n';
    for (Setpoint& point : points) {
        text += table.is_in_us ? std::to_string(whole_us(point.t_s)) : to_text(point.t_s);
        for (const SetpointColumn& column : columns) {
            (text += ',') += to_text(column.number(point));
        }
        text += '\n';
    }
    return text;
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

std::int64_t whole_us(double t_s) {
    constexpr double second_us = 1e6;
    return std::llround(t_s * second_us);
}

std::vector<Setpoint> setpoints_of(const RunInWorld& run, const ExportSettings& settings, SetpointFrame frame) {
    const WayInWorld& plan = plan_to_be_flown(run);
    const SetpointAxes axes(frame, settings.bearing_deg);
    const auto at = [&](double t_s) { return axes.of(plan.at(t_s)); };
    return setpoints(at, std::max(plan.end_s, plan.duration_s()), settings.rate_hz.value_or(run.rate_hz));
}

std::string setpoint_csv(const RunInWorld& run, const ExportSettings& settings) {
    return text_of(world_table(run.joints, run.turns), setpoints_of(run, settings, SetpointFrame::world));
}

std::string px4_csv(const RunInWorld& run, const ExportSettings& settings) {
    return text_of(px4_table(run.joints), setpoints_of(run, settings, SetpointFrame::north_east_down));
}

}  // namespace downwash
