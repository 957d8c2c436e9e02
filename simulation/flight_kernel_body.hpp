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

/// The patches of one layer that the lanes are in.
struct alignas(64) LanePatches {
    double u[lane::pack_width], w[lane::pack_width];
    double steps_x[lane::pack_width], steps_z[lane::pack_width];
    double corner[4][lane::pack_width];
    double doubt[lane::pack_width];  ///< 0 where the cell is flyable throughout
};

/// The effect looked up in the map, as MapEffect does for one flight.
class LaneMapEffect {
 public:
    explicit LaneMapEffect(const FlightKernelModel& model) : model_(model) {
        for (LanePatches& patches : patches_) {
            for (int lane = 0; lane < lane::pack_width; ++lane) {
                enter(nowhere, patches, lane);
            }
        }
    }

    [[nodiscard]] int same_as(int rotor) const { return model_.same_as[rotor]; }

    Pack operator()(int rotor, Pack x_m, Pack z_m) const {
        const MapView& view = model_.view[rotor];
        LanePatches& patches = patches_[rotor];
        const Pack u = (x_m - Pack(view.x_low_m)) * Pack(view.cells_per_m);
        const Pack w = (z_m - Pack(view.z_low_m)) * Pack(view.cells_per_m);
        Pack s = (u - Pack::load(patches.u)) * Pack::load(patches.steps_x);
        Pack t = (w - Pack::load(patches.w)) * Pack::load(patches.steps_z);
        const PackMask is_there = (s >= Pack(0)) & (s < Pack(1)) & (t >= Pack(0)) & (t < Pack(1));
        if (const unsigned int elsewhere = bits_of(!is_there); elsewhere != 0) {
            return look_up(rotor, x_m, z_m, u, w, elsewhere);
        }
        return factor(patches, s, t);
    }

    /// 0 in lanes whose hub is, where this rotor's K was last asked for, in a cell that is flyable throughout.
    [[nodiscard]] Pack doubt(int rotor) const { return Pack::load(patches_[rotor].doubt); }

 private:
    static void enter(const MapPatch& patch, LanePatches& patches, int lane) {
        patches.u[lane] = patch.u;
        patches.w[lane] = patch.w;
        patches.steps_x[lane] = patch.steps_x;
        patches.steps_z[lane] = patch.steps_z;
        for (int i = 0; i < 4; ++i) {
            patches.corner[i][lane] = patch.corner[i];
        }
        patches.doubt[lane] = patch.flyability == CellFlyability::flyable ? 0 : 1;
    }

    static Pack factor(const LanePatches& patches, Pack s, Pack t) {
        const Pack corner[4] = {Pack::load(patches.corner[0]), Pack::load(patches.corner[1]),
                                Pack::load(patches.corner[2]), Pack::load(patches.corner[3])};
        return bilinear(corner, s, t);
    }

    /// The same where some lanes, given as bits, have left their patches.
    [[gnu::noinline]] Pack look_up(int rotor, Pack x_m, Pack z_m, Pack u, Pack w, unsigned int elsewhere) const {
        const MapView& view = model_.view[rotor];
        LanePatches& patches = patches_[rotor];
        unsigned int outside = 0;
        for (; elsewhere != 0; elsewhere &= elsewhere - 1) {
            const int lane = __builtin_ctz(elsewhere);
            if (view.contains(u[lane], w[lane])) {
                enter(patch_at(view, u[lane], w[lane]), patches, lane);
            } else {
                enter(nowhere, patches, lane);
                outside |= 1U << static_cast<unsigned int>(lane);
            }
        }
        const Pack s = (u - Pack::load(patches.u)) * Pack::load(patches.steps_x);
        const Pack t = (w - Pack::load(patches.w)) * Pack::load(patches.steps_z);
        Pack result = factor(patches, s, t);
        for (; outside != 0; outside &= outside - 1) {
            const int lane = __builtin_ctz(outside);
            result.set(lane, model_.factor_outside(model_.context, rotor, x_m[lane], z_m[lane]));
        }
        return result;
    }

    static constexpr MapPatch nowhere = no_patch;  // a copy with internal linkage

    const FlightKernelModel& model_;
    mutable LanePatches patches_[max_rotors + 1];
};

