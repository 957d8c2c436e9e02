#include "downwash/controllers/yaw_mode.hpp"

#include <cassert>
#include <cstddef>

#include "downwash/base/lane_math.hpp"
#include "downwash/controllers/quintic.hpp"

namespace downwash {
namespace {

using YawPoint = controllers::QuinticPoint<double>;

/// Below this [m or m/s] nothing has a direction.
constexpr double no_distance = 1e-3;

YawPoint yaw_of(const SpacePoint& point) {
    return {point.position[space::yaw], point.velocity[space::yaw], point.acceleration[space::yaw]};
}

void set_yaw(SpacePoint& point, const YawPoint& yaw) {
    point.position[space::yaw] = yaw.position;
    point.velocity[space::yaw] = yaw.velocity;
    point.acceleration[space::yaw] = yaw.acceleration;
}

/// The angle that differs from one by whole turns and is nearest to another.
double nearest_to(double angle_rad, double other_rad) {
    return other_rad + lane::wrap_angle(angle_rad - other_rad);
}

/// The direction of (x, y) where it has one.
/// @param d (x, y) with its first and second derivative: d[0], d[1], d[2]
std::optional<YawPoint> direction_of(const double (&d)[3][2]) {
    const double square = d[0][0] * d[0][0] + d[0][1] * d[0][1];
    if (!(square > no_distance * no_distance)) {
        return {};
    }
    const auto across = [&](int i) { return (d[0][0] * d[i][1] - d[0][1] * d[i][0]) / square; };
    const double rate = across(1);
    const double along = (d[0][0] * d[1][0] + d[0][1] * d[1][1]) / square;
    return YawPoint{lane::atan2(d[0][1], d[0][0]), rate, across(2) - 2 * rate * along};
}

/// The direction from one point to another where it has one, at rest.
std::optional<YawPoint> direction_between(const SpacePoint& from, const SpacePoint& to) {
    return direction_of({{to.position[0] - from.position[0], to.position[1] - from.position[1]}, {}, {}});
}

/// Where a vehicle that looks along its way looks at a knot.
std::optional<YawPoint> yaw_along(const SpacePoint& before, const SpacePoint& here) {
    const auto yaw =
        direction_of({{here.velocity[0], here.velocity[1]}, {here.acceleration[0], here.acceleration[1]}, {}});
    return yaw ? YawPoint{yaw->position, yaw->velocity, 0} : direction_between(before, here);
}

std::optional<YawPoint> yaw_toward(const std::array<double, 2>& target_m, const SpacePoint& here) {
    return direction_of({{target_m[0] - here.position[0], target_m[1] - here.position[1]},
                         {-here.velocity[0], -here.velocity[1]},
                         {-here.acceleration[0], -here.acceleration[1]}});
}

/// Turns from one knot to another, of which the yaw is known already, by one quintic; knots between lie on it.
void turn_between(std::span<SpaceKnot> knots, double tick_s) {
    const double inverse_duration_1_s = 1 / (static_cast<double>(knots.back().tick - knots.front().tick) * tick_s);
    double c[6];
    controllers::quintic_between(yaw_of(knots.front().point), yaw_of(knots.back().point), 1 / inverse_duration_1_s, c);
    for (SpaceKnot& knot : knots.subspan(1, knots.size() - 2)) {
        const double s = static_cast<double>(knot.tick - knots.front().tick) * tick_s * inverse_duration_1_s;
        set_yaw(knot.point, controllers::quintic_at(c, s, inverse_duration_1_s));
    }
}

}  // namespace

std::vector<SpaceKnot> with_yaw(std::vector<SpaceKnot> knots, double tick_s, const YawRule& rule,
                                std::span<const std::optional<double>> asked) {
    assert(asked.empty() || asked.size() == knots.size());
    std::size_t last_known = 0;  // `free`: the last knot of which the yaw is the first's, or asked
    for (std::size_t i = 1; i < knots.size(); ++i) {
        const bool is_free = rule.mode == YawMode::free;
        const SpacePoint& before = knots[is_free ? last_known : i - 1].point;
        SpacePoint& here = knots[i].point;
        const double yaw_before_rad = before.position[space::yaw];
        const std::optional<double> goal_rad = asked.empty() ? std::nullopt : asked[i];
        YawPoint yaw{yaw_before_rad, 0, 0};
        if (goal_rad) {
            yaw.position = nearest_to(*goal_rad, yaw_before_rad);
        } else if (rule.mode == YawMode::along || rule.mode == YawMode::toward) {
            const auto wanted = rule.mode == YawMode::along ? yaw_along(before, here) : yaw_toward(rule.target_m, here);
            if (wanted) {
                yaw = *wanted;
                yaw.position = nearest_to(yaw.position, yaw_before_rad);
            }
        }
        set_yaw(here, yaw);
        if (is_free && goal_rad) {
            turn_between(std::span(knots).subspan(last_known, i - last_known + 1), tick_s);
            last_known = i;
        }
    }
    return knots;
}

}  // namespace downwash
