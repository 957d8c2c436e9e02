#pragma once

// The body of every SpaceKernel, compiled once for each set of instructions and number of joints. Only sources made of
// space_kernel.cpp.in include it: all that it makes has internal linkage. Law and plant are functions of their own:
// each is compiled once, whatever they are combined with.

#include "downwash/base/lane_pack.hpp"
//
#include "downwash/base/numbers.hpp"
#include "downwash/controllers/quintic.hpp"
#include "downwash/simulation/noise.hpp"
#include "downwash/simulation/space_kernel.hpp"
#include "downwash/simulation/space_rules.hpp"
#include "downwash/simulation/space_tick.hpp"

namespace downwash::simulation {
inline namespace {  // NOLINT(google-build-namespaces)

using lane::Pack;
using lane::PackMask;

static_assert(lane_count % lane::pack_width == 0);

/// As many neighbouring lanes as fit into a pack.
class SpaceLaneGroup {
 public:
    SpaceLaneGroup(const double (&active)[lane_count], int first_lane) : first(first_lane) {
        is_active = load(active) > Pack(0);
    }

    [[nodiscard]] Pack load(const double (&from)[lane_count]) const { return lane::load<Pack>(from + first); }
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

    int first;
    PackMask is_active;
};

/// The coordinates of every lane.
template <int n>
struct SpaceCoordinates {
    Pack q[dynamics::space_coordinates<n>];
};

template <int n>
BasicSpacePoint<Pack, n> space_reference_at(const SpaceLaneGroup& group, const SpaceLanes<n>& lanes, Pack tick,
                                            Pack tick_s) {
    const Pack inverse_duration = group.load(lanes.inverse_duration_1_s);
    const Pack s = tick * tick_s * inverse_duration;
    BasicSpacePoint<Pack, n> reference;
    for (int axis = 0; axis < space_axes<n>; ++axis) {
        Pack coefficient[6];
        for (int power = 0; power < 6; ++power) {
            coefficient[power] = group.load(lanes.coefficient[axis][power]);
        }
        const auto at = controllers::quintic_at(coefficient, s, inverse_duration);
        reference.position[axis] = at.position;
        reference.velocity[axis] = at.velocity;
        reference.acceleration[axis] = at.acceleration;
    }
    const PackMask is_end = tick >= group.load(lanes.ticks);
    if (any(is_end)) {
        BasicSpacePoint<Pack, n> end;
        group.load(lanes.end, end);
        for (int i = 0; i < number_count<Pack, BasicSpacePoint<Pack, n>>; ++i) {
            set_number_at(reference, i, select(is_end, number_at<Pack>(end, i), number_at<Pack>(reference, i)));
        }
    }
    return reference;
}

/// The standard normal numbers that the lanes' worlds draw for a tick; zeros in a world without noise.
template <int n>
void draw_space_noises(const SpaceKernelModel<n>& model, const SpaceLaneGroup& group, const SpaceLanes<n>& lanes,
                       Pack tick, Pack noise[drawn_space_noise_count]) {
    alignas(sizeof(Pack)) double numbers[drawn_space_noise_count][lane::pack_width] = {};
    for (int i = 0; i < lane::pack_width; ++i) {
        if (lanes.has_noise[group.first + i] > 0) {
            draw_space_noise(model.normal_levels, lanes.tape[group.first + i],
                             static_cast<std::int64_t>(lane::number_in(tick, i)), &numbers[0][i], lane::pack_width);
        }
    }
    for (int i = 0; i < drawn_space_noise_count; ++i) {
        noise[i] = lane::load<Pack>(numbers[i]);
    }
}

/// Where the vehicles of a group were at the last ticks: in the track of its lanes.
template <int n>
class SpaceTrack {
 public:
    SpaceTrack(const SpaceLaneGroup& group, SpaceTrackRow<n>* rows, int ticks)
        : group_(group), now_(rows + ticks), ticks_(ticks) {}

    /// @param age in ticks, from 1   @return until it is asked again
    [[nodiscard]] const PastSpaceMotion<Pack, n>& at(int age) {
        group_.load(now_[passed_ - age].motion, old_);
        return old_;
    }
    /// A tick has passed. @param then the state at its beginning
    void pass(const dynamics::SpaceState<Pack, n>& then) {
        auto& rows = now_[passed_++].motion;
        for (int i = 0; i < dynamics::space_coordinates<n>; ++i) {
            then.q[i].store(rows[i] + group_.first);
        }
        for (int i = 0; i < dynamics::space_speeds<n>; ++i) {
            then.u[i].store(rows[dynamics::space_coordinates<n> + i] + group_.first);
        }
    }
    /// The last ticks become those before the next call.
    void move_back() const {
        for (int i = -ticks_; i < 0; ++i) {
            PastSpaceMotion<Pack, n> motion;
            group_.load(now_[passed_ + i].motion, motion);
            group_.store(motion, now_[i].motion);
        }
    }

 private:
    const SpaceLaneGroup& group_;
    SpaceTrackRow<n>* now_;  ///< the row of the first tick of the call
    int ticks_;
    int passed_ = 0;
    PastSpaceMotion<Pack, n> old_;
};

/// A TurningSpaceField of a group: volumes or, if there is one, an effect that is asked lane by lane.
class LaneField {
 public:
    using Vector = dynamics::LaneVector<Pack>;
    using Rotation = dynamics::LaneRotation<Pack>;

    LaneField(const SpaceLaneGroup& group, const SpaceVolumeViews& views, VolumePatches<lane_count>* patches,
              const AskedSpaceEffect& ask, SpaceEffect* effect)
        : volumes_(views, patches, group.first), ask_(ask), effect_(effect), active_(lane::bits_of(group.is_active)) {}

    SidedFactor<Pack> at_rotor(int rotor, const Vector& hub_m) {
        return at_turned_rotor(rotor, hub_m, VolumeField<Pack, lane_count>::level());
    }
    SidedFactor<Pack> at_body(const Vector& center_m) {
        return at_turned_body(center_m, VolumeField<Pack, lane_count>::level());
    }
    SidedFactor<Pack> at_turned_rotor(int rotor, const Vector& hub_m, const Rotation& attitude) {
        return effect_ == nullptr ? volumes_.at_turned_rotor(rotor, hub_m, attitude)
                                  : asked_at_rotor(rotor, hub_m, attitude);
    }
    SidedFactor<Pack> at_turned_body(const Vector& center_m, const Rotation& attitude) {
        return effect_ == nullptr ? volumes_.at_turned_body(center_m, attitude) : asked_at_body(center_m, attitude);
    }
    Vector wall_nearness(const Vector& center_m) {
        return effect_ == nullptr ? volumes_.wall_nearness(center_m) : asked_of_walls(center_m);
    }

 private:
    static dynamics::LaneVector<double> vector_in(const Vector& v, int lane) {
        return {lane::number_in(v.x, lane), lane::number_in(v.y, lane), lane::number_in(v.z, lane)};
    }
    static dynamics::LaneRotation<double> rotation_in(const Rotation& r, int lane) {
        return {vector_in(r.first, lane), vector_in(r.second, lane), vector_in(r.third, lane)};
    }
    template <class Act>
    void for_each_lane(const Act& act) const {
        for (unsigned int left = active_; left != 0; left &= left - 1) {
            act(__builtin_ctz(left));
        }
    }
    static void put(const SidedFactor<double>& k, int lane, SidedFactor<Pack>& all) {
        lane::set_number(all.all, lane, k.all);
        lane::set_number(all.above, lane, k.above);
    }
    [[gnu::noinline]] SidedFactor<Pack> asked_at_rotor(int rotor, const Vector& hub_m, const Rotation& attitude) const {
        SidedFactor<Pack> all{Pack(1), Pack(1)};
        for_each_lane([&](int lane) {
            put(ask_.at_rotor(effect_, rotor, vector_in(hub_m, lane), rotation_in(attitude, lane)), lane, all);
        });
        return all;
    }
    [[gnu::noinline]] SidedFactor<Pack> asked_at_body(const Vector& center_m, const Rotation& attitude) const {
        SidedFactor<Pack> all{Pack(1), Pack(1)};
        for_each_lane([&](int lane) {
            put(ask_.at_body(effect_, vector_in(center_m, lane), rotation_in(attitude, lane)), lane, all);
        });
        return all;
    }
    [[gnu::noinline]] Vector asked_of_walls(const Vector& center_m) const {
        Vector all{Pack(0), Pack(0), Pack(0)};
        for_each_lane([&](int lane) {
            const dynamics::LaneVector<double> towards = ask_.wall_nearness(effect_, vector_in(center_m, lane));
            lane::set_number(all.x, lane, towards.x);
            lane::set_number(all.y, lane, towards.y);
            lane::set_number(all.z, lane, towards.z);
        });
        return all;
    }

    VolumeField<Pack, lane_count> volumes_;
    const AskedSpaceEffect& ask_;
    SpaceEffect* effect_;
    unsigned int active_;
};

// With narrow registers, one function that has everything in it compiles for a minute and gains nothing; what
// sanitizers add would keep the compiler busy, too.
#if defined(__AVX2__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define DOWNWASH_IN_ONE_PIECE gnu::noinline, gnu::flatten
#else
#define DOWNWASH_IN_ONE_PIECE gnu::noinline
#endif

/// A law as a function of its own.
template <int n, class Law>
[[DOWNWASH_IN_ONE_PIECE]] void command_lanes(const SpaceTickModel<n>& model, const void* law,
                                             const dynamics::SpaceState<Pack, n>& seen,
                                             const SpaceLawMemory<Pack, n>& memory,
                                             const BasicSpacePoint<Pack, n>& reference, LaneField& field,
                                             SpaceActuation<Pack, n>& given, SpaceLawMemory<Pack, n>& next) {
    control(model, *static_cast<const Law*>(law), seen, memory, reference, field, given, next);
}

/// The plant in the lanes' worlds.
template <int n>
[[DOWNWASH_IN_ONE_PIECE]] void move_lanes(const SpaceKernelModel<n>& model, const SpaceWorldDifferences<Pack>& world,
                                          const BasicSpaceModel<Pack, n>& plant, const Pack gust[5],
                                          const dynamics::SpaceState<Pack, n>& state,
                                          const dynamics::SpaceCommand<Pack, n>& command, LaneField& field,
                                          dynamics::SpaceState<Pack, n>& next) {
    move_in_world(model.tick, world, plant, wind_in(world, gust), state, command, field, model.step, next);
}

/// The lanes whose numbers are all at most so large in size; none is NaN then.
template <int n>
PackMask is_within(const dynamics::SpaceState<Pack, n>& state, Pack max) {
    PackMask all = abs(state.energy_j) <= max;
    for (int i = 0; i < number_count<Pack, dynamics::SpaceState<Pack, n>>; ++i) {
        all = all & (abs(number_at<Pack>(state, i)) <= max);
    }
    return all;
}

/// The lanes for which a check is due.
template <int n>
PackMask is_look_due(const SpaceKernelModel<n>& model, const SpaceCoordinates<n>& anchor, Pack free_motion_m,
                     Pack free_joint_motion_m, const Pack q[dynamics::space_coordinates<n>]) {
    SpaceChange<Pack> change;
    const Pack dx = q[0] - anchor.q[0], dy = q[1] - anchor.q[1], dz = q[2] - anchor.q[2];
    change.shift_m = sqrt(dx * dx + dy * dy + dz * dz);
    change.turn_rad = turn_between_rad(anchor.q + 3, q + 3);
    PackMask is_due = change.shift_m < Pack(0);
    for (int i = 0; i < n; ++i) {
        change.joints_rad[i] = abs(q[7 + i] - anchor.q[7 + i]);
        is_due = is_due | (q[7 + i] < Pack(model.joint_low_rad[i])) | (q[7 + i] > Pack(model.joint_high_rad[i]));
    }
    return is_due | (motion_m(model.reach, change) > free_motion_m) |
           (joint_motion_m(model.reach, change) > free_joint_motion_m);
}

/// After so many times that lanes looked around the kernel returns, so that a flight among many obstacles can be ended.
inline constexpr int max_space_looks = 16;

/// Flies a group of lanes until one of them wants attention: see SpaceKernel.
template <int n, class Law>
void fly_space_group(const SpaceKernelModel<n>& model, SpaceLanes<n>& lanes, const SpaceLaneGroup& group,
                     int max_ticks) {
    using State = dynamics::SpaceState<Pack, n>;
    if (!any(group.is_active)) {
        return;
    }
    SpaceWorldNumbers<Pack, n> world;
    group.load(lanes.world, world);
    const BasicSpaceModel<Pack, n> plant = plant_in(model.tick, world);
    const Lateness<Pack> late = lateness(world.delay_ticks);
    SpaceTrack<n> track(group, lanes.track[0], model.track_ticks);
    LaneField field(group, model.volumes, lanes.patches[0], model.ask, lanes.effect[0]);
    SpaceVehicle<Pack, n> states[2];
    SpaceVehicle<Pack, n>* state = &states[0];
    group.load(lanes.vehicle, *state);
    Pack gust[5];
    for (int i = 0; i < 5; ++i) {
        gust[i] = group.load(lanes.gust[i]);
    }
    BasicSpacePoint<Pack, n> reference;
    group.load(lanes.reference, reference);
    Pack tick = group.load(lanes.tick);
    const Pack first_tick = group.load(lanes.first_tick);
    const Pack ticks = group.load(lanes.ticks);
    BasicSpaceSums<Pack> sums;
    group.load(lanes.sums, sums);
    SpaceCoordinates<n> anchor;
    group.load(lanes.anchor, anchor);
    Pack free_motion_m = group.load(lanes.free_motion_m);
    Pack free_joint_motion_m = group.load(lanes.free_joint_motion_m);
    const bool has_noise = any(group.load(lanes.has_noise) > Pack(0));
    Pack noise[drawn_space_noise_count];
    for (Pack& number : noise) {
        number = Pack(0);
    }
    const Pack least_cosine(model.least_upright_cosine);
    PackMask was_upright = cosine_of_tilt(state->plant.q + 3) > least_cosine;
    Pack rejection(0), unclear(0);
    int looks = 0;
    for (int k = 0; k < max_ticks; ++k) {
        SpaceVehicle<Pack, n>* const next = state == &states[0] ? &states[1] : &states[0];
        if (has_noise) {
            draw_space_noises(model, group, lanes, first_tick + tick, noise);
        }
        State seen;
        look_back(
            late, state->plant, [&track](int age) -> const PastSpaceMotion<Pack, n>& { return track.at(age); }, seen);
        add_errors(world, noise, seen);
        SpaceActuation<Pack, n> given;
        command_lanes<n, Law>(model.tick, model.law, seen, state->memory, reference, field, given, next->memory);
        move_lanes<n>(model, world, plant, gust, state->plant, given.command, field, next->plant);
        pass_gusts(world, noise, gust);
        track.pass(state->plant);
        const auto moved = [&](int axis) { return next->plant.q[axis] - state->plant.q[axis]; };
        sums.length_m = sums.length_m + sqrt(moved(0) * moved(0) + moved(1) * moved(1) + moved(2) * moved(2));
        state = next;
        tick = tick + Pack(1);
        reference = space_reference_at(group, lanes, tick, Pack(model.tick.tick_s));
        const Pack* q = state->plant.q;
        const Pack error_m = space_tracking_error_m(q, reference.position);
        sums.max_tracking_error_m = lane::max(sums.max_tracking_error_m, error_m);
        sums.max_saturation = lane::max(sums.max_saturation, given.saturation);
        sums.max_tilt_rate_rad_s = lane::max(sums.max_tilt_rate_rad_s, tilt_rate_rad_s(state->plant.u));
        const PackMask is_upright = cosine_of_tilt(q + 3) > least_cosine;
        const PackMask is_sound = is_within(state->plant, Pack(model.max_state)) & (error_m <= Pack(unstable_error_m)) &
                                  (given.saturation <= Pack(model.max_result)) & (is_upright | !was_upright);
        was_upright = is_upright;
        rejection = select(is_sound, Pack(0), Pack(static_cast<double>(Rejection::unstable)));
        unclear = select(is_look_due(model, anchor, free_motion_m, free_joint_motion_m, q), Pack(1), Pack(0));
        if (any(group.is_active & ((rejection > Pack(0)) | (tick >= ticks)))) {
            break;
        }
        if (const unsigned int due = lane::bits_of(group.is_active & (unclear > Pack(0))); due != 0) {
            // Nothing else leaves its place: most checks end with lanes that fly on.
            const State& before = (state == &states[0] ? states[1] : states[0]).plant;
            for (int i = 0; i < dynamics::space_coordinates<n>; ++i) {
                group.store(before.q[i], lanes.before[i]);
                group.store(q[i], lanes.vehicle[i]);
            }
            group.store(tick, lanes.tick);
            group.store(rejection, lanes.rejection);
            group.store(unclear, lanes.is_unclear);
            model.look_around(lanes.flights[0], due << static_cast<unsigned int>(group.first));
            rejection = group.load(lanes.rejection);
            unclear = group.load(lanes.is_unclear);
            if (++looks == max_space_looks || any(group.is_active & (rejection > Pack(0)))) {
                break;
            }
            group.load(lanes.anchor, anchor);
            free_motion_m = group.load(lanes.free_motion_m);
            free_joint_motion_m = group.load(lanes.free_joint_motion_m);
        }
    }
    const State& before = (state == &states[0] ? states[1] : states[0]).plant;
    for (int i = 0; i < dynamics::space_coordinates<n>; ++i) {
        group.store(before.q[i], lanes.before[i]);
    }
    group.store(*state, lanes.vehicle);
    for (int i = 0; i < 5; ++i) {
        group.store(gust[i], lanes.gust[i]);
    }
    track.move_back();
    group.store(reference, lanes.reference);
    group.store(tick, lanes.tick);
    group.store(sums, lanes.sums);
    group.store(rejection, lanes.rejection);
    group.store(unclear, lanes.is_unclear);
}

/// The kernel of one law.
template <int n, class Law>
void fly_space_lanes(const SpaceKernelModel<n>& model, SpaceLanes<n>& lanes, int max_ticks) {
    for (int first = 0; first < lane_count; first += lane::pack_width) {
        fly_space_group<n, Law>(model, lanes, SpaceLaneGroup(lanes.is_active, first), max_ticks);
    }
}

template <int n, class... Laws>
SpaceKernel<n> space_kernel_among(std::size_t law, const std::variant<Laws...>* /*all*/) {
    static constexpr SpaceKernel<n> of_law[] = {fly_space_lanes<n, Laws>...};
    return of_law[law];
}

/// The kernel of a law, by its number in SpaceLaw.
template <int n>
SpaceKernel<n> space_kernel_of(std::size_t law) {
    return space_kernel_among<n>(law, static_cast<const SpaceLaw*>(nullptr));
}

}  // namespace
}  // namespace downwash::simulation
