#pragma once

#include <type_traits>

#include "downwash/controllers/control.hpp"
#include "downwash/simulation/read_effect.hpp"
#include "downwash/simulation/surroundings.hpp"
#include "downwash/simulation/tick_model.hpp"
#include "downwash/simulation/vehicle_state.hpp"
#include "downwash/simulation/world_tick.hpp"

// One tick of the closed loop: the one definition that planning, execution, studies and benchmarks share.

namespace downwash::simulation {

/// The controller's part of a tick. @param seen what it sees   @param[out] next what the law remembers
template <class T, class Law, class Effect>
[[gnu::always_inline]] inline void control(const TickModel& model, const Law& law, const dynamics::PlantState<T>& seen,
                                           const dynamics::Motion<T>& motion, const controllers::LawMemory<T>& memory,
                                           const BasicReferencePoint<T>& reference, Effect& effect,
                                           controllers::Actuation<T>& given, controllers::LawMemory<T>& next) {
    const auto own = controllers::recalled<Law>(memory);
    if constexpr (controllers::is_aided<Law>) {
        const ReadEffect<T, Effect> map(effect, model.tilt_loss);
        controllers::remember(law.control(model.plant, seen, motion, own, reference, model.tick_s, given, map), next);
    } else {
        controllers::remember(law.control(model.plant, seen, motion, own, reference, model.tick_s, given), next);
    }
}

/// One control tick, a pure function: the controller reads the state, its commands are held while the plant moves.
/// @param law that of the model, as what flies: what runs tick by tick calls controllers::visit_flown() once
/// @param motion that of the state
/// @param factor callable (rotor, x_m, z_m) -> thrust ratio K at a rotor hub in the plane. That of a tilted rotor is
/// less if the factor tells the sides apart (see WorldSurroundings); otherwise it is taken as it is
/// @param[out] given what the controller commanded
/// @param integrate callable (plant, state, motion, command, dt, factor) -> state: dynamics::OneStep or
/// dynamics::RefinedStep
template <class T, class Law, class Factor, class Integrate = dynamics::OneStep>
VehicleState<T> tick(const TickModel& model, const Law& law, const VehicleState<T>& state,
                     const dynamics::Motion<T>& motion, const BasicReferencePoint<T>& reference, Factor&& factor,
                     controllers::Actuation<T>& given, const Integrate& integrate = {}) {
    VehicleState<T> next;
    control(model, law, state.plant, motion, state.memory, reference, factor, given, next.memory);
    if constexpr (requires { factor.sided(0, state.plant.q[0], state.plant.q[1]); }) {
        const TiltedEffect<T, std::remove_reference_t<Factor>> effect(factor, model.tilt_loss);
        next.plant = integrate(model.plant, state.plant, motion, given.command, T(model.tick_s), effect);
    } else {
        next.plant = integrate(model.plant, state.plant, motion, given.command, T(model.tick_s), factor);
    }
    return next;
}

/// The same in a world that is not what the controller takes it for, perhaps a different one in every lane. In the
/// world without any difference it is the same to the last bit.
/// @param noise standard normal numbers of this tick   @param effect see WorldSurroundings
template <class T, class Law, class Effect, class Integrate = dynamics::OneStep>
State<T> tick_in_world(const TickModel& model, const Law& law, const WorldNumbers<T>& world, const T noise[noise_count],
                       const State<T>& state, const BasicReferencePoint<T>& reference, Effect&& effect,
                       controllers::Actuation<T>& given, const Integrate& integrate = {}) {
    const dynamics::PlantState<T> seen = seen_state(world, state.plant, state.world, noise);
    State<T> next;
    control(model, law, seen, dynamics::motion_at(model.plant, seen.q, seen.u), state.memory, reference, effect, given,
            next.memory);
    BasicPlantModel<T> plant;
    static_cast<PlantStructure&>(plant) = model.plant;
    static_cast<PlantNumbers<T>&>(plant) = world.plant;
    // The plant moves about its centre of mass, all others follow the point that the robot file calls so.
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
    const WorldSurroundings surroundings(world, wind_in(world, state.world), effect, model.tilt_loss);
    next.plant = integrate(plant, moving, motion, given.command, T(model.tick_s), surroundings);
    shift(next.plant, dynamics::attitude(plant, next.plant.q[2], next.plant.q[3]), T(-1));
    next.world = later(world, state.plant, state.world, noise);
    return next;
}

/// A single tick, where neither the law's type nor the motion of the state is at hand.
template <class Factor, class Integrate = dynamics::OneStep>
State<double> tick(const TickModel& model, const State<double>& state, const ReferencePoint& reference, Factor&& factor,
                   controllers::Actuation<double>& given, const Integrate& integrate = {}) {
    const auto motion = dynamics::motion_at(model.plant, state.plant.q, state.plant.u);
    return controllers::visit_flown(model.law, [&](const auto& law) {
        const VehicleState<double>& vehicle = state;
        return State<double>{tick(model, law, vehicle, motion, reference, factor, given, integrate), state.world};
    });
}

}  // namespace downwash::simulation
