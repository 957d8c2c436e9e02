#include "downwash/simulation/touch_flight.hpp"

#include <variant>

#include "downwash/controllers/control.hpp"
#include "downwash/simulation/flight_loop.hpp"
#include "downwash/simulation/touch_course.hpp"

namespace downwash::simulation {
namespace {

/// Where the reference of a touch is, on the way of a course.
ReferencePoint reference_at(const TouchCourse& course, const Touch& touch, const ReferencePoint& base) noexcept {
    ReferencePoint point = base;
    const double along_m_s = course.along_m_s();
    point.position[0] -= course.ahead_m() * touch.normal.x;
    point.position[1] -= course.ahead_m() * touch.normal.z;
    point.velocity[0] = -along_m_s * touch.normal.x;
    point.velocity[1] = -along_m_s * touch.normal.z;
    return point;
}

/// Lets integrals and an observer stand still over a tick: a surface that pushes is not what they are there for.
/// @param[in,out] next state after the tick
void stand_still(const TickModel& model, const FlightState& before, FlightState& next) {
    controllers::visit_flown(model.law, [&]<class Law>(const Law& law) {
        const auto kept = controllers::recalled<Law>(before.memory);
        auto memory = Law::with_integrals_of(kept, controllers::recalled<Law>(next.memory));
        if constexpr (controllers::is_aided<Law>) {
            const auto momentum_of = [&](const dynamics::PlantState<double>& plant, double p[4]) {
                dynamics::momentum(model.plant, dynamics::motion_at(model.plant, plant.q, plant.u).equations, plant.u,
                                   p);
            };
            double p[4];
            double change[4];
            momentum_of(before.plant, p);
            momentum_of(next.plant, change);
            for (int i = 0; i < 4; ++i) {
                change[i] -= p[i];
            }
            law.hold_estimate(kept, change, model.tick_s, memory);
        }
        controllers::remember(memory, next.memory);
    });
}

}  // namespace

Rejection fly_touch_ticks(const FlightModel& model, const FlownWorld* world, std::int64_t first_tick,
                          const Touch& touch, ReferencePoint base, FlightEffect& effect, FlightState& state,
                          TouchRecord& record, const AfterTouchTick& after) {
    const TickModel& tick_model = model.tick();
    dynamics::PlanarContact contact;
    contact.surface_m = {touch.surface_m.x, touch.surface_m.z};
    contact.normal = {touch.normal.x, touch.normal.z};
    contact.is_end_effector = touch.frame_points_m.empty();
    for (const PlaneVector& point : touch.frame_points_m) {
        contact.point_m[contact.point_count++] = {point.x, point.z};
    }
    dynamics::ContactTickRecord seen;
    dynamics::PlanePoint<double> center_of_mass_m{0, 0};
    if (world != nullptr) {
        contact.surface_m.x += world->numbers.scene_x_m;
        contact.surface_m.z += world->numbers.scene_z_m;
        center_of_mass_m = {world->numbers.center_of_mass_x_m, world->numbers.center_of_mass_z_m};
    }
    const dynamics::ContactStep step{contact, center_of_mass_m, seen};
    const double stiffness_1_s2 =
        std::visit([axis = touch.normal.x == 0 ? 1 : 0](const auto& law) { return law.position_stiffness_1_s2(axis); },
                   tick_model.law);
    TouchCourse course(touch, tick_model.plant.total_mass_kg, stiffness_1_s2, tick_model.tick_s);
    TouchForce force(touch, tick_model.tick_s);
    Rejection rejection = Rejection::none;
    const FlightLoop loop(tick_model, world, effect);
    for (std::int64_t t = 0; !course.is_over() && rejection == Rejection::none; ++t) {
        const ReferencePoint now = reference_at(course, touch, base);
        const bool is_holding = course.is_holding();
        controllers::Actuation<double> given{};
        FlightState next = loop.tick(first_tick + t, state, now, given, step);
        if (seen.normal_impulse_n_s > 0 || course.is_at_surface()) {
            stand_still(tick_model, state, next);
        }
        const double end_s = static_cast<double>(first_tick + t + 1) * tick_model.tick_s;
        force.saw(seen.normal_impulse_n_s, seen.depth_m, end_s, next.plant.energy_j - state.plant.energy_j, is_holding);
        course.next(seen.normal_impulse_n_s / tick_model.tick_s);
        rejection = seen.depth_m > max_touch_depth_m ? Rejection::collision : Rejection::none;
        const Rejection found = after(state, now, given, next, reference_at(course, touch, base), seen);
        rejection = found != Rejection::none ? found : rejection;
        state = next;
    }
    record = force.record(rejection == Rejection::none);
    return rejection != Rejection::none || record.is_met ? rejection : Rejection::goal_missed;
}

}  // namespace downwash::simulation
