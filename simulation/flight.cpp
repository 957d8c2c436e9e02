#include "downwash/simulation/flight.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/simulation/between_ticks.hpp"
#include "downwash/simulation/flight_loop.hpp"
#include "downwash/simulation/map_effect.hpp"
#include "downwash/simulation/rule_checks.hpp"
#include "downwash/simulation/vehicle_effect.hpp"

namespace downwash {
namespace {

using Given = controllers::Actuation<double>;

constexpr std::int64_t ticks_between_looks = 4096;

/// The rules, cheapest first.
Rejection broken_rule(const FlightModel& model, const AeroMap* map, const FlightRules& rules,
                      const simulation::RuleLimits& limits, const FlownWorld* world, const Given& given,
                      const FlightState& before, const FlightState& state, const ReferencePoint& reference) {
    const double broken = simulation::broken_rule(limits, given.saturation, state, reference);
    if (broken > 0) {
        return static_cast<Rejection>(static_cast<int>(broken));
    }
    const PlanarPose pose = among_obstacles(pose_of(state), world);
    if (map != nullptr && !is_flyable(model, *map, pose)) {
        return Rejection::flyable_area;
    }
    if (model.collisions().is_nearer_than(pose, rules.margin_m) ||
        simulation::comes_nearer_between(model, among_obstacles(pose_of(before), world), pose, rules.margin_m)) {
        return Rejection::collision;
    }
    return Rejection::none;
}

SegmentFlight fly_with(const FlightModel& model, const AeroMap* map, const FlightRules& rules,
                       const ReferenceSegment& segment, FlightState& state, const FlightWorld& in,
                       simulation::FlightEffect& effect) {
    const simulation::RuleLimits limits = simulation::rule_limits(rules, model.robot().arm);
    const FlownWorld* const world = flown_world(model, in.world);
    SegmentFlight flight;
    const auto after = [&](const FlightState& before, const ReferencePoint&, const Given& given,
                           const FlightState& next, const ReferencePoint& next_reference) {
        ++flight.ticks;
        if (flight.ticks % ticks_between_looks == 0 && rules.is_over && rules.is_over()) {
            return Rejection::interrupted;
        }
        simulation::add_tick(flight, model.tick().plant, before, next);
        const Rejection rejection = broken_rule(model, map, rules, limits, world, given, before, next, next_reference);
        if (rules.measures_clearance || rules.finds_min_clearance) {
            const double clearance_m = model.collisions().clearance_m(among_obstacles(pose_of(next), world));
            flight.min_clearance_m = std::min(flight.min_clearance_m, clearance_m);
            if (rejection == Rejection::none && rules.measures_clearance) {
                flight.clearance_integral += model.tick().tick_s * clearance_density(clearance_m);
            }
        }
        return rejection;
    };
    flight.rejection = simulation::FlightLoop(model.tick(), world, effect).fly(in.first_tick, segment, state, after);
    return flight;
}

}  // namespace

double tracking_error_m(const FlightState& state, const ReferencePoint& reference) {
    return simulation::tracking_error(state, reference);
}

bool is_stable(const FlightState& state, const ReferencePoint& reference) {
    return !(simulation::instability(state, tracking_error_m(state, reference)) > 0);
}

SegmentFlight fly(const FlightModel& model, const AeroMap* map, const FlightRules& rules,
                  const ReferenceSegment& segment, FlightState& state, const FlightWorld& in) {
    if (map == nullptr) {
        simulation::FlightEffectOf effect{simulation::NoEffect{}};
        return fly_with(model, map, rules, segment, state, in, effect);
    }
    const simulation::RotorMaps maps = simulation::rotor_maps(model, *map);
    simulation::FlightEffectOf effect{simulation::MapEffect<double>(maps)};
    return fly_with(model, map, rules, segment, state, in, effect);
}

}  // namespace downwash
