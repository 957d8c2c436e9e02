#include "downwash/exports/setpoints.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"

namespace downwash {
namespace {

constexpr double max_setpoints = 1e6;
constexpr double max_rate_hz = 10000;

Vector3 in_world(const PlaneOfMotion& plane, const double vector[3]) {
    return {vector[plane::x] * plane.cos_heading(), vector[plane::x] * plane.sin_heading(), vector[plane::z]};
}

}  // namespace

std::vector<Setpoint> setpoints(const Plan& plan, const PlaneOfMotion& plane, double end_s, double rate_hz) {
    if (!(rate_hz > 0 && rate_hz <= max_rate_hz)) {
        throw_input_error("the rate is " + to_text(rate_hz) + " Hz: expected above 0 and at most 10000 Hz");
    }
    end_s = std::max(end_s, plan.duration_s());
    if (end_s * rate_hz > max_setpoints) {
        throw_input_error(to_text(end_s, 6) + " s at " + to_text(rate_hz) +
                          " Hz are more than a million set-points: lower the rate");
    }
    std::vector<double> times_s;
    constexpr double nearly = 1e-9;  // of a period: the end counts once
    for (std::int64_t i = 0; static_cast<double>(i) < end_s * rate_hz - nearly; ++i) {
        times_s.push_back(static_cast<double>(i) / rate_hz);
    }
    times_s.push_back(end_s);

    std::vector<Setpoint> points;
    points.reserve(times_s.size());
    for (const double t_s : times_s) {
        const ReferencePoint at = plan.at_time(t_s);
        points.push_back({t_s, plane.to_world(at.position[0], 0, at.position[1]), in_world(plane, at.velocity),
                          in_world(plane, at.acceleration), plane.heading_rad(), at.position[2], at.velocity[2],
                          at.acceleration[2]});
    }
    return points;
}

}  // namespace downwash
