#pragma once

// Private: not installed.

#include <functional>
#include <vector>

#include "downwash/exports/setpoint.hpp"

namespace downwash {

/// A plan in the world.
struct WayInWorld {
    std::vector<Setpoint> knots;  ///< without their jerks
    std::function<Setpoint(double t_s)> at;
    double tick_s = 0;
    double end_s = 0;  ///< of the hover at the last goal

    [[nodiscard]] double duration_s() const { return knots.back().t_s; }
};

/// The jerk of the quintics between knots; where two meet, that of the later one, and none after the last.
/// @pre there is a knot
[[nodiscard]] Vector3 jerk_m_s3(const std::vector<Setpoint>& knots, double t_s);

/// The way of a plan, which ends with its reference.
/// @param plan outlives what is returned   @param setpoint makes one of a time and a point of the reference
template <class AnyPlan, class ToSetpoint>
[[nodiscard]] WayInWorld way_of(const AnyPlan& plan, const ToSetpoint& setpoint) {
    WayInWorld way;
    for (const auto& knot : plan.reference) {
        way.knots.push_back(setpoint(static_cast<double>(knot.tick) * plan.tick_s, knot.point));
    }
    way.at = [&plan, setpoint, knots = way.knots](double t_s) {
        Setpoint point = setpoint(t_s, plan.at_time(t_s));
        point.jerk_m_s3 = jerk_m_s3(knots, t_s);
        return point;
    };
    way.tick_s = plan.tick_s;
    way.end_s = plan.duration_s();
    return way;
}

}  // namespace downwash
