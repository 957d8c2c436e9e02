#pragma once

// The body of every FlightKernel, compiled once for each set of instructions. Only flight_kernel_*.cpp include it: all
// that it makes has internal linkage, and it uses nothing of the standard library.

#include "downwash/base/lane_pack.hpp"
//
#include "downwash/controllers/quintic.hpp"
#include "downwash/simulation/closed_loop.hpp"
#include "downwash/simulation/flight_kernel.hpp"
#include "downwash/simulation/noise.hpp"

namespace downwash::simulation {
inline namespace {  // NOLINT(google-build-namespaces)

using lane::Pack;
using lane::PackMask;

static_assert(lane_count % lane::pack_width == 0);

/// An EffectField that knows where the vehicle may fly: `doubt(rotor, x_m, z_m)` is 0 in lanes whose hub is in a cell
/// that is flyable throughout.
template <class Field>
concept KnowsFlyableArea = requires(Field& field, const Pack& at_m) {
    field.doubt(0, at_m, at_m);
};

/// 0 where every hub is in a cell that is flyable throughout.
/// @param scene_x_m,scene_z_m where the surfaces are, from where the map has them
template <KnowsFlyableArea Field>
Pack flyable_doubt(const PlantModel& plant, const VehicleState<Pack>& state, const dynamics::Attitude<Pack>& a,
                   Pack scene_x_m, Pack scene_z_m, Field& field) {
    Pack doubt(0);
    for (int rotor = 0; rotor < plant.rotor_count; ++rotor) {
        if (field.same_as(rotor) == rotor) {
            const auto hub =
                dynamics::rotor_position(plant, a, state.plant.q[0] - scene_x_m, state.plant.q[1] - scene_z_m, rotor);
            doubt = lane::max(doubt, field.doubt(rotor, hub.x, hub.z));
        }
    }
    return doubt;
}

/// As many neighbouring lanes as fit into a pack.
struct LaneGroup {
    FlightLanes& lanes;
    int first;

    Pack load(const double (&from)[lane_count]) const { return lane::load<Pack>(from + first); }
    void store(Pack pack, double (&to)[lane_count]) const { pack.store(to + first); }

    /// A struct of packs.
    template <class Struct, std::size_t Count>
    Struct load(const double (&from)[Count][lane_count]) const {
        static_assert(number_count<Pack, Struct> == Count);
        Struct packs;
        for (int i = 0; i < static_cast<int>(Count); ++i) {
            set_number_at(packs, i, load(from[i]));
        }
        return packs;
    }
    template <class Struct, std::size_t Count>
    void store(const Struct& from, double (&to)[Count][lane_count]) const {
        static_assert(number_count<Pack, Struct> == Count);
        for (int i = 0; i < static_cast<int>(Count); ++i) {
            store(number_at<Pack>(from, i), to[i]);
        }
    }
};

/// The coordinates (x, z, pitch, arm) of every lane.
struct Coordinates {
    Pack q[4];
};

inline BasicReferencePoint<Pack> reference_at(const LaneGroup& group, Pack tick, Pack tick_s) {
    const FlightLanes& lanes = group.lanes;
    const Pack inverse_duration = group.load(lanes.inverse_duration_1_s);
    const Pack s = tick * tick_s * inverse_duration;
    const auto along = [&](int axis) {
        Pack coefficient[6];
        for (int power = 0; power < 6; ++power) {
            coefficient[power] = group.load(lanes.coefficient[axis][power]);
        }
        return controllers::quintic_at(coefficient, s, inverse_duration);
    };
    const auto x = along(0), z = along(1), arm = along(2);
    const BasicReferencePoint<Pack> reference{{x.position, z.position, arm.position},
                                              {x.velocity, z.velocity, arm.velocity},
                                              {x.acceleration, z.acceleration, arm.acceleration}};
    const PackMask is_end = tick >= group.load(lanes.ticks);
    return any(is_end) ? select_each(is_end, group.load<BasicReferencePoint<Pack>>(lanes.end), reference) : reference;
}

/// The standard normal numbers that the lanes' worlds draw for a tick.
inline void draw_noises(const FlightKernelModel& model, const LaneGroup& group, Pack tick, Pack noise[noise_count]) {
    alignas(sizeof(Pack)) double numbers[noise_count][lane::pack_width];
    for (int lane = 0; lane < lane::pack_width; ++lane) {
        draw_noise(model.normal_levels, group.lanes.tape[group.first + lane],
                   static_cast<std::int64_t>(lane::number_in(tick, lane)), &numbers[0][lane], lane::pack_width);
    }
    for (int i = 0; i < noise_count; ++i) {
        noise[i] = lane::load<Pack>(numbers[i]);
    }
}

/// A law as what flies. @param law the law itself
template <class Law>
[[gnu::always_inline]] inline const Law& flown(const void* law) {
    return *static_cast<const Law*>(law);
}
template <class Flown>
requires controllers::is_aided<Flown>
[[gnu::always_inline]] inline Flown flown(const void* law) {
    return {*static_cast<std::remove_reference_t<decltype(Flown::law)>*>(law)};
}

/// One tick of all lanes: tick_in_world() or tick().
/// @tparam Law as what flies   @tparam is_in_worlds whether some flights are
/// @param noise,world unused outside worlds   @param motion that of the state, unused in worlds
template <bool is_in_worlds, class Law, class State, class Field>
#if !defined(__AVX2__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// With narrow registers a tick with all that it calls in one place takes a fifth less; with wide ones fly_lanes() is in
// one place instead. What sanitizers add would keep the compiler busy for minutes.
[[gnu::flatten]]
#endif
State
tick_of_lanes(const TickModel& model, const Law& law, const WorldNumbers<Pack>& world, const Pack noise[noise_count],
              const State& state, const dynamics::Motion<Pack>& motion, const BasicReferencePoint<Pack>& reference,
              Field& field, controllers::Actuation<Pack>& given) {
    if constexpr (is_in_worlds) {
        return tick_in_world(model, law, world, noise, state, reference, field, given);
    } else {
        return tick(model, law, state, motion, reference, field, given);
    }
}

/// Flies a group of lanes until one of them wants attention: see FlightKernel.
/// @tparam Law as what flies   @tparam is_in_worlds whether some flights are
template <class Law, bool is_in_worlds, class Field>
void fly_group(const FlightKernelModel& model, const LaneGroup& group, int max_ticks, Field field) {
    FlightLanes& lanes = group.lanes;
    const PackMask is_active = group.load(lanes.is_active) > Pack(0);
    if (!any(is_active)) {
        return;
    }
    const auto& law = flown<Law>(model.law);
    const PlantModel& plant = model.tick->plant;
    std::conditional_t<is_in_worlds, State<Pack>, VehicleState<Pack>> state;
    static_cast<VehicleState<Pack>&>(state) = group.load<VehicleState<Pack>>(lanes.state);
    auto reference = group.load<BasicReferencePoint<Pack>>(lanes.reference);
    Pack tick_count = group.load(lanes.tick);
    auto sums = group.load<BasicFlightSums<Pack>>(lanes.sums);
    Pack rejection(0);
    Pack unclear(0);
    const auto anchor = group.load<Coordinates>(lanes.anchor);
    Coordinates before = anchor;
    const Pack free_motion_m = group.load(lanes.free_motion_m);
    const Pack look_tick = group.load(lanes.look_tick);
    const Pack max_speed_m_s = group.load(lanes.max_speed_m_s);
    const Pack ticks = group.load(lanes.ticks);
    dynamics::Motion<Pack> motion = dynamics::motion_at(plant, state.plant.q, state.plant.u);
    WorldNumbers<Pack> world;
    Pack noise[noise_count] = {};
    Pack first_tick;
    if constexpr (is_in_worlds) {
        state.world = group.load<WorldMemory<Pack>>(lanes.world_memory);
        world = group.load<WorldNumbers<Pack>>(lanes.world);
        first_tick = group.load(lanes.first_tick);
    }
    for (int n = 0; n < max_ticks; ++n) {
        controllers::Actuation<Pack> given;
        if (is_in_worlds && model.has_noise) {
            draw_noises(model, group, first_tick + tick_count, noise);
        }
        const auto next =
            tick_of_lanes<is_in_worlds>(*model.tick, law, world, noise, state, motion, reference, field, given);
        tick_count = tick_count + Pack(1);
        reference = reference_at(group, tick_count, Pack(model.tick->tick_s));
        add_tick(sums, plant, state, next);
        for (int i = 0; i < 4; ++i) {
            before.q[i] = state.plant.q[i];
        }
        state = next;
        if constexpr (is_in_worlds) {
            motion.attitude = dynamics::attitude(plant, state.plant.q[2], state.plant.q[3]);
        } else {
            motion = dynamics::motion_at(plant, state.plant.q, state.plant.u);
        }
        rejection = broken_rule(model.limits, given.saturation, state, reference);
        const Pack* u = state.plant.u;
        const PackMask is_slow = lane::sqrt(u[0] * u[0] + u[1] * u[1]) < max_speed_m_s;
        const PackMask is_due =
            (motion_m(model.reach, anchor.q, state.plant.q) > free_motion_m) | (tick_count >= look_tick);
        unclear = select(is_due | !is_slow, Pack(1), Pack(0));
        if constexpr (KnowsFlyableArea<Field>) {
            Pack scene_x_m(0);
            Pack scene_z_m(0);
            if constexpr (is_in_worlds) {
                scene_x_m = world.scene_x_m;
                scene_z_m = world.scene_z_m;
            }
            unclear = lane::max(unclear, flyable_doubt(plant, state, motion.attitude, scene_x_m, scene_z_m, field));
        }
        if (any(is_active & ((rejection > Pack(0)) | (unclear > Pack(0)) | (tick_count >= ticks)))) {
            break;
        }
    }
    group.store<VehicleState<Pack>>(state, lanes.state);
    if constexpr (is_in_worlds) {
        group.store(state.world, lanes.world_memory);
    }
    group.store(reference, lanes.reference);
    group.store(tick_count, lanes.tick);
    group.store(sums, lanes.sums);
    group.store(before, lanes.before);
    group.store(rejection, lanes.rejection);
    group.store(unclear, lanes.is_unclear);
}

/// The kernel of one law.
template <class Law>
#if defined(__AVX2__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// Everything in one place. With narrow registers it would not fit into the instruction cache, and what sanitizers add
// would keep the compiler busy for minutes.
[[gnu::flatten]]
#endif
void
fly_lanes(const FlightKernelModel& model, FlightLanes& lanes, int max_ticks) {
    for (int first = 0; first < lane_count; first += lane::pack_width) {
        const LaneGroup group{lanes, first};
        if (!model.is_in_worlds && model.has_map) {
            fly_group<Law, false>(model, group, max_ticks, MapEffect<Pack>(model.maps));
        } else if (!model.is_in_worlds) {
            fly_group<Law, false>(model, group, max_ticks, NoEffect{});
        } else if (model.has_map) {
            fly_group<Law, true>(model, group, max_ticks, MapEffect<Pack>(model.maps));
        } else {
            fly_group<Law, true>(model, group, max_ticks, NoEffect{});
        }
    }
}

/// The kernel of a law with its aids; of a law that has none, its own.
template <class Law>
constexpr FlightKernel aided_kernel() {
    if constexpr (controllers::CanBeAided<Law>) {
        return fly_lanes<controllers::Aided<Law>>;
    } else {
        return fly_lanes<Law>;
    }
}

template <class... Laws>
FlightKernel kernel_among(std::size_t law, bool is_aided, const std::variant<Laws...>* /*all*/) {
    static constexpr FlightKernel of_law[] = {fly_lanes<Laws>...};
    static constexpr FlightKernel of_aided_law[] = {aided_kernel<Laws>()...};
    return is_aided ? of_aided_law[law] : of_law[law];
}

/// The kernel of a law, by its number in FlownLaw.
inline FlightKernel kernel_of(std::size_t law, bool is_aided) {
    return kernel_among(law, is_aided, static_cast<const FlownLaw*>(nullptr));
}

}  // namespace
}  // namespace downwash::simulation
