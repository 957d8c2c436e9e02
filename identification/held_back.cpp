#include "downwash/identification/held_back.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "downwash/base/portable_math.hpp"
#include "downwash/base/quantile.hpp"
#include "downwash/simulation/noise.hpp"
#include "downwash/simulation/space_flight.hpp"
#include "downwash/simulation/space_world_parameters.hpp"

namespace downwash {
namespace {

/// The tick of a log that is the last one up to a time.
std::size_t tick_at(const LoggedFlight& flight, double t_s) {
    const auto after = std::ranges::upper_bound(flight.ticks, t_s, {}, &LoggedTick::t_s);
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - flight.ticks.begin() - 1, 0));
}

/// The reference of a log as a plan: knots a tenth of a second apart, with the rates that differences give.
SpacePlan plan_of(const LoggedFlight& flight, const SpaceRobot& robot) {
    constexpr double between_knots_s = 0.1;
    const double rate_hz = robot.controller.rate_hz;
    const auto ticks = std::max<std::int64_t>(1, std::llround(between_knots_s * rate_hz));
    const double step_s = static_cast<double>(ticks) / rate_hz;
    const double start_s = flight.ticks.front().t_s;
    const auto knots = static_cast<std::int64_t>((flight.ticks.back().t_s - start_s) / step_s);
    std::vector<SpacePoint> points;
    double turns_rad = 0;
    constexpr double whole_turn_rad = 6.283185307179586;
    for (std::int64_t k = 0; k <= knots; ++k) {
        const double t_s = start_s + static_cast<double>(k) * step_s;
        points.push_back(flight.ticks[tick_at(flight, t_s)].reference);
        double& yaw = points.back().position[space::yaw];
        if (k > 0) {  // logs have it between -pi and pi
            const double before = points[points.size() - 2].position[space::yaw];
            turns_rad += whole_turn_rad * std::round((before - yaw - turns_rad) / whole_turn_rad);
            yaw += turns_rad;
        }
    }
    SpacePlan plan;
    plan.tick_s = 1 / rate_hz;
    plan.joints = robot.joints();
    for (std::size_t k = 0; k < points.size(); ++k) {
        SpaceKnot knot{static_cast<std::int64_t>(k) * ticks, points[k]};
        if (k > 0 && k + 1 < points.size()) {
            for (int axis = 0; axis < space_axes<max_joints>; ++axis) {
                const auto at = [&](std::size_t i) { return points[std::min(i, points.size() - 1)].position[axis]; };
                // Of fourth order: what is wrong by 4 cm/s moves a vehicle by centimetres.
                const double far_before = at(k > 1 ? k - 2 : 0), before = at(k - 1), after = at(k + 1),
                             far_after = at(k + 2);
                knot.point.velocity[axis] = (8 * (after - before) - (far_after - far_before)) / (12 * step_s);
                knot.point.acceleration[axis] =
                    (16 * (after + before) - (far_after + far_before) - 30 * at(k)) / (12 * step_s * step_s);
            }
        }
        plan.reference.push_back(knot);
    }
    return plan;
}

SpaceMotion at_rest(const SpacePoint& reference) {
    SpaceMotion motion;
    std::copy_n(reference.position, 3, motion.position_m.begin());
    const double half_rad = 0.5 * reference.position[space::yaw];
    motion.attitude = {std::cos(half_rad), 0, 0, std::sin(half_rad)};
    std::copy_n(reference.position + space::first_joint, max_joints, motion.joints_rad.begin());
    return motion;
}

std::vector<Vector3> places_of(const SpaceFlight& flown) {
    std::vector<Vector3> places_m;
    for (const SpaceFlightRow& row : flown.rows) {
        places_m.push_back(row.motion.position_m);
    }
    return places_m;
}

