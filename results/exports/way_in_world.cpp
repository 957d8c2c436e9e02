#include "downwash/exports/way_in_world.hpp"

#include <algorithm>
#include <cstddef>

#include "downwash/controllers/quintic.hpp"

namespace downwash {
namespace {

/// The jerk at a share s of the quintic between two knots.
Vector3 jerk_between(const Setpoint& from, const Setpoint& to, double s) {
    const double duration_s = to.t_s - from.t_s;
    Vector3 jerk_m_s3;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double c[6];
        controllers::quintic_between<double>(
            {from.position_m[axis], from.velocity_m_s[axis], from.acceleration_m_s2[axis]},
            {to.position_m[axis], to.velocity_m_s[axis], to.acceleration_m_s2[axis]}, duration_s, c);
        jerk_m_s3[axis] = (6 * c[3] + s * (24 * c[4] + s * 60 * c[5])) / (duration_s * duration_s * duration_s);
    }
    return jerk_m_s3;
}

}  // namespace

Vector3 jerk_m_s3(const std::vector<Setpoint>& knots, double t_s) {
    const auto next = std::upper_bound(knots.begin() + 1, knots.end(), t_s,
                                       [](double at, const Setpoint& knot) { return at < knot.t_s; });
    if (next == knots.end()) {
        return {};
    }
    const Setpoint& from = *(next - 1);
    return jerk_between(from, *next, (t_s - from.t_s) / (next->t_s - from.t_s));
}

}  // namespace downwash
