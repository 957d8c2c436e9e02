#include "downwash/exports/setpoints.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/exports/way_in_world.hpp"

namespace downwash {
namespace {

constexpr double max_setpoints = 1e6;
constexpr double max_rate_hz = 10000;

}  // namespace

std::vector<Setpoint> setpoints(const std::function<Setpoint(double t_s)>& at, double end_s, double rate_hz) {
    if (!(rate_hz > 0 && rate_hz <= max_rate_hz)) {
        throw_input_error("the rate is " + to_text(rate_hz) + " Hz: expected above 0 and at most 10000 Hz");
    }
    if (end_s * rate_hz > max_setpoints) {
        throw_input_error(to_text(end_s, 6) + " s at " + to_text(rate_hz) +
                          " Hz are more than a million set-points: lower the rate");
    }
    std::vector<Setpoint> points;
    constexpr double nearly = 1e-9;  // of a period: the end counts once
    for (std::int64_t i = 0; static_cast<double>(i) < end_s * rate_hz - nearly; ++i) {
        points.push_back(at(static_cast<double>(i) / rate_hz));
    }
    points.push_back(at(end_s));
    return points;
}

std::vector<Setpoint> setpoints(const Plan& plan, const PlaneOfMotion& plane, double end_s, double rate_hz) {
    const WayInWorld way =
        way_of(plan, [&](double t_s, const ReferencePoint& point) { return setpoint_of(t_s, point, plane); });
    return setpoints(way.at, std::max(end_s, way.end_s), rate_hz);
}

std::vector<Setpoint> setpoints(const SpacePlan& plan, double end_s, double rate_hz) {
    const WayInWorld way =
        way_of(plan, [&](double t_s, const SpacePoint& point) { return setpoint_of(t_s, point, plan.joints); });
    return setpoints(way.at, std::max(end_s, way.end_s), rate_hz);
}

}  // namespace downwash
