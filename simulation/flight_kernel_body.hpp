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

static_assert(lane::pack_width == lane_count);

/// Where points are in a layer: its cells, and the place within them.
struct CellPlaces {
    Pack u, w;  ///< in cells, from the lower corner of the map
    bool is_inside[lane_count];
    bool all_inside;
};

CellPlaces places_in(const MapView& view, Pack x_m, Pack z_m) {
    CellPlaces at;
    at.u = (x_m - Pack(view.x_low_m)) * Pack(view.cells_per_m);
    at.w = (z_m - Pack(view.z_low_m)) * Pack(view.cells_per_m);
    const PackMask inside = (at.u >= Pack(0)) & (at.w >= Pack(0)) & (at.u < Pack(view.columns)) &
                            (at.w < Pack(view.rows));  // NaN is outside
    at.all_inside = true;
    for (int lane = 0; lane < lane_count; ++lane) {
        at.is_inside[lane] = inside.bits[lane] != 0;
        at.all_inside = at.all_inside && at.is_inside[lane];
    }
    if (!at.all_inside) {
        at.u = select(inside, at.u, Pack(0));
        at.w = select(inside, at.w, Pack(0));
    }
    return at;
}

/// AeroMap::factor() for four points.
Pack factor_in(const MapView& view, const CellPlaces& at) {
    Pack s, t, k00, k10, k01, k11;
    for (int lane = 0; lane < lane_count; ++lane) {
        const double u = at.u[lane];
        const double w = at.w[lane];
        const int i = static_cast<int>(u);
        const int k = static_cast<int>(w);
        const MapCell cell = view.cells[static_cast<std::uint32_t>(k) * view.columns + static_cast<std::uint32_t>(i)];
        const double a = (u - i) * cell.steps_x;
        const double b = (w - k) * cell.steps_z;
        const int ia = static_cast<int>(a);
        const int ib = static_cast<int>(b);
        const float* node = view.nodes + cell.first_node + static_cast<std::uint32_t>(ib) * (cell.steps_x + 1U) +
                            static_cast<std::uint32_t>(ia);
        const float* upper = node + cell.steps_x + 1U;
        s.set(lane, a - ia);
        t.set(lane, b - ib);
        k00.set(lane, node[0]);
        k10.set(lane, node[1]);
        k01.set(lane, upper[0]);
        k11.set(lane, upper[1]);
    }
    const Pack low = k00 + s * (k10 - k00);
    const Pack high = k01 + s * (k11 - k01);
    return low + t * (high - low);
}

/// The effect looked up in the map.
struct LaneMapEffect {
    const FlightKernelModel& model;

    [[nodiscard]] int same_as(int rotor) const { return model.same_as[rotor]; }

    Pack operator()(int rotor, Pack x_m, Pack z_m) const {
        const MapView& view = model.view[rotor];
        const CellPlaces at = places_in(view, x_m, z_m);
        Pack factor = factor_in(view, at);
        if (!at.all_inside) {
            for (int lane = 0; lane < lane_count; ++lane) {
                if (!at.is_inside[lane]) {
                    factor.set(lane, model.factor_outside(model.context, rotor, x_m[lane], z_m[lane]));
                }
            }
        }
        return factor;
    }
};

struct LaneNoEffect {
    [[nodiscard]] int same_as(int) const { return 0; }
    Pack operator()(int, Pack, Pack) const { return Pack(1); }
};

/// 1 where some hub is not in a cell that is flyable throughout.
Pack flyable_doubt(const FlightKernelModel& model, const State<Pack>& state) {
    const PlantModel& plant = model.tick->plant;
    const dynamics::Attitude<Pack> a = dynamics::attitude(plant, state.plant.q[2], state.plant.q[3]);
    unsigned doubt[lane_count] = {};
    for (int rotor = 0; rotor < plant.rotor_count; ++rotor) {
        if (model.same_as[rotor] != rotor) {
            continue;
        }
        const MapView& view = model.view[rotor];
        const auto hub = dynamics::rotor_position(plant, a, state.plant.q[0], state.plant.q[1], rotor);
        const CellPlaces at = places_in(view, hub.x, hub.z);
        for (int lane = 0; lane < lane_count; ++lane) {
            const auto i = static_cast<std::uint32_t>(static_cast<int>(at.u[lane]));
            const auto k = static_cast<std::uint32_t>(static_cast<int>(at.w[lane]));
            doubt[lane] |= static_cast<unsigned>(!at.is_inside[lane]) |
                           static_cast<unsigned>(view.flyability[k * view.columns + i] != CellFlyability::flyable);
        }
    }
    Pack result(0);
    for (int lane = 0; lane < lane_count; ++lane) {
        result.set(lane, doubt[lane]);
    }
    return result;
}

/// No point of the robot, and no hub, has moved farther between two poses [m].
Pack motion_bound_m(const FlightKernelModel& model, const State<Pack>& state, const Pack anchor[4]) {
    const Pack dx = state.plant.q[0] - anchor[0];
    const Pack dz = state.plant.q[1] - anchor[1];
    const Pack pitch = lane::abs(state.plant.q[2] - anchor[2]);
    const Pack arm = lane::abs(state.plant.q[2] + state.plant.q[3] - (anchor[2] + anchor[3]));
    return lane::sqrt(dx * dx + dz * dz) + lane::max(Pack(model.body_reach_m) * pitch,
                                                     Pack(model.joint_reach_m) * pitch + Pack(model.arm_length_m) * arm);
}

