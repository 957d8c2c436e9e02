#pragma once

// The body of every FlightKernel, compiled once for each set of instructions. Only flight_kernel_*.cpp include it: all
// that it makes has internal linkage, and it uses nothing of the standard library.

#include "downwash/base/lane_pack.hpp"
//
#include "downwash/controllers/quintic.hpp"
#include "downwash/simulation/flight_kernel.hpp"

namespace downwash::simulation {
inline namespace {  // NOLINT(google-build-namespaces)

using lane::Pack;
using lane::PackMask;

static_assert(lane_count % lane::pack_width == 0);

/// 0 where every hub is in a cell that is flyable throughout.
template <class Effect>
Pack flyable_doubt(const PlantModel& plant, const State<Pack>& state, const dynamics::Attitude<Pack>& a,
                   Effect& effect) {
    Pack doubt(0);
    for (int rotor = 0; rotor < plant.rotor_count; ++rotor) {
        if (effect.same_as(rotor) == rotor) {
            const auto hub = dynamics::rotor_position(plant, a, state.plant.q[0], state.plant.q[1], rotor);
            doubt = lane::max(doubt, effect.doubt(rotor, hub.x, hub.z));
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

template <class Law, class Effect>
void fly_group(const FlightKernelModel& model, const LaneGroup& group, int max_ticks, Effect effect) {
    FlightLanes& lanes = group.lanes;
    const PackMask is_active = group.load(lanes.is_active) > Pack(0);
    if (!any(is_active)) {
        return;
    }
    const Law& law = *static_cast<const Law*>(model.law);
    const PlantModel& plant = model.tick->plant;
    auto state = group.load<State<Pack>>(lanes.state);
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
    for (int n = 0; n < max_ticks; ++n) {
        controllers::Actuation<Pack> given;
        const State<Pack> next = tick(*model.tick, law, state, motion, reference, effect, given);
        tick_count = tick_count + Pack(1);
        reference = reference_at(group, tick_count, Pack(model.tick->tick_s));
        add_tick(sums, plant, state, next);
        for (int i = 0; i < 4; ++i) {
            before.q[i] = state.plant.q[i];
        }
        state = next;
        motion = dynamics::motion_at(plant, state.plant.q, state.plant.u);
        rejection = broken_rule(model.limits, given.saturation, state, reference);
        const Pack* u = state.plant.u;
        const PackMask is_slow = lane::sqrt(u[0] * u[0] + u[1] * u[1]) < max_speed_m_s;
        const PackMask is_due =
            (motion_m(model.reach, anchor.q, state.plant.q) > free_motion_m) | (tick_count >= look_tick);
        unclear = select(is_due | !is_slow, Pack(1), Pack(0));
        if constexpr (requires { effect.doubt(0, u[0], u[0]); }) {
            unclear = lane::max(unclear, flyable_doubt(plant, state, motion.attitude, effect));
        }
        if (any(is_active & ((rejection > Pack(0)) | (unclear > Pack(0)) | (tick_count >= ticks)))) {
            break;
        }
    }
    group.store(state, lanes.state);
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
        if (model.has_map) {
            fly_group<Law>(model, {lanes, first}, max_ticks, MapEffect<Pack>(model.maps));
        } else {
            fly_group<Law>(model, {lanes, first}, max_ticks, NoEffect{});
        }
    }
}

template <class... Laws>
FlightKernel kernel_among(std::size_t law, const std::variant<Laws...>* /*all*/) {
    static constexpr FlightKernel of_law[] = {fly_lanes<Laws>...};
    return of_law[law];
}

/// The kernel of a law, by its number in ControlLaw.
inline FlightKernel kernel_of(std::size_t law) {
    return kernel_among(law, static_cast<const ControlLaw*>(nullptr));
}

}  // namespace
}  // namespace downwash::simulation
