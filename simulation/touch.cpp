#include "downwash/simulation/touch.hpp"

#include <limits>

#include "downwash/simulation/between_ticks.hpp"
#include "downwash/simulation/map_effect.hpp"
#include "downwash/simulation/touch_flight.hpp"
#include "downwash/simulation/vehicle_effect.hpp"

namespace downwash {

TouchFlight fly_touch(const FlightModel& model, const AeroMap* map, const Touch& touch, const ReferencePoint& base,
                      FlightState& state, const FlightWorld& in) {
    const FlownWorld* const world = flown_world(model, in.world);
    TouchFlight flight;
    PlanarPose pose_before = simulation::off_surface(among_obstacles(pose_of(state), world), touch, -touch.standoff_m);
    double before_m = model.collisions().clearance_m(pose_before);
    const auto after = [&](const FlightState&, const ReferencePoint&, const controllers::Actuation<double>&,
                           const FlightState& next, const ReferencePoint& reference,
                           const dynamics::ContactTickRecord& contact) {
        ++flight.ticks;
        if (!is_stable(next, reference)) {
            return Rejection::unstable;
        }
        const PlanarPose pose = among_obstacles(pose_of(next), world);
        const PlanarPose off = simulation::off_surface(pose, touch, contact.depth_m);
        const double clearance_m = model.collisions().clearance_m(off);
        if (clearance_m <= 0 || simulation::least_clearance_between_m(model, pose_before, before_m, off, clearance_m,
                                                                      simulation::planned_clearance_m) <= 0) {
            return Rejection::collision;
        }
        pose_before = off;
        before_m = clearance_m;
        return map != nullptr && !is_flyable(model, *map, pose) ? Rejection::flyable_area : Rejection::none;
    };
    const auto fly = [&](simulation::FlightEffect&& effect) {
        flight.rejection =
            simulation::fly_touch_ticks(model, world, in.first_tick, touch, base, effect, state, flight.record, after);
    };
    if (map != nullptr) {
        const simulation::RotorMaps maps = simulation::rotor_maps(model, *map);
        fly(simulation::FlightEffectOf{simulation::MapEffect<double>(maps)});
    } else {
        fly(simulation::FlightEffectOf{simulation::NoEffect{}});
    }
    return flight;
}

}  // namespace downwash