struct LaneNoEffect {
    [[nodiscard]] int same_as(int) const { return 0; }
    [[nodiscard]] Pack doubt(int) const { return Pack(0); }
    Pack operator()(int, Pack, Pack) const { return Pack(1); }
};

/// 0 where every hub is in a cell that is flyable throughout.
template <class Factor>
Pack flyable_doubt(const FlightKernelModel& model, const State<Pack>& state, const dynamics::Attitude<Pack>& a,
                   const Factor& factor) {
    const PlantModel& plant = model.tick->plant;
    Pack doubt(0);
    for (int rotor = 0; rotor < plant.rotor_count; ++rotor) {
        if (factor.same_as(rotor) == rotor) {
            const auto hub = dynamics::rotor_position(plant, a, state.plant.q[0], state.plant.q[1], rotor);
            factor(rotor, hub.x, hub.z);
            doubt = lane::max(doubt, factor.doubt(rotor));
        }
    }
    return doubt;
}

/// No point of the robot, and no hub, has moved farther between two poses [m].
inline Pack motion_bound_m(const FlightKernelModel& model, const State<Pack>& state, const Pack anchor[4]) {
    const Pack dx = state.plant.q[0] - anchor[0];
    const Pack dz = state.plant.q[1] - anchor[1];
    const Pack pitch = lane::abs(state.plant.q[2] - anchor[2]);
    const Pack arm = lane::abs(state.plant.q[2] + state.plant.q[3] - (anchor[2] + anchor[3]));
    return lane::sqrt(dx * dx + dz * dz) +
           lane::max(Pack(model.body_reach_m) * pitch,
                     Pack(model.joint_reach_m) * pitch + Pack(model.arm_length_m) * arm);
}

/// As many neighbouring lanes as fit into a pack.
struct LaneGroup {
    FlightLanes& lanes;
    int first;

    Pack load(const double (&from)[lane_count]) const { return Pack::load(from + first); }
    void store(Pack pack, double (&to)[lane_count]) const { pack.store(to + first); }
    template <int Count>
    void load(Pack (&packs)[Count], const double (&from)[Count][lane_count]) const {
        for (int i = 0; i < Count; ++i) {
            packs[i] = load(from[i]);
        }
    }
    template <int Count>
    void store(const Pack (&packs)[Count], double (&to)[Count][lane_count]) const {
        for (int i = 0; i < Count; ++i) {
            store(packs[i], to[i]);
        }
    }
};

inline State<Pack> load_state(const LaneGroup& group) {
    const FlightLanes& lanes = group.lanes;
    State<Pack> state;
    group.load(state.plant.q, lanes.q);
    group.load(state.plant.u, lanes.u);
    group.load(state.plant.thrust_n, lanes.thrust_n);
    state.plant.energy_j = group.load(lanes.energy_j);
    group.load(state.controller.position_integral, lanes.position_integral);
    state.controller.pitch_rate_integral = group.load(lanes.pitch_rate_integral);
    state.controller.arm_integral = group.load(lanes.arm_integral);
    state.controller.pitch_reference_rad = group.load(lanes.pitch_reference_rad);
    state.controller.pitch_reference_rate = group.load(lanes.pitch_reference_rate);
    state.controller.rate_reference = group.load(lanes.rate_reference);
    return state;
}

inline void store_state(const State<Pack>& state, const LaneGroup& group) {
    FlightLanes& lanes = group.lanes;
    group.store(state.plant.q, lanes.q);
    group.store(state.plant.u, lanes.u);
    group.store(state.plant.thrust_n, lanes.thrust_n);
    group.store(state.plant.energy_j, lanes.energy_j);
    group.store(state.controller.position_integral, lanes.position_integral);
    group.store(state.controller.pitch_rate_integral, lanes.pitch_rate_integral);
    group.store(state.controller.arm_integral, lanes.arm_integral);
    group.store(state.controller.pitch_reference_rad, lanes.pitch_reference_rad);
    group.store(state.controller.pitch_reference_rate, lanes.pitch_reference_rate);
    group.store(state.controller.rate_reference, lanes.rate_reference);
}

