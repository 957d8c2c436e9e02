#pragma once

// The body of every FlightKernel, compiled once for each set of instructions. Only flight_kernel_*.cpp include it: all
// that it makes has internal linkage, and it uses nothing of the standard library.

#include "downwash/base/lane_pack.hpp"
//
#include "downwash/controllers/quintic.hpp"
#include "downwash/simulation/flight_kernel.hpp"

namespace downwash::simulation {
inline namespace {  // NOLINT(google-build-namespaces)

using lane::Doubles;
using lane::Pack;
using lane::PackMask;

static_assert(lane::pack_width == lane_count);

// Vectors of integers, as wide as one of doubles.
typedef std::uint32_t Counts __attribute__((vector_size(16)));       // NOLINT(modernize-use-using)
typedef std::int32_t SignedCounts __attribute__((vector_size(16)));  // NOLINT(modernize-use-using)
typedef float Floats __attribute__((vector_size(16)));               // NOLINT(modernize-use-using)
typedef std::uint64_t Words __attribute__((vector_size(32)));        // NOLINT(modernize-use-using)

#ifdef __AVX2__
/// The whole part of numbers in [0, 2^31).
inline Counts whole(Doubles x) {
    return reinterpret_cast<Counts>(_mm256_cvttpd_epi32(x));
}
inline Doubles number(Counts x) {
    return _mm256_cvtepi32_pd(reinterpret_cast<__m128i>(x));
}
inline Doubles floats_in(Counts bits) {
    return _mm256_cvtps_pd(reinterpret_cast<__m128>(bits));
}
inline Counts low_half(Words x) {
    const __m256i even = _mm256_setr_epi32(0, 2, 4, 6, 0, 2, 4, 6);
    const __m256i gathered = _mm256_permutevar8x32_epi32(reinterpret_cast<__m256i>(x), even);
    return reinterpret_cast<Counts>(_mm256_castsi256_si128(gathered));
}
inline Counts high_half(Words x) {
    const __m256i odd = _mm256_setr_epi32(1, 3, 5, 7, 1, 3, 5, 7);
    const __m256i gathered = _mm256_permutevar8x32_epi32(reinterpret_cast<__m256i>(x), odd);
    return reinterpret_cast<Counts>(_mm256_castsi256_si128(gathered));
}
#else
inline Counts whole(Doubles x) {
    return reinterpret_cast<Counts>(__builtin_convertvector(x, SignedCounts));
}
inline Doubles number(Counts x) {
    return __builtin_convertvector(reinterpret_cast<SignedCounts>(x), Doubles);
}
inline Doubles floats_in(Counts bits) {
    return __builtin_convertvector(reinterpret_cast<Floats>(bits), Doubles);
}
inline Counts low_half(Words x) {
    return __builtin_convertvector(x, Counts);
}
inline Counts high_half(Words x) {
    return __builtin_convertvector(x >> 32, Counts);
}
#endif

/// Eight bytes each at four places.
template <class Element>
Words words_at(const Element* elements, Counts index) {
    Words words;
    for (int lane = 0; lane < lane_count; ++lane) {
        std::uint64_t word;
        __builtin_memcpy(&word, elements + index[lane], sizeof word);
        words[lane] = word;
    }
    return words;
}

/// Where points are in a layer.
struct CellPlaces {
    Counts cell;
    Doubles across, up;  ///< from the cell's lower corner, in [0, 1)
    PackMask is_inside;
};

inline CellPlaces places_in(const MapView& view, Pack x_m, Pack z_m) {
    CellPlaces at;
    const Pack u = (x_m - Pack(view.x_low_m)) * Pack(view.cells_per_m);
    const Pack w = (z_m - Pack(view.z_low_m)) * Pack(view.cells_per_m);
    at.is_inside = (u >= Pack(0)) & (w >= Pack(0)) & (u < Pack(view.columns)) & (w < Pack(view.rows));  // not NaN
    const Doubles safe_u = select(at.is_inside, u, Pack(0)).values;
    const Doubles safe_w = select(at.is_inside, w, Pack(0)).values;
    const Counts i = whole(safe_u);
    const Counts k = whole(safe_w);
    at.cell = k * view.columns + i;
    at.across = safe_u - number(i);
    at.up = safe_w - number(k);
    return at;
}

/// AeroMap::factor() for every lane.
inline Pack factor_in(const MapView& view, const CellPlaces& at) {
    static_assert(sizeof(MapCell) == 8 && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "a cell is read as one word");
    const Words cells = words_at(view.cells, at.cell);
    const Counts steps = high_half(cells);
    const Counts steps_x = steps & 0xffffU;
    const Doubles a = at.across * number(steps_x);
    const Doubles b = at.up * number(steps >> 16U);
    const Counts ia = whole(a);
    const Counts ib = whole(b);
    const Counts node = low_half(cells) + ib * (steps_x + 1U) + ia;
    const Words lower = words_at(view.nodes, node);  // two neighbours each
    const Words upper = words_at(view.nodes, node + steps_x + 1U);
    const Doubles s = a - number(ia);
    const Doubles t = b - number(ib);
    const Doubles lower_left = floats_in(low_half(lower));
    const Doubles upper_left = floats_in(low_half(upper));
    const Doubles low = lower_left + s * (floats_in(high_half(lower)) - lower_left);
    const Doubles high = upper_left + s * (floats_in(high_half(upper)) - upper_left);
    return Pack(low + t * (high - low));
}

/// The effect looked up in the map.
struct LaneMapEffect {
    const FlightKernelModel& model;

    [[nodiscard]] int same_as(int rotor) const { return model.same_as[rotor]; }

    Pack operator()(int rotor, Pack x_m, Pack z_m) const {
        const MapView& view = model.view[rotor];
        const CellPlaces at = places_in(view, x_m, z_m);
        Pack factor = factor_in(view, at);
        if (!all(at.is_inside)) {
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
inline Pack flyable_doubt(const FlightKernelModel& model, const State<Pack>& state, const dynamics::Attitude<Pack>& a) {
    const PlantModel& plant = model.tick->plant;
    Counts doubt{};
    for (int rotor = 0; rotor < plant.rotor_count; ++rotor) {
        if (model.same_as[rotor] != rotor) {
            continue;
        }
        const MapView& view = model.view[rotor];
        const auto hub = dynamics::rotor_position(plant, a, state.plant.q[0], state.plant.q[1], rotor);
        const CellPlaces at = places_in(view, hub.x, hub.z);
        static_assert(static_cast<int>(CellFlyability::flyable) == 0);
        for (int lane = 0; lane < lane_count; ++lane) {
            doubt[lane] |= static_cast<std::uint32_t>(view.flyability[at.cell[lane]]);
        }
        doubt |= reinterpret_cast<Counts>(__builtin_convertvector(at.is_inside.bits, SignedCounts)) + 1U;
    }
    return Pack(number(doubt));
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

inline State<Pack> load_state(const FlightLanes& lanes) {
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

inline void store_state(const State<Pack>& state, FlightLanes& lanes) {
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

inline controllers::Setpoint<Pack> reference_at(const FlightLanes& lanes, Pack tick, Pack tick_s) {
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
    const PlantModel& plant = model.tick->plant;
    dynamics::Motion<Pack> motion = dynamics::motion_at(plant, state.plant.q, state.plant.u);
    for (int n = 0; n < most_ticks; ++n) {
        TickRecord<Pack> record;
        const State<Pack> next = tick(*model.tick, state, motion, reference, factor, record);
        tick_count = tick_count + Pack(1);
        reference = reference_at(lanes, tick_count, Pack(model.tick->tick_s));
        length_m = length_m + lane::sqrt(squared_step_m2(plant, state, next));
        state = next;
        motion = dynamics::motion_at(plant, state.plant.q, state.plant.u);
        fault = broken_rule(model.limits, record.saturation, state, reference);
        unclear = select(motion_bound_m(model, state, anchor) > free_motion_m, Pack(1), Pack(0));
        if (model.has_map) {
            unclear = lane::max(unclear, flyable_doubt(model, state, motion.attitude));
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

[[gnu::flatten]] inline void fly_lanes(const FlightKernelModel& model, FlightLanes& lanes, int most_ticks) {
    if (model.has_map) {
        fly_lanes_with(model, lanes, most_ticks, LaneMapEffect{model});
    } else {
        fly_lanes_with(model, lanes, most_ticks, LaneNoEffect{});
    }
}

}  // namespace
}  // namespace downwash::simulation
