#pragma once

#include "downwash/controllers/px4_cascade_control.hpp"
#include "downwash/controllers/space_inversion_control.hpp"
#include "downwash/dynamics/space_integration.hpp"
#include "downwash/simulation/space_surroundings.hpp"
#include "downwash/simulation/space_vehicle.hpp"
#include "downwash/simulation/space_world_tick.hpp"

// One tick of the closed loop in space, one template over the lane type and the number of joints. closed_loop.hpp has
// that of the plane.

namespace downwash::simulation {

/// What a law is told besides: nothing.
struct NothingTold {};

/// Surroundings as the map that a law reads: of a vehicle with the attitude that the law sees.
/// @tparam Told NothingTold or controllers::ToldPush
template <class T, int n, dynamics::SpaceSurroundings<T> Around, class Told = NothingTold>
class SeenRatios : public Told {
 public:
    /// @pre model and surroundings outlive this
    SeenRatios(const SpaceModel<n>& model, const dynamics::SpaceState<T, n>& seen, const Around& around,
               const Told& told = {})
        : Told(told), model_(model), attitude_(dynamics::rotation_of(seen.q + 3)), around_(around) {}

    T ratio(int rotor, const dynamics::LaneVector<T>& hub_m) const {
        return dynamics::at_attitude<T>(around_, attitude_)
            .thrust_ratio(rotor, hub_m, attitude_ * dynamics::spread<T>(model_.rotor[rotor].axis));
    }

 private:
    const SpaceModel<n>& model_;
    dynamics::LaneRotation<T> attitude_;
    const Around& around_;
};

/// The controller's part of a tick. It reads the surfaces where they nominally are.
/// @param seen what it sees   @param[out] next what the law remembers, not `memory` itself   @param told see SeenRatios
template <class T, int n, class Law, SpaceField<T> Field, class Told = NothingTold>
void control(const SpaceTickModel<n>& model, const Law& law, const dynamics::SpaceState<T, n>& seen,
             const SpaceLawMemory<T, n>& memory, const BasicSpacePoint<T, n>& reference, Field& field,
             SpaceActuation<T, n>& given, SpaceLawMemory<T, n>& next, const Told& told = {}) {
    using Memory = typename Law::template Memory<T, n>;
    const Memory own = recalled<Law>(memory);
    Memory now;
    const NominalSpace<T, Field> around(field, model.tilt_loss, model.slipstreams);
    const SeenRatios<T, n, NominalSpace<T, Field>, Told> map(model.nominal.plant, seen, around, told);
    given.saturation = law.control(model.nominal, seen, own, reference, model.tick_s, map, given.command, now);
    remember(now, next);
}

/// One control tick, a pure function: the controller reads the state, its commands are held while the plant moves. The
/// air stands still.
/// @param law the model's law, as std::visit hands it out   @param[out] given what the controller commanded
/// @param[out] next not the state itself   @param step how the plant moves
template <class T, int n, class Law, SpaceField<T> Field, class Step = dynamics::OneSpaceStep>
void tick(const SpaceTickModel<n>& model, const Law& law, const SpaceVehicle<T, n>& state,
          const BasicSpacePoint<T, n>& reference, Field& field, SpaceActuation<T, n>& given, SpaceVehicle<T, n>& next,
          const Step& step = {}) {
    control(model, law, state.plant, state.memory, reference, field, given, next.memory);
    const NominalSpace<T, Field> around(field, model.tilt_loss, model.slipstreams);
    next.plant = step(model.nominal.plant, state.plant, given.command, T(model.tick_s), around);
}

/// The plant that flies in a world.
template <class T, int n>
BasicSpaceModel<T, n> plant_in(const SpaceTickModel<n>& model, const SpaceWorldNumbers<T, n>& world) {
    BasicSpaceModel<T, n> plant;
    static_cast<SpaceStructure&>(plant) = model.nominal.plant;
    static_cast<SpaceNumbers<T, n>&>(plant) = world.plant;
    return plant;
}

/// Moves a state from the centre of mass of the robot file to the true one (sign 1), or back (sign -1).
template <class T, int n>
void shift_center_of_mass(const dynamics::LaneVector<T>& center_of_mass_m, T sign, dynamics::SpaceState<T, n>& state) {
    const dynamics::LaneRotation<T> attitude = dynamics::rotation_of(state.q + 3);
    const dynamics::LaneVector<T> place = attitude * center_of_mass_m;
    const dynamics::LaneVector<T> velocity =
        attitude * cross(dynamics::LaneVector<T>{state.u[3], state.u[4], state.u[5]}, center_of_mass_m);
    state.q[0] = state.q[0] + sign * place.x;
    state.q[1] = state.q[1] + sign * place.y;
    state.q[2] = state.q[2] + sign * place.z;
    state.u[0] = state.u[0] + sign * velocity.x;
    state.u[1] = state.u[1] + sign * velocity.y;
    state.u[2] = state.u[2] + sign * velocity.z;
}

/// The plant's part of a tick in a world. It moves about its true centre of mass; states refer to the centre of mass of
/// the robot file.
/// @param plant see plant_in()   @param wind in this tick [m/s]   @param[out] next not the state itself
template <class T, int n, SpaceField<T> Field, class Step>
void move_in_world(const SpaceTickModel<n>& model, const SpaceWorldDifferences<T>& world,
                   const BasicSpaceModel<T, n>& plant, const dynamics::LaneVector<T>& wind,
                   const dynamics::SpaceState<T, n>& state, const dynamics::SpaceCommand<T, n>& command, Field& field,
                   const Step& step, dynamics::SpaceState<T, n>& next) {
    const WorldSpace<T, Field> around(world, wind, field, model.tilt_loss, model.slipstreams);
    dynamics::SpaceState<T, n> moving = state;
    shift_center_of_mass(world.center_of_mass_m, T(1), moving);
    next = step(plant, moving, command, T(model.tick_s), around);
    shift_center_of_mass(world.center_of_mass_m, T(-1), next);
}

/// One control tick in a world; every lane may have a world of its own. In the nominal world of a robot without delay
/// it is tick() to the last bit.
/// @param plant see plant_in()   @param noise standard normal numbers of this tick
/// @param[out] next not the state itself; its memory of older motions is that of an earlier tick, or empty
/// @param told see SeenRatios
template <class T, int n, class Law, SpaceField<T> Field, class Step = dynamics::OneSpaceStep, class Told = NothingTold>
void tick_in_world(const SpaceTickModel<n>& model, const Law& law, const SpaceWorldNumbers<T, n>& world,
                   const BasicSpaceModel<T, n>& plant, const T noise[space_noise_count],
                   const SpaceFlightState<T, n>& state, const BasicSpacePoint<T, n>& reference, Field& field,
                   SpaceActuation<T, n>& given, SpaceFlightState<T, n>& next, const Step& step = {},
                   const Told& told = {}) {
    const dynamics::SpaceState<T, n> seen = seen_state(world, state.plant, state.world, noise);
    control(model, law, seen, state.memory, reference, field, given, next.memory, told);
    move_in_world(model, world, plant, wind_in(world, state.world.gust), state.plant, given.command, field, step,
                  next.plant);
    pass_tick(world, state.plant, state.world, noise, next.world);
}

}  // namespace downwash::simulation
