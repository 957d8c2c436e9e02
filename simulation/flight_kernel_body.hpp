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

/// The map along the flights of a group of lanes.
using LaneMaps = MapEffect<Pack, LentPatches<lane_count>>;

/// 0 where every hub is in a cell that is flyable throughout.
/// @param scene_x_m,scene_z_m where the surfaces are, from where the map has them
inline Pack flyable_doubt(const PlantModel& plant, const VehicleState<Pack>& state, const dynamics::Attitude<Pack>& a,
                          Pack scene_x_m, Pack scene_z_m, LaneMaps& field) {
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
    PackMask is_active;

    LaneGroup(FlightLanes& all, int first_lane) : lanes(all), first(first_lane) {
        is_active = load(lanes.is_active) > Pack(0);
    }

    Pack load(const double (&from)[lane_count]) const { return lane::load<Pack>(from + first); }
    /// Lanes that only fill the pack stay as they are, so that they never fly far from where they were put.
    void store(Pack pack, double (&to)[lane_count]) const { select(is_active, pack, load(to)).store(to + first); }

    /// A struct of packs.
    template <class Struct, std::size_t Count>
    void load(const double (&from)[Count][lane_count], Struct& to) const {
        static_assert(number_count<Pack, Struct> == Count);
        for (int i = 0; i < static_cast<int>(Count); ++i) {
            set_number_at(to, i, load(from[i]));
        }
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
    if (!any(is_end)) {
        return reference;
    }
    BasicReferencePoint<Pack> end;
    group.load(lanes.end, end);
    return select_each(is_end, end, reference);
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

/// Where the lanes' vehicles were at the last ticks, as a ring: nothing moves when a tick has passed. Older motions,
/// for long delays, stay in the lanes' track.
class PastMotions {
 public:
    PastMotions(const FlightKernelModel& model, const LaneGroup& group)
        : group_(group), track_ticks_(model.track_ticks) {}

    void read(const WorldMemory<Pack>& memory) {
        now_ = 0;
        for (int age = 1; age <= recent_ticks; ++age) {
            past_[-age & mask] = memory.past[age - 1];
        }
    }
    /// @param age in ticks, from 1 to recent_ticks, or to the model's track_ticks
    /// @return for more than recent_ticks: until it is asked again
    [[nodiscard]] const PastMotion<Pack>& at(int age) {
        if (age <= recent_ticks) {
            return past_[(now_ - age) & mask];
        }
        group_.load(row(passed_ - age).motion, old_);
        return old_;
    }
    /// A tick has passed. @param then the state at its beginning
    void pass(const dynamics::PlantState<Pack>& then) {
        if (track_ticks_ > 0) {
            TrackRow& now = row(passed_++);
            for (int i = 0; i < 4; ++i) {
                group_.store(then.q[i], now.motion[i]);
                group_.store(then.u[i], now.motion[4 + i]);
            }
        }
        PastMotion<Pack>& past = past_[now_];
        for (int i = 0; i < 4; ++i) {
            past.q[i] = then.q[i];
            past.u[i] = then.u[i];
        }
        now_ = (now_ + 1) & mask;
    }
    void write(WorldMemory<Pack>& memory) const {
        for (int age = 1; age <= recent_ticks; ++age) {
            memory.past[age - 1] = past_[(now_ - age) & mask];
        }
        for (int i = 0; i < track_ticks_; ++i) {
            PastMotion<Pack> motion;
            group_.load(row(passed_ - track_ticks_ + i).motion, motion);
            group_.store(motion, row(i - track_ticks_).motion);
        }
    }

 private:
    /// @param tick since read(); negative before
    [[nodiscard]] TrackRow& row(int tick) const { return group_.lanes.track[0][track_ticks_ + tick]; }

    static constexpr int mask = 3;
    static_assert(recent_ticks <= mask);
    const LaneGroup& group_;
    int track_ticks_;
    int passed_ = 0;  ///< ticks since read()
    PastMotion<Pack> past_[mask + 1];
    PastMotion<Pack> old_;
    int now_ = 0;
};

/// A law as what flies: with its aids, if it can have any. @param law the law itself
template <class Flown>
[[gnu::always_inline]] inline Flown flown(const void* law) {
    if constexpr (controllers::is_aided<Flown>) {
        return {*static_cast<std::remove_reference_t<decltype(Flown::law)>*>(law)};
    } else {
        return *static_cast<const Flown*>(law);
    }
}

/// The nominal world, tick by tick.
template <class Law>
class NominalWorld {
 public:
    NominalWorld(const FlightKernelModel& model, const LaneGroup& group, const VehicleState<Pack>& state)
        : model_(model), past_(model, group), late_(lateness(Pack(model.delay_ticks))), motion_(&motions_[0]) {
        WorldMemory<Pack> memory;
        group.load(group.lanes.world_memory, memory);
        past_.read(memory);
        *motion_ = dynamics::motion_at(model.tick.plant, state.plant.q, state.plant.u);
        if (is_one_tick_late()) {
            const PastMotion<Pack>& then = past_.at(1);
            motions_[1] = dynamics::motion_at(model.tick.plant, then.q, then.u);
        }
    }

    [[gnu::always_inline]] void tick(const Law& law, Pack /*tick*/, const VehicleState<Pack>& state,
                                     const BasicReferencePoint<Pack>& reference, LaneMaps& field,
                                     controllers::Actuation<Pack>& given, VehicleState<Pack>& next) {
        dynamics::PlantState<Pack> looked_back;
        const dynamics::PlantState<Pack>* seen = &state.plant;
        const dynamics::Motion<Pack>* seen_motion = motion_;
        dynamics::Motion<Pack>* const other = motion_ == &motions_[0] ? &motions_[1] : &motions_[0];
        if (model_.delay_ticks > 0) {
            look_back(
                late_, state.plant, [this](int age) -> const PastMotion<Pack>& { return past_.at(age); }, looked_back);
            seen = &looked_back;
            seen_motion = other;
            if (!is_one_tick_late()) {
                *other = dynamics::motion_at(model_.tick.plant, looked_back.q, looked_back.u);
            }
        }
        nominal_tick(model_.tick, law, *seen, *seen_motion, state, *motion_, reference, field, given, next);
        if (model_.keeps_past) {
            past_.pass(state.plant);
        }
        motion_ = other;
        *motion_ = dynamics::motion_at(model_.tick.plant, next.plant.q, next.plant.u);
    }

    [[nodiscard]] const dynamics::Attitude<Pack>& attitude() const { return motion_->attitude; }
    [[nodiscard]] Pack scene_x_m() const { return Pack(0); }
    [[nodiscard]] Pack scene_z_m() const { return Pack(0); }

    void store(const LaneGroup& group) const {
        if (model_.keeps_past) {
            WorldMemory<Pack> memory;
            group.load(group.lanes.world_memory, memory);
            past_.write(memory);
            group.store(memory, group.lanes.world_memory);
        }
    }

 private:
    /// Then the motion of what the controller sees is that of the tick before.
    [[nodiscard]] bool is_one_tick_late() const { return model_.delay_ticks == 1; }

    const FlightKernelModel& model_;
    PastMotions past_;
    Lateness<Pack> late_;
    dynamics::Motion<Pack> motions_[2];
    dynamics::Motion<Pack>* motion_;  ///< that of the state
};

/// A world for every lane, tick by tick.
template <class Law, bool may_have_wash>
class OtherWorlds {
 public:
    OtherWorlds(const FlightKernelModel& model, const LaneGroup& group, const VehicleState<Pack>& state)
        : model_(model), group_(group), past_(model, group), first_tick_(group.load(group.lanes.first_tick)) {
        group.load(group.lanes.world, world_);
        plant_ = plant_in(model.tick, world_);
        late_ = lateness(world_.delay_ticks);
        attitude_ = dynamics::attitude(plant_, state.plant.q[2], state.plant.q[3]);
        WorldMemory<Pack> memory;
        group.load(group.lanes.world_memory, memory);
        past_.read(memory);
        for (int i = 0; i < 3; ++i) {
            gust_[i] = memory.gust[i];
        }
        for (Pack& noise : noise_) {
            noise = Pack(0);
        }
    }

    [[gnu::always_inline]] void tick(const Law& law, Pack tick, const VehicleState<Pack>& state,
                                     const BasicReferencePoint<Pack>& reference, LaneMaps& field,
                                     controllers::Actuation<Pack>& given, VehicleState<Pack>& next) {
        if (model_.has_noise) {
            draw_noises(model_, group_, first_tick_ + tick, noise_);
        }
        dynamics::PlantState<Pack> seen;
        look_back(
            late_, state.plant, [this](int age) -> const PastMotion<Pack>& { return past_.at(age); }, seen);
        add_errors(world_, noise_, seen);
        move_in_world<may_have_wash>(model_.tick, law, world_, plant_, seen, wind_in(world_, gust_), state, attitude_,
                                     reference, field, given, next);
        past_.pass(state.plant);
        pass_gusts(world_, noise_, gust_);
    }

    [[nodiscard]] const dynamics::Attitude<Pack>& attitude() const { return attitude_; }
    [[nodiscard]] Pack scene_x_m() const { return world_.scene_x_m; }
    [[nodiscard]] Pack scene_z_m() const { return world_.scene_z_m; }

    void store(const LaneGroup& group) const {
        WorldMemory<Pack> memory;
        past_.write(memory);
        for (int i = 0; i < 3; ++i) {
            memory.gust[i] = gust_[i];
        }
        group.store(memory, group.lanes.world_memory);
    }

 private:
    const FlightKernelModel& model_;
    const LaneGroup& group_;
    WorldNumbers<Pack> world_;
    BasicPlantModel<Pack> plant_;
    PastMotions past_;
    Lateness<Pack> late_;
    Pack gust_[3];
    Pack noise_[noise_count];
    dynamics::Attitude<Pack> attitude_;  ///< of the plant
    Pack first_tick_;
};

template <class Law, TickKind kind>
struct WorldsOf {
    using Type = OtherWorlds<Law, kind == TickKind::in_wash>;
};
template <class Law>
struct WorldsOf<Law, TickKind::nominal> {
    using Type = NominalWorld<Law>;
};

/// After so many times that lanes looked around the kernel returns, so that a flight among many obstacles can be ended.
inline constexpr int max_looks = 16;

/// Flies a group of lanes until one of them wants attention: see FlightKernel.
/// @tparam Flown the law as what flies
template <class Flown, TickKind kind>
void fly_group(const FlightKernelModel& model, const LaneGroup& group, int max_ticks) {
    FlightLanes& lanes = group.lanes;
    if (!any(group.is_active)) {
        return;
    }
    const auto law = flown<Flown>(model.law);
    const PlantModel& plant = model.tick.plant;
    LaneMaps field(model.maps, {group.first, lanes.patches});
    VehicleState<Pack> states[2];
    VehicleState<Pack>* state = &states[0];
    group.load(lanes.state, *state);
    BasicReferencePoint<Pack> reference;
    group.load(lanes.reference, reference);
    Pack tick_count = group.load(lanes.tick);
    BasicFlightSums<Pack> sums;
    group.load(lanes.sums, sums);
    Pack rejection(0);
    Pack unclear(0);
    Coordinates anchor;
    group.load(lanes.anchor, anchor);
    Pack free_motion_m = group.load(lanes.free_motion_m);
    const Pack look_tick = group.load(lanes.look_tick);
    const Pack max_speed_m_s = group.load(lanes.max_speed_m_s);
    const bool has_max_speed = any(max_speed_m_s < Pack(__builtin_huge_val()));
    const Pack ticks = group.load(lanes.ticks);
    typename WorldsOf<Flown, kind>::Type world(model, group, *state);
    int looks = 0;
    for (int n = 0; n < max_ticks; ++n) {
        VehicleState<Pack>* const next = state == &states[0] ? &states[1] : &states[0];
        controllers::Actuation<Pack> given;
        world.tick(law, tick_count, *state, reference, field, given, *next);
        tick_count = tick_count + Pack(1);
        reference = reference_at(group, tick_count, Pack(model.tick.tick_s));
        add_tick(sums, plant, *state, *next);
        state = next;
        rejection = broken_rule(model.limits, given.saturation, *state, reference);
        PackMask is_due = (motion_m(model.reach, anchor.q, state->plant.q) > free_motion_m) | (tick_count >= look_tick);
        if (has_max_speed) {
            const Pack* u = state->plant.u;
            is_due = is_due | !(lane::sqrt(u[0] * u[0] + u[1] * u[1]) < max_speed_m_s);
        }
        unclear =
            lane::max(select(is_due, Pack(1), Pack(0)),
                      flyable_doubt(plant, *state, world.attitude(), world.scene_x_m(), world.scene_z_m(), field));
        if (any(group.is_active & ((rejection > Pack(0)) | (tick_count >= ticks)))) {
            break;
        }
        if (const unsigned int due = lane::bits_of(group.is_active & (unclear > Pack(0))); due != 0) {
            // Nothing else leaves its place: most checks end with lanes that fly on.
            const VehicleState<Pack>& before = state == &states[0] ? states[1] : states[0];
            for (int i = 0; i < 4; ++i) {
                group.store(before.plant.q[i], lanes.before[i]);
                group.store(state->plant.q[i], lanes.state[i]);
            }
            group.store(tick_count, lanes.tick);
            group.store(rejection, lanes.rejection);
            group.store(unclear, lanes.is_unclear);
            model.look_around(lanes.flights[0], due << static_cast<unsigned int>(group.first));
            rejection = group.load(lanes.rejection);
            unclear = group.load(lanes.is_unclear);
            if (++looks == max_looks || any(group.is_active & ((rejection > Pack(0)) | (unclear > Pack(0))))) {
                break;
            }
            group.load(lanes.anchor, anchor);
            free_motion_m = group.load(lanes.free_motion_m);
        }
    }
    const VehicleState<Pack>& before = state == &states[0] ? states[1] : states[0];
    for (int i = 0; i < 4; ++i) {
        group.store(before.plant.q[i], lanes.before[i]);
    }
    group.store(*state, lanes.state);
    world.store(group);
    group.store(reference, lanes.reference);
    group.store(tick_count, lanes.tick);
    group.store(sums, lanes.sums);
    group.store(rejection, lanes.rejection);
    group.store(unclear, lanes.is_unclear);
}

/// The kernel of one law.
template <class Flown>
#if defined(__AVX2__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// Everything in one place. With narrow registers it would not fit into the instruction cache, and what sanitizers add
// would keep the compiler busy for minutes.
[[gnu::flatten]]
#endif
void
fly_lanes(const FlightKernelModel& model, FlightLanes& lanes, int max_ticks) {
    for (int first = 0; first < lane_count; first += lane::pack_width) {
        const LaneGroup group(lanes, first);
        switch (model.kind) {
            case TickKind::nominal:
                fly_group<Flown, TickKind::nominal>(model, group, max_ticks);
                break;
            case TickKind::in_world:
                fly_group<Flown, TickKind::in_world>(model, group, max_ticks);
                break;
            case TickKind::in_wash:
                fly_group<Flown, TickKind::in_wash>(model, group, max_ticks);
                break;
        }
    }
}

/// What flies by a law: the law with its aids, of which it may have none. A type of its own for a law without them
/// would double the kernels and make none of them faster.
template <class Law>
struct FlownBy {
    using Type = Law;
};
template <controllers::CanBeAided Law>
struct FlownBy<Law> {
    using Type = controllers::Aided<Law>;
};

template <class... Laws>
FlightKernel kernel_among(std::size_t law, const std::variant<Laws...>* /*all*/) {
    static constexpr FlightKernel of_law[] = {fly_lanes<typename FlownBy<Laws>::Type>...};
    return of_law[law];
}

/// The kernel of a law, by its number in FlownLaw.
inline FlightKernel kernel_of(std::size_t law) {
    return kernel_among(law, static_cast<const FlownLaw*>(nullptr));
}

}  // namespace
}  // namespace downwash::simulation
