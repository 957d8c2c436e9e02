#include "downwash/simulation/flight.hpp"

#include <cmath>

#include "downwash/simulation/between_ticks.hpp"
#include "downwash/simulation/flight_loop.hpp"
#include "downwash/simulation/flight_rules.hpp"

namespace downwash {
namespace {

using Given = controllers::Actuation<double>;

constexpr std::int64_t ticks_between_questions = 4096;

/// The rules, cheapest first.
Rejection broken_rule(const FlightModel& model, const AeroMap* map, const FlightRules& rules,
                      const simulation::RuleLimits& limits, const Given& given, const FlightState& before,
                      const FlightState& state, const ReferencePoint& reference) {
    const double broken = simulation::broken_rule(limits, given.saturation, state, reference);
    if (broken > 0) {
        return static_cast<Rejection>(static_cast<int>(broken));
    }
    if (map != nullptr && !simulation::is_flyable(model, *map, pose_of(state))) {
        return Rejection::flyable_area;
    }
    if (model.collisions().is_nearer_than(pose_of(state), rules.margin_m) ||
        simulation::comes_nearer_between(model, pose_of(before), pose_of(state), rules.margin_m)) {
        return Rejection::collision;
    }
    return Rejection::none;
}

template <class Factor>
SegmentFlight fly_with(const FlightModel& model, const AeroMap* map, const FlightRules& rules,
                       const ReferenceSegment& segment, FlightState& state, Factor&& factor) {
    const simulation::RuleLimits limits = simulation::rule_limits(rules, model.robot().arm);
    SegmentFlight flight;
    flight.rejection = simulation::fly_ticks(
        model.tick(), segment, factor, dynamics::OneStep{}, state,
        [&](const FlightState& before, const ReferencePoint&, const Given& given, const FlightState& next,
            const ReferencePoint& next_reference) {
            ++flight.ticks;
            if (flight.ticks % ticks_between_questions == 0 && rules.is_over && rules.is_over()) {
                return Rejection::interrupted;
            }
            simulation::add_tick(flight, model.tick().plant, before, next);
            const Rejection rejection = broken_rule(model, map, rules, limits, given, before, next, next_reference);
            if (rejection == Rejection::none && rules.measures_clearance) {
                flight.clearance_integral +=
                    model.tick().tick_s * simulation::clearance_density(model.collisions().clearance_m(pose_of(next)));
            }
            return rejection;
        });
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
                  const ReferenceSegment& segment, FlightState& state) {
    if (map == nullptr) {
        return fly_with(model, map, rules, segment, state, simulation::NoEffect{});
    }
    return fly_with(model, map, rules, segment, state,
                    simulation::MapEffect<double>(simulation::rotor_maps(model, *map)));
}

}  // namespace downwash
