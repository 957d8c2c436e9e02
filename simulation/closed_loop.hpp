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

/// The plant's part of a tick, in place where that is possible. @param[out] next not the state itself
template <class T, class P, class Integrate, dynamics::Surroundings<T> Around>
[[gnu::always_inline]] inline void move(const Integrate& integrate, const BasicPlantModel<P>& plant,
                                        const dynamics::PlantState<T>& state, const dynamics::Motion<T>& motion,
                                        const dynamics::PlantCommand<T>& command, double tick_s, const Around& around,
                                        dynamics::PlantState<T>& next) {
    if constexpr (std::is_same_v<Integrate, dynamics::OneStep>) {
        dynamics::flight_step(plant, state, motion, command, T(tick_s), around, next);
    } else {
        next = integrate(plant, state, motion, command, T(tick_s), around);
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
    move(integrate, model.plant, state.plant, motion, given.command, model.tick_s, around, next.plant);
    return next;
}

/// One control tick of the nominal world, whose vehicles have drag and controllers that see late, but of which no arm
/// is in a slipstream. Without drag and with nothing late it is tick(), and it is always tick_in_world(): to the last
/// bit, the sign of a zero apart.
/// @param seen what the controller sees: see look_back()   @param seen_motion that of `seen`
/// @param[out] next not the state itself
template <class T, class Law, EffectField<T> Field>
[[gnu::always_inline]] inline void nominal_tick(const TickModel& model, const Law& law,
                                                const dynamics::PlantState<T>& seen,
                                                const dynamics::Motion<T>& seen_motion, const VehicleState<T>& state,
                                                const dynamics::Motion<T>& motion,
                                                const BasicReferencePoint<T>& reference, Field& field,
                                                controllers::Actuation<T>& given, VehicleState<T>& next) {
    control(model, law, seen, seen_motion, state.memory, reference, field, given, next.memory);
    const StillAir<T, Field> around(field, model.tilt_loss);
    dynamics::flight_step(model.plant, state.plant, motion, given.command, T(model.tick_s), around, next.plant);
}

/// The plant that flies in a world.
template <class T>
BasicPlantModel<T> plant_in(const TickModel& model, const WorldNumbers<T>& world) {
    BasicPlantModel<T> plant;
    static_cast<PlantStructure&>(plant) = model.plant;
    static_cast<PlantNumbers<T>&>(plant) = world.plant;
    return plant;
}

/// A control tick in a world but for what the world remembers.
/// @tparam may_have_wash see WorldSurroundings
/// @param plant see plant_in()   @param seen what the controller sees   @param wind in this tick [m/s]
/// @param[in,out] attitude of the plant, before and after   @param[out] next not the state itself
template <bool may_have_wash, class T, class Law, EffectField<T> Field, class Integrate = dynamics::OneStep>
[[gnu::always_inline]] inline void move_in_world(const TickModel& model, const Law& law, const WorldNumbers<T>& world,
                                                 const BasicPlantModel<T>& plant, const dynamics::PlantState<T>& seen,
                                                 const dynamics::PlanePoint<T>& wind, const VehicleState<T>& state,
                                                 dynamics::Attitude<T>& attitude,
                                                 const BasicReferencePoint<T>& reference, Field& field,
                                                 controllers::Actuation<T>& given, VehicleState<T>& next,
                                                 const Integrate& integrate = {}) {
    control(model, law, seen, dynamics::motion_at(model.plant, seen.q, seen.u), state.memory, reference, field, given,
            next.memory);
    // The plant moves about its true centre of mass; states refer to the centre of mass of the robot file.
    const auto shift = [&](dynamics::PlantState<T>& by, const dynamics::Attitude<T>& a, T sign) {
        const T x = a.cos_pitch * world.center_of_mass_x_m + a.sin_pitch * world.center_of_mass_z_m;
        const T z = a.cos_pitch * world.center_of_mass_z_m - a.sin_pitch * world.center_of_mass_x_m;
        by.q[0] = by.q[0] + sign * x;
        by.q[1] = by.q[1] + sign * z;
        by.u[0] = by.u[0] + sign * (by.u[2] * z);
        by.u[1] = by.u[1] - sign * (by.u[2] * x);
    };
    dynamics::PlantState<T> moving;
    for (int i = 0; i < number_count<T, dynamics::PlantState<T>>; ++i) {
        set_number_at(moving, i, number_at<T>(state.plant, i));
    }
    shift(moving, attitude, T(1));
    const dynamics::Motion<T> motion{attitude, dynamics::equations_of_motion(plant, attitude, moving.u)};
    const WorldSurroundings<T, Field, may_have_wash> around(world, wind, field, model.tilt_loss, model.slipstreams);
    move(integrate, plant, moving, motion, given.command, model.tick_s, around, next.plant);
    attitude = dynamics::attitude(plant, next.plant.q[2], next.plant.q[3]);
    shift(next.plant, attitude, T(-1));
}

/// One control tick in a world that differs from the nominal one; every lane may have a world of its own. In the
/// nominal world it is tick() to the last bit.
/// @param noise standard normal numbers of this tick   @param integrate see tick()
/// @param[out] next not the state itself
template <class T, class Law, EffectField<T> Field, class Integrate = dynamics::OneStep>
void tick_in_world(const TickModel& model, const Law& law, const WorldNumbers<T>& world, const T noise[noise_count],
                   const State<T>& state, const BasicReferencePoint<T>& reference, Field& field,
                   controllers::Actuation<T>& given, State<T>& next, const Integrate& integrate = {}) {
    const BasicPlantModel<T> plant = plant_in(model, world);
    const dynamics::PlantState<T> seen = seen_state(world, state.plant, state.world, noise);
    dynamics::Attitude<T> attitude = dynamics::attitude(plant, state.plant.q[2], state.plant.q[3]);
    move_in_world<true>(model, law, world, plant, seen, wind_in(world, state.world.gust), state, attitude, reference,
                        field, given, next, integrate);
    pass_tick(world, state.plant, state.world, noise, next.world);
}

}  // namespace downwash::simulation
