#include "downwash/simulation/flight.hpp"

#include <cmath>

#include "downwash/simulation/flight_loop.hpp"

namespace downwash {
namespace {

using simulation::TickRecord;

constexpr std::int64_t ticks_between_questions = 4096;

bool is_inside(const Bounds& bounds, const FlightState& state) {
    const double* q = state.plant.q;
    return q[0] >= bounds.x_low_m && q[0] <= bounds.x_high_m && q[1] >= bounds.z_low_m && q[1] <= bounds.z_high_m;
}

bool keeps_arm_limits(const ArmParameters& arm, const FlightState& state) {
    return !arm.is_limited || (state.plant.q[3] >= arm.lower_limit_rad && state.plant.q[3] <= arm.upper_limit_rad);
}

bool is_flyable(const FlightModel& model, const AeroMap& map, const FlightState& state) {
    return simulation::all_rotors(model, state, [&](int rotor, double x_m, double z_m) {
        return map.is_flyable(model.rotor_layer(rotor), x_m, z_m);
    });
}

/// The rules, cheapest first.
FlightFault broken_rule(const FlightModel& model, const AeroMap* map, const FlightRules& rules,
                        const TickRecord<double>& record, const FlightState& state, const ReferencePoint& reference) {
    if (!is_stable(state, reference)) {
        return FlightFault::unstable;
    }
    if (record.saturation > 1) {
        return FlightFault::saturation;
    }
    if (tracking_error_m(state, reference) > rules.max_tracking_error_m ||
        std::abs(reference.position[2] - state.plant.q[3]) > rules.max_arm_error_rad) {
        return FlightFault::tracking;
    }
    if (!is_inside(rules.bounds, state) || !keeps_arm_limits(model.robot().arm, state)) {
        return FlightFault::bounds;
    }
    if (map != nullptr && !is_flyable(model, *map, state)) {
        return FlightFault::flyable_area;
    }
    if (model.collisions().is_nearer_than(pose_of(state), rules.margin_m)) {
        return FlightFault::collision;
    }
    return FlightFault::none;
}

template <class Factor>
SegmentFlight fly_with(const FlightModel& model, const AeroMap* map, const FlightRules& rules,
                       const ReferenceSegment& segment, FlightState& state, const Factor& factor) {
    SegmentFlight flight;
    flight.fault = simulation::fly_ticks(
        model.tick(), segment, factor, dynamics::OneStep{}, state,
        [&](const FlightState& before, const ReferencePoint&, const TickRecord<double>& record, const FlightState& next,
            const ReferencePoint& next_reference) {
            ++flight.ticks;
            if (flight.ticks % ticks_between_questions == 0 && rules.is_over && rules.is_over()) {
                return FlightFault::interrupted;
            }
            flight.length_m += simulation::step_length_m(model, before, next);
            const FlightFault fault = broken_rule(model, map, rules, record, next, next_reference);
            if (fault == FlightFault::none && rules.measures_clearance) {
                flight.clearance_integral +=
                    model.tick().tick_s * simulation::clearance_density(model.collisions().clearance_m(pose_of(next)));
            }
            return fault;
        });
    return flight;
}

}  // namespace

double tracking_error_m(const FlightState& state, const ReferencePoint& reference) {
    const double dx = reference.position[0] - state.plant.q[0];
    const double dz = reference.position[1] - state.plant.q[1];
    return std::sqrt(dx * dx + dz * dz);
}

bool is_stable(const FlightState& state, const ReferencePoint& reference) {
    double sum = 0;  // not finite as soon as one number is not
    for (int i = 0; i < 4; ++i) {
        sum += std::abs(state.plant.q[i]) + std::abs(state.plant.u[i]);
    }
    return sum < 1e4 && std::abs(state.plant.q[2]) <= unstable_pitch_rad &&
           tracking_error_m(state, reference) <= unstable_error_m;
}

SegmentFlight fly(const FlightModel& model, const AeroMap* map, const FlightRules& rules,
                  const ReferenceSegment& segment, FlightState& state) {
    if (map == nullptr) {
        return fly_with(model, map, rules, segment, state, simulation::NoEffect{});
    }
    return fly_with(model, map, rules, segment, state, simulation::MapEffect{model, *map});
}

}  // namespace downwash
