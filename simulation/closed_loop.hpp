#pragma once

#include <variant>

#include "downwash/controllers/control_law.hpp"
#include "downwash/dynamics/flight_step.hpp"

// One tick of the closed loop: the one definition that planning, execution, studies and benchmarks share.

namespace downwash::simulation {

/// Everything about the vehicle that does not change in flight.
struct TickModel {
    PlantModel plant;  ///< what the controller knows, and what flies unless somebody says otherwise
    ControlLaw law;
    double tick_s;  ///< control period, 1 / rate_hz
};

/// Everything about the vehicle that changes in flight: bodies, rotor lag, energy, and every integrator. Nothing but
/// T: see base/numbers.hpp.
template <class T>
struct State {
    dynamics::PlantState<T> plant;
    controllers::LawMemory<T> memory;
};

// With the narrow registers of every processor a tick with all that it calls in one place takes a sixth less; kernels
// of wide ones flatten their whole loop instead. What sanitizers add would keep the compiler busy for minutes.
#if defined(__AVX2__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DOWNWASH_IN_ONE_PIECE
#else
#define DOWNWASH_IN_ONE_PIECE [[gnu::flatten]]
#endif

/// One control tick, a pure function: the controller reads the state, its commands are held while the plant moves.
/// @param law that of the model, as its own type: what runs tick by tick visits model.law once
/// @param motion that of the state
/// @param factor callable (rotor, x_m, z_m) -> thrust ratio K at a rotor hub in the plane
/// @param[out] given what the controller commanded
/// @param integrate callable (plant, state, motion, command, dt, factor) -> state: dynamics::OneStep or
/// dynamics::RefinedStep
template <class T, class Law, class Factor, class Integrate = dynamics::OneStep>
DOWNWASH_IN_ONE_PIECE State<T> tick(const TickModel& model, const Law& law, const State<T>& state,
                                    const dynamics::Motion<T>& motion, const BasicReferencePoint<T>& reference,
                                    Factor&& factor, controllers::Actuation<T>& given,
                                    const Integrate& integrate = {}) {
    State<T> next;
    next.memory = controllers::remembered(law.control(
        model.plant, state.plant, motion, controllers::recalled<Law>(state.memory), reference, model.tick_s, given));
    next.plant = integrate(model.plant, state.plant, motion, given.command, T(model.tick_s), factor);
    return next;
}

#undef DOWNWASH_IN_ONE_PIECE

/// The same in a world where the plant is not what its controller takes it for, perhaps a different one in every lane.
/// @param plant what flies   @param seen the state as the controller measures it
template <class T, class Law, class P, class Factor, class Integrate = dynamics::OneStep>
State<T> tick_of_other_plant(const TickModel& model, const Law& law, const BasicPlantModel<P>& plant,
                             const State<T>& state, const dynamics::PlantState<T>& seen,
                             const BasicReferencePoint<T>& reference, Factor&& factor, controllers::Actuation<T>& given,
                             const Integrate& integrate = {}) {
    State<T> next;
    next.memory =
        controllers::remembered(law.control(model.plant, seen, dynamics::motion_at(model.plant, seen.q, seen.u),
                                            controllers::recalled<Law>(state.memory), reference, model.tick_s, given));
    next.plant = integrate(plant, state.plant, dynamics::motion_at(plant, state.plant.q, state.plant.u), given.command,
                           T(model.tick_s), factor);
    return next;
}

/// A single tick, where neither the law's type nor the motion of the state is at hand.
template <class Factor, class Integrate = dynamics::OneStep>
State<double> tick(const TickModel& model, const State<double>& state, const ReferencePoint& reference, Factor&& factor,
                   controllers::Actuation<double>& given, const Integrate& integrate = {}) {
    const auto motion = dynamics::motion_at(model.plant, state.plant.q, state.plant.u);
    return std::visit(
        [&](const auto& law) { return tick(model, law, state, motion, reference, factor, given, integrate); },
        model.law);
}

}  // namespace downwash::simulation
