#pragma once

#include <type_traits>

#include "downwash/controllers/control.hpp"
#include "downwash/dynamics/flight_step.hpp"
#include "downwash/simulation/surroundings.hpp"
#include "downwash/simulation/tick_model.hpp"
#include "downwash/simulation/vehicle_state.hpp"
#include "downwash/simulation/world_tick.hpp"

// One tick of the closed loop: the one definition that planning, execution, studies and benchmarks share.

namespace downwash::simulation {

/// The controller's part of a tick. @param seen what it sees   @param[out] next what the law remembers
template <class T, class Law, EffectField<T> Field>
[[gnu::always_inline]] inline void control(const TickModel& model, const Law& law, const dynamics::PlantState<T>& seen,
                                           const dynamics::Motion<T>& motion, const controllers::LawMemory<T>& memory,
                                           const BasicReferencePoint<T>& reference, Field& field,
                                           controllers::Actuation<T>& given, controllers::LawMemory<T>& next) {
    const auto own = controllers::recalled<Law>(memory);
    if constexpr (controllers::is_aided<Law>) {
        auto& read = field.as_read();
        const NominalSurroundings<T, std::remove_reference_t<decltype(read)>> map(read, model.tilt_loss);
        controllers::remember(law.control(model.plant, seen, motion, own, reference, model.tick_s, given, map), next);
    } else {
        controllers::remember(law.control(model.plant, seen, motion, own, reference, model.tick_s, given), next);
    }
}

/// One control tick, a pure function: the controller reads the state, its commands are held while the plant moves.
/// @param law the model's law, as controllers::visit_flown() hands it out
/// @param motion that of the state   @param[out] given what the controller commanded
/// @param integrate how the plant moves: see dynamics/integration.hpp
template <class T, class Law, EffectField<T> Field, class Integrate = dynamics::OneStep>
VehicleState<T> tick(const TickModel& model, const Law& law, const VehicleState<T>& state,
                     const dynamics::Motion<T>& motion, const BasicReferencePoint<T>& reference, Field& field,
                     controllers::Actuation<T>& given, const Integrate& integrate = {}) {
    VehicleState<T> next;
    control(model, law, state.plant, motion, state.memory, reference, field, given, next.memory);
    const NominalSurroundings<T, Field> around(field, model.tilt_loss);
    next.plant = integrate(model.plant, state.plant, motion, given.command, T(model.tick_s), around);
    return next;
}

/// One control tick in a world that differs from the nominal one; every lane may have a world of its own. In the
/// nominal world it is tick() to the last bit.
/// @param noise standard normal numbers of this tick   @param integrate see tick()
template <class T, class Law, EffectField<T> Field, class Integrate = dynamics::OneStep>
State<T> tick_in_world(const TickModel& model, const Law& law, const WorldNumbers<T>& world, const T noise[noise_count],
                       const State<T>& state, const BasicReferencePoint<T>& reference, Field& field,
                       controllers::Actuation<T>& given, const Integrate& integrate = {}) {
    const dynamics::PlantState<T> seen = seen_state(world, state.plant, state.world, noise);
    State<T> next;
    control(model, law, seen, dynamics::motion_at(model.plant, seen.q, seen.u), state.memory, reference, field, given,
            next.memory);
    BasicPlantModel<T> plant;
    static_cast<PlantStructure&>(plant) = model.plant;
    static_cast<PlantNumbers<T>&>(plant) = world.plant;
    // The plant moves about its true centre of mass; states refer to the centre of mass of the robot file.
    dynamics::PlantState<T> moving = state.plant;
    const auto motion = dynamics::motion_at(plant, moving.q, moving.u);
    const auto shift = [&](dynamics::PlantState<T>& by, const dynamics::Attitude<T>& a, T sign) {
        const T x = a.cos_pitch * world.center_of_mass_x_m + a.sin_pitch * world.center_of_mass_z_m;
        const T z = a.cos_pitch * world.center_of_mass_z_m - a.sin_pitch * world.center_of_mass_x_m;
        by.q[0] = by.q[0] + sign * x;
        by.q[1] = by.q[1] + sign * z;
        by.u[0] = by.u[0] + sign * (by.u[2] * z);
        by.u[1] = by.u[1] - sign * (by.u[2] * x);
    };
    shift(moving, motion.attitude, T(1));
    const WorldSurroundings<T, Field> around(world, wind_in(world, state.world), field, model.tilt_loss,
                                             model.slipstreams);
    next.plant = integrate(plant, moving, motion, given.command, T(model.tick_s), around);
    shift(next.plant, dynamics::attitude(plant, next.plant.q[2], next.plant.q[3]), T(-1));
    next.world = later(world, state.plant, state.world, noise);
    return next;
}

}  // namespace downwash::simulation
