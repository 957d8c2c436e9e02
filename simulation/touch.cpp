#include "downwash/simulation/touch.hpp"

#include <algorithm>
#include <utility>

#include "downwash/simulation/between_ticks.hpp"
#include "downwash/simulation/map_effect.hpp"
#include "downwash/simulation/space_looks.hpp"
#include "downwash/simulation/touch_flight.hpp"
#include "downwash/simulation/vehicle_effect.hpp"

namespace downwash {
namespace {

/// Whether a robot touches anything on its way from pose to pose. It is looked for only where it has moved so far since
/// it was last that it may: most of a touch is spent away from the surface.
class ContactWatch {
 public:
    /// @param start where it touches nothing
    ContactWatch(const FlightModel& model, const PlanarPose& start)
        : model_(model), before_(start), looked_at_(start), free_m_(model.collisions().clearance_m(start)) {}

    bool touches_on_way_to(const PlanarPose& pose) {
        const PlanarPose from = std::exchange(before_, pose);
        const double away_m = simulation::motion_m(model_, looked_at_, from);
        const double error_m = simulation::free_motion_error_m(model_.collisions().kind());
        if (away_m + simulation::motion_m(model_, from, pose) + error_m < free_m_) {
            return false;
        }
        const double from_m = std::max(0.0, free_m_ - away_m);  // at least
        looked_at_ = pose;
        free_m_ = model_.collisions().clearance_m(pose);
        return free_m_ <= 0 || simulation::least_clearance_between_m(model_, from, from_m, pose, free_m_,
                                                                     simulation::planned_clearance_m) <= 0;
    }

 private:
    const FlightModel& model_;
    PlanarPose before_;     ///< the last one
    PlanarPose looked_at_;  ///< where it was looked for last, and
    double free_m_;         ///< how far everything was from there
};

}  // namespace

TouchFlight fly_touch(const FlightModel& model, const AeroMap* map, const Touch& touch, const ReferencePoint& base,
                      FlightState& state, const FlightWorld& in) {
    const FlownWorld* const world = flown_world(model, in.world);
    TouchFlight flight;
    ContactWatch watch(model,
                       simulation::off_surface(among_obstacles(pose_of(state), world), touch, -touch.standoff_m));
    const auto after = [&](const FlightState&, const ReferencePoint&, const controllers::Actuation<double>&,
                           const FlightState& next, const ReferencePoint& reference,
                           const dynamics::ContactTickRecord& contact) {
        ++flight.ticks;
        if (!is_stable(next, reference)) {
            return Rejection::unstable;
        }
        const PlanarPose pose = among_obstacles(pose_of(next), world);
        if (watch.touches_on_way_to(simulation::off_surface(pose, touch, contact.depth_m))) {
            return Rejection::collision;
        }
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