template <int Count>
void load(Pack (&packs)[Count], const double (&from)[Count][lane_count]) {
    for (int i = 0; i < Count; ++i) {
        packs[i] = Pack::load(from[i]);
    }
}
template <int Count>
void store(const Pack (&packs)[Count], double (&to)[Count][lane_count]) {
    for (int i = 0; i < Count; ++i) {
        packs[i].store(to[i]);
    }
}

State<Pack> load_state(const FlightLanes& lanes) {
    State<Pack> state;
    load(state.plant.q, lanes.q);
    load(state.plant.u, lanes.u);
    load(state.plant.thrust_n, lanes.thrust_n);
    state.plant.energy_j = Pack::load(lanes.energy_j);
    load(state.controller.position_integral, lanes.position_integral);
    state.controller.pitch_rate_integral = Pack::load(lanes.pitch_rate_integral);
    state.controller.arm_integral = Pack::load(lanes.arm_integral);
    state.controller.pitch_reference_rad = Pack::load(lanes.pitch_reference_rad);
    state.controller.pitch_reference_rate = Pack::load(lanes.pitch_reference_rate);
    state.controller.rate_reference = Pack::load(lanes.rate_reference);
    return state;
}

void store_state(const State<Pack>& state, FlightLanes& lanes) {
    store(state.plant.q, lanes.q);
    store(state.plant.u, lanes.u);
    store(state.plant.thrust_n, lanes.thrust_n);
    state.plant.energy_j.store(lanes.energy_j);
    store(state.controller.position_integral, lanes.position_integral);
    state.controller.pitch_rate_integral.store(lanes.pitch_rate_integral);
    state.controller.arm_integral.store(lanes.arm_integral);
    state.controller.pitch_reference_rad.store(lanes.pitch_reference_rad);
    state.controller.pitch_reference_rate.store(lanes.pitch_reference_rate);
    state.controller.rate_reference.store(lanes.rate_reference);
}

controllers::Setpoint<Pack> reference_at(const FlightLanes& lanes, Pack tick, Pack tick_s) {
    const Pack inverse_duration = Pack::load(lanes.inverse_duration_1_s);
    const Pack s = tick * tick_s * inverse_duration;
    const PackMask is_end = tick >= Pack::load(lanes.ticks);
    controllers::Setpoint<Pack> reference;
    for (int axis = 0; axis < 3; ++axis) {
        Pack coefficient[6];
        load(coefficient, lanes.coefficient[axis]);
        const auto at = controllers::quintic_at(coefficient, s, inverse_duration);
        reference.position[axis] = select(is_end, Pack::load(lanes.end[0][axis]), at.position);
        reference.velocity[axis] = select(is_end, Pack::load(lanes.end[1][axis]), at.velocity);
        reference.acceleration[axis] = select(is_end, Pack::load(lanes.end[2][axis]), at.acceleration);
    }
    return reference;
}

template <class Factor>
void fly_lanes_with(const FlightKernelModel& model, FlightLanes& lanes, int most_ticks, const Factor& factor) {
    State<Pack> state = load_state(lanes);
    controllers::Setpoint<Pack> reference;
    load(reference.position, lanes.reference[0]);
    load(reference.velocity, lanes.reference[1]);
    load(reference.acceleration, lanes.reference[2]);
    Pack tick_count = Pack::load(lanes.tick);
    Pack length_m = Pack::load(lanes.length_m);
    Pack fault(0);
    Pack unclear(0);
    Pack anchor[4];
    load(anchor, lanes.anchor);
    const Pack free_motion_m = Pack::load(lanes.free_motion_m);
    const Pack ticks = Pack::load(lanes.ticks);
    const PackMask is_active = Pack::load(lanes.is_active) > Pack(0);
    for (int n = 0; n < most_ticks; ++n) {
        TickRecord<Pack> record;
        const State<Pack> next = tick(*model.tick, state, reference, factor, record);
        tick_count = tick_count + Pack(1);
        reference = reference_at(lanes, tick_count, Pack(model.tick->tick_s));
        length_m = length_m + lane::sqrt(squared_step_m2(model.tick->plant, state, next));
        state = next;
        fault = broken_rule(model.limits, record.saturation, state, reference);
        unclear = select(motion_bound_m(model, state, anchor) > free_motion_m, Pack(1), Pack(0));
        if (model.has_map) {
            unclear = lane::max(unclear, flyable_doubt(model, state));
        }
        if (any(is_active & ((fault > Pack(0)) | (unclear > Pack(0)) | (tick_count >= ticks)))) {
            break;
        }
    }
    store_state(state, lanes);
    store(reference.position, lanes.reference[0]);
    store(reference.velocity, lanes.reference[1]);
    store(reference.acceleration, lanes.reference[2]);
    tick_count.store(lanes.tick);
    length_m.store(lanes.length_m);
    fault.store(lanes.fault);
    unclear.store(lanes.is_unclear);
}

void fly_lanes(const FlightKernelModel& model, FlightLanes& lanes, int most_ticks) {
    if (model.has_map) {
        fly_lanes_with(model, lanes, most_ticks, LaneMapEffect{model});
    } else {
        fly_lanes_with(model, lanes, most_ticks, LaneNoEffect{});
    }
}

}  // namespace
}  // namespace downwash::simulation