/// Between which values one more of the same kind lies with 95 %, whatever their distribution: its rank among n others
/// is each of n + 1 with the same probability. @pre values are sorted; fewer than 39 hold less
std::pair<double, double> prediction_interval(const std::vector<double>& values) {
    constexpr double outside = 0.025;  // on each side
    const auto count = static_cast<double>(values.size());
    const double rank = std::max(0.0, outside * (count + 1) - 1);
    const double share = values.size() > 1 ? std::min(0.5, rank / (count - 1)) : 0.5;
    return {quantile_of_sorted(values, share), quantile_of_sorted(values, 1 - share)};
}

/// Places that the controller of a world sees: late, biased and noisy, as logs have them.
std::vector<Vector3> seen_places_of(const SpaceFlight& flown, const SpaceRobot& robot, const SpaceWorld& world) {
    const std::vector<Vector3> true_m = places_of(flown);
    const double delay_ticks = std::max(0.0, (robot.controller.delay_s + world.delay_s) * robot.controller.rate_hz);
    std::vector<Vector3> seen_m;
    std::uint64_t bits = world.tape;
    for (std::size_t tick = 0; tick < true_m.size(); ++tick) {
        const double then = std::max(0.0, static_cast<double>(tick) - delay_ticks);  // it hovered before
        const auto before = static_cast<std::size_t>(then);
        const double share = then - static_cast<double>(before);
        Vector3& place_m = seen_m.emplace_back(true_m[before]);
        if (share > 0) {
            place_m = (1 - share) * true_m[before] + share * true_m[before + 1];
        }
        place_m = place_m + world.position_bias_m;
        for (double& coordinate_m : place_m) {
            bits = simulation::mixed(bits);
            coordinate_m += world.position_noise_m * normal_quantile(simulation::quantile_of(bits));
        }
    }
    return seen_m;
}

}  // namespace

HeldBackCoverage held_back_coverage(const SpaceRobot& robot, const LoggedFlight& flight, const Uncertainty& air,
                                    int worlds, std::uint64_t seed) {
    const SpacePlan plan = plan_of(flight, robot);
    Uncertainty uncertainty = robot.uncertainty.value_or(Uncertainty{});
    for (const UncertaintyKey& key : space_uncertainty_keys()) {
        if (key.spread != nullptr && !key.is_of_robot) {
            uncertainty.*key.spread = air.*key.spread;
        }
    }
    HeldBackCoverage coverage;
    coverage.worlds = worlds;
    // Places as the log would have them in each world, tick after tick.
    std::vector<std::vector<Vector3>> seen_m;
    for (int i = 1; i <= worlds; ++i) {
        SpaceFlightSettings settings;
        settings.world = draw_space_world(uncertainty, robot, seed, static_cast<std::uint64_t>(i));
        settings.settles = true;
        settings.is_refined = false;
        const SpaceFlight flown = fly(robot, plan, at_rest(plan.reference.front().point), settings);
        if (flown.rejection != Rejection::none) {
            ++coverage.lost;
            continue;
        }
        seen_m.push_back(flight.is_true_motion ? places_of(flown) : seen_places_of(flown, robot, settings.world));
    }
    if (seen_m.empty()) {
        return coverage;
    }
    const std::size_t ticks = seen_m.front().size();
    for (std::size_t tick = 0; tick < ticks; ++tick) {
        const double t_s = flight.ticks.front().t_s + static_cast<double>(tick) * plan.tick_s;
        const Vector3& logged_m = flight.ticks[tick_at(flight, t_s)].seen.position_m;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::vector<double> values;
            values.reserve(seen_m.size());
            for (const std::vector<Vector3>& places_m : seen_m) {
                values.push_back(places_m[tick][axis]);
            }
            std::ranges::sort(values);
            const auto [low_m, high_m] = prediction_interval(values);
            const bool is_within = low_m <= logged_m[axis] && logged_m[axis] <= high_m;
            coverage.share_within[axis] += (is_within ? 1.0 : 0.0) / static_cast<double>(ticks);
            coverage.width_m[axis] += (high_m - low_m) / static_cast<double>(ticks);
        }
    }
    return coverage;
}

}  // namespace downwash