inline controllers::Setpoint<Pack> reference_at(const LaneGroup& group, Pack tick, Pack tick_s) {
    const FlightLanes& lanes = group.lanes;
    const Pack inverse_duration = group.load(lanes.inverse_duration_1_s);
    const Pack s = tick * tick_s * inverse_duration;
    const PackMask is_end = tick >= group.load(lanes.ticks);
    controllers::Setpoint<Pack> reference;
    for (int axis = 0; axis < 3; ++axis) {
        Pack coefficient[6];
        group.load(coefficient, lanes.coefficient[axis]);
        const auto at = controllers::quintic_at(coefficient, s, inverse_duration);
        reference.position[axis] = select(is_end, group.load(lanes.end[0][axis]), at.position);
        reference.velocity[axis] = select(is_end, group.load(lanes.end[1][axis]), at.velocity);
        reference.acceleration[axis] = select(is_end, group.load(lanes.end[2][axis]), at.acceleration);
    }
    return reference;
}

template <class Factor>
void fly_group(const FlightKernelModel& model, const LaneGroup& group, int most_ticks, const Factor& factor) {
    FlightLanes& lanes = group.lanes;
    const PackMask is_active = group.load(lanes.is_active) > Pack(0);
    if (!any(is_active)) {
        return;
    }
    State<Pack> state = load_state(group);
    controllers::Setpoint<Pack> reference;
    group.load(reference.position, lanes.reference[0]);
    group.load(reference.velocity, lanes.reference[1]);
    group.load(reference.acceleration, lanes.reference[2]);
    Pack tick_count = group.load(lanes.tick);
    Pack length_m = group.load(lanes.length_m);
    Pack rejection(0);
    Pack unclear(0);
    Pack anchor[4];
    group.load(anchor, lanes.anchor);
    Pack before[4];
    group.load(before, lanes.q);
    const Pack free_motion_m = group.load(lanes.free_motion_m);
    const Pack look_tick = group.load(lanes.look_tick);
    const Pack max_speed_m_s = group.load(lanes.max_speed_m_s);
    const Pack ticks = group.load(lanes.ticks);
    const PlantModel& plant = model.tick->plant;
    dynamics::Motion<Pack> motion = dynamics::motion_at(plant, state.plant.q, state.plant.u);
    for (int n = 0; n < most_ticks; ++n) {
        TickRecord<Pack> record;
        const State<Pack> next = tick(*model.tick, state, motion, reference, factor, record);
        tick_count = tick_count + Pack(1);
        reference = reference_at(group, tick_count, Pack(model.tick->tick_s));
        length_m = length_m + lane::sqrt(squared_step_m2(plant, state, next));
        for (int i = 0; i < 4; ++i) {
            before[i] = state.plant.q[i];
        }
        state = next;
        motion = dynamics::motion_at(plant, state.plant.q, state.plant.u);
        rejection = broken_rule(model.limits, record.saturation, state, reference);
        const Pack* u = state.plant.u;
        const PackMask is_slow = lane::sqrt(u[0] * u[0] + u[1] * u[1]) < max_speed_m_s;
        const PackMask is_due = (motion_bound_m(model, state, anchor) > free_motion_m) | (tick_count >= look_tick);
        unclear = select(is_due | !is_slow, Pack(1), Pack(0));
        if (model.has_map) {
            unclear = lane::max(unclear, flyable_doubt(model, state, motion.attitude, factor));
        }
        if (any(is_active & ((rejection > Pack(0)) | (unclear > Pack(0)) | (tick_count >= ticks)))) {
            break;
        }
    }
    store_state(state, group);
    group.store(reference.position, lanes.reference[0]);
    group.store(reference.velocity, lanes.reference[1]);
    group.store(reference.acceleration, lanes.reference[2]);
    group.store(tick_count, lanes.tick);
    group.store(length_m, lanes.length_m);
    group.store(before, lanes.before);
    group.store(rejection, lanes.rejection);
    group.store(unclear, lanes.is_unclear);
}

#if defined(__AVX2__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// Everything in one place. With narrow registers it would not fit into the instruction cache, and what sanitizers add
// would keep the compiler busy for minutes.
[[gnu::flatten]]
#endif
inline void
fly_lanes(const FlightKernelModel& model, FlightLanes& lanes, int most_ticks) {
    for (int first = 0; first < lane_count; first += lane::pack_width) {
        if (model.has_map) {
            fly_group(model, {lanes, first}, most_ticks, LaneMapEffect(model));
        } else {
            fly_group(model, {lanes, first}, most_ticks, LaneNoEffect{});
        }
    }
}

}  // namespace
}  // namespace downwash::simulation
