#pragma once

// One lane of the kernel, as the flight of one job. Private: not installed.

#include <algorithm>
#include <cmath>
#include <span>

#include "downwash/simulation/between_ticks.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/flight_job.hpp"
#include "downwash/simulation/flight_kernel.hpp"
#include "downwash/simulation/lane_flight.hpp"
#include "downwash/simulation/rule_checks.hpp"
#include "downwash/simulation/vehicle_effect.hpp"

namespace downwash::simulation {

/// Clearances beyond the margin, tried one after the other [m]. A large one lets the robot fly far before the next
/// check; a small one is found more often.
inline constexpr double free_motions_m[] = {0.4, 0.1, 0.025};
inline constexpr int no_free_motion = 3;

/// Clearance queries are exact to this [m].
inline constexpr double clearance_error_m = 1e-7;

/// What the flights of a batch have in common.
struct FlightSetting {
    const FlightModel& model;
    const AeroMap* map;
    const FlightRules& rules;
    const Goal* goal;
};

/// Where the vehicle of a lane was at the last ticks, in the rows of all lanes: see FlightLanes::track.
struct LaneTrack {
    TrackRow* rows = nullptr;
    int ticks = 0;  ///< see FlightKernelModel
};

/// The flight of one job in one lane.
class FlightLane : public LaneFlight<FlightJob, FlightChain> {
 public:
    /// @param track nothing where no delay is longer than recent_ticks
    FlightLane(const FlightSetting& setting, FlightLanes& lanes, int number, LaneTrack track = {})
        : LaneFlight(number), setting_(&setting), lanes_(&lanes), track_(track) {}

    /// Takes a job. A job that is rejected before its first tick leaves the lane free.
    void begin(FlightJob& job) {
        start(job);
        world_ = flown_world(setting_->model, job.world);
        min_clearance_m_ = HUGE_VAL;
        write<VehicleState<double>>(job.start, lanes_->state);
        write<WorldMemory<double>>(job.start.world, lanes_->world_memory);
        for (int age = 1; age <= track_.ticks; ++age) {
            write(past_at(job.start.world, age), track_row(age));
        }
        write(numbers(), lanes_->world);
        lanes_->tape[number_] = world_ != nullptr ? world_->world.tape : 0;
        lanes_->is_active[number_] = 1;
        for (MapPatches<lane_count>& patches : lanes_->patches) {
            enter(no_patch, patches, number_);
        }
        level_ = 0;
        look_after_every_tick();
        begin_leg();
    }

    /// Copies another lane, so that a lane without a job computes with ordinary numbers. The kernel leaves them as they
    /// are.
    void idle_like(const FlightLane& other) {
        copy_numbers(other);
        lanes_->is_active[number_] = 0;
        is_idle_ = true;
    }

    /// Goes on with another lane's job, and leaves that one free.
    void move_from(FlightLane& other) {
        copy_numbers(other);
        take_job_of(other);
        world_ = other.world_;
        min_clearance_m_ = other.min_clearance_m_;
        level_ = other.level_;
        lanes_->is_active[other.number_] = 0;
    }

    /// See LookAround. Where the goal is judged too, look() has to decide.
    void look_around() {
        if (!is_judged()) {
            lanes_->rejection[number_] = static_cast<double>(rejection_nearby());
            lanes_->is_unclear[number_] = 0;
        }
    }

    /// Decides how the flight goes on where the kernel stopped.
    void look(bool is_interrupted) {
        FlightLeg& leg = job_->legs[leg_];
        leg.flight.ticks = static_cast<std::int64_t>(lanes_->tick[number_]);
        static_cast<FlightSums&>(leg.flight) = read<FlightSums>(lanes_->sums);
        const bool is_end = leg.flight.ticks >= leg.segment.ticks();
        const bool is_unclear = lanes_->is_unclear[number_] > 0;
        Rejection rejection = static_cast<Rejection>(static_cast<int>(lanes_->rejection[number_]));
        if (rejection == Rejection::none && is_unclear) {
            rejection = rejection_nearby();
        }
        if (rejection == Rejection::none && (is_unclear || is_end) && is_judged()) {
            rejection = goal_rejection();
        }
        if (rejection != Rejection::none || is_end) {
            end_with(rejection);
        } else if (is_interrupted) {
            end_with(Rejection::interrupted);
        }
    }

 private:
    void copy_numbers(const FlightLane& other) {
        copy_rows(other, *lanes_);
        for (TrackRow& past : std::span(track_.rows, static_cast<std::size_t>(track_.ticks))) {
            copy_rows(other, past);
        }
    }

    /// The numbers of the world of the flight.
    [[nodiscard]] const WorldNumbers<double>& numbers() const noexcept {
        return (world_ != nullptr ? *world_ : setting_->model.nominal_world()).numbers;
    }

    /// The row of all lanes so many ticks ago, from 1 to the ticks of the track.
    [[nodiscard]] LaneRows<PastMotion<double>>& track_row(int age) const noexcept {
        return track_.rows[track_.ticks - age].motion;
    }

    [[nodiscard]] FlightState state() const {
        FlightState state{read<VehicleState<double>>(lanes_->state),
                          {read<WorldMemory<double>>(lanes_->world_memory), {}}};
        const std::size_t older = older_ticks(numbers().delay_ticks);
        for (std::size_t i = 0; i < older; ++i) {
            state.world.older.push_back(read<PastMotion<double>>(track_row(recent_ticks + 1 + static_cast<int>(i))));
        }
        return state;
    }

    /// That of state(), of which it is the first four numbers.
    [[nodiscard]] PlanarPose pose() const noexcept { return pose_in(lanes_->state); }
    /// @param rows x, z, pitch and arm come first
    [[nodiscard]] PlanarPose pose_in(const double (*rows)[lane_count]) const noexcept {
        return {rows[0][number_], rows[1][number_], rows[2][number_], rows[3][number_]};
    }

    [[nodiscard]] const PlantModel& plant() const noexcept { return setting_->model.tick().plant; }

    void begin_leg() {
        const ReferenceSegment& segment = job_->legs[leg_].segment;
        write(segment.from(), lanes_->reference);
        write(segment.to(), lanes_->end);
        for (int axis = 0; axis < 3; ++axis) {
            for (int power = 0; power < 6; ++power) {
                lanes_->coefficient[axis][power][number_] = segment.coefficients()[axis][power];
            }
        }
        lanes_->inverse_duration_1_s[number_] = segment.inverse_duration_1_s();
        lanes_->tick[number_] = 0;
        lanes_->first_tick[number_] = static_cast<double>(first_tick_);
        lanes_->ticks[number_] = static_cast<double>(segment.ticks());
        write(FlightSums{}, lanes_->sums);
        lanes_->look_tick[number_] =
            is_judged_leg() ? static_cast<double>(segment.ticks() - job_->judged_ticks) : HUGE_VAL;
        lanes_->max_speed_m_s[number_] = HUGE_VAL;
        if (is_judged()) {
            if (const Rejection rejection = goal_rejection(); rejection != Rejection::none) {
                end_with(rejection);
                return;
            }
            look_after_every_tick();
        }
    }

    [[nodiscard]] bool is_judged_leg() const noexcept {
        return job_->judged_ticks > 0 && leg_ + 1 == job_->legs.size();
    }
    [[nodiscard]] bool is_judged() const noexcept {
        return is_judged_leg() && static_cast<std::int64_t>(lanes_->tick[number_]) + job_->judged_ticks >=
                                      job_->legs.back().segment.ticks();
    }

    /// Whether the vehicle meets the goal now. If so, limits how far and how fast it may move before the next check, so
    /// that it surely still meets the goal.
    Rejection goal_rejection() {
        const FlightState now = state();
        const Goal& goal = job_->goal != nullptr ? *job_->goal : *setting_->goal;
        if (!meets_goal(goal, plant(), now)) {
            return Rejection::goal_missed;
        }
        const double motion_m =
            motion_within_goal_m(goal, plant(), pose_of(now), setting_->model.collisions().body_reach_m());
        limit_free_motion(motion_m);
        lanes_->max_speed_m_s[number_] = goal_max_speed_m_s;
        lanes_->look_tick[number_] = HUGE_VAL;
        return Rejection::none;
    }

    void look_after_every_tick() { lanes_->free_motion_m[number_] = -1; }
    void limit_free_motion(double motion_m) {
        lanes_->free_motion_m[number_] = std::min(lanes_->free_motion_m[number_], motion_m - clearance_error_m);
    }

    /// Flyable area and collision at the state of now; how far the robot may move until the next look.
    Rejection rejection_nearby() {
        const PlanarPose pose = among_obstacles(this->pose(), world_);
        const CollisionChecker& collisions = setting_->model.collisions();
        const double clearance_m = setting_->rules.finds_min_clearance ? collisions.clearance_m(pose) : HUGE_VAL;
        min_clearance_m_ = std::min(min_clearance_m_, clearance_m);
        if (setting_->map != nullptr && !is_flyable(setting_->model, *setting_->map, pose)) {
            return Rejection::flyable_area;
        }
        // Within the free motion nothing is near between ticks either: both ends are, and the bound is convex.
        if (comes_nearer_between(setting_->model, among_obstacles(pose_in(lanes_->before), world_), pose,
                                 setting_->rules.margin_m)) {
            return Rejection::collision;
        }
        const bool is_clearance_exact =
            setting_->rules.finds_min_clearance && collisions.kind() == CollisionCheckerKind::own;
        const bool is_free =
            is_clearance_exact ? take_free_motion(clearance_m - setting_->rules.margin_m) : find_free_motion(pose);
        if (setting_->rules.measures_clearance || !is_free) {
            look_after_every_tick();
            if (collisions.is_nearer_than(pose, setting_->rules.margin_m)) {
                return Rejection::collision;
            }
        }
        if (setting_->rules.finds_min_clearance) {
            const double error_m = setting_->rules.finds_min_clearance->at_m(clearance_m);
            limit_free_motion(std::max(clearance_m - min_clearance_m_, error_m));
        }
        if (setting_->rules.measures_clearance) {
            SegmentFlight& flight = job_->legs[leg_].flight;
            flight.clearance_integral +=
                setting_->model.tick().tick_s * clearance_density(collisions.clearance_m(pose));
        }
        return Rejection::none;
    }

    /// The robot may move so far from here before it is nearer than the margin. @return whether that is anything
    bool take_free_motion(double motion_m) {
        if (motion_m <= 2 * clearance_error_m) {
            return false;
        }
        for (int i = 0; i < 4; ++i) {
            lanes_->anchor[i][number_] = lanes_->state[i][number_];
        }
        lanes_->free_motion_m[number_] = motion_m - clearance_error_m;
        return true;
    }

    bool find_free_motion(const PlanarPose& pose) {
        for (int level = std::max(0, level_ - 1); level < no_free_motion; ++level) {
            if (!setting_->model.collisions().is_nearer_than(pose, setting_->rules.margin_m + free_motions_m[level])) {
                level_ = level;
                return take_free_motion(free_motions_m[level]);
            }
        }
        level_ = no_free_motion;
        return false;
    }

    void end_with(Rejection rejection) {
        FlightLeg& leg = job_->legs[leg_];
        leg.flight.rejection = rejection;
        leg.flight.min_clearance_m = min_clearance_m_;
        leg.end = state();
        first_tick_ += leg.flight.ticks;
        if (rejection == Rejection::none && ++leg_ < job_->legs.size()) {
            begin_leg();
            return;
        }
        job_ = nullptr;
        lanes_->is_active[number_] = 0;
    }

    const FlightSetting* setting_;
    FlightLanes* lanes_;
    LaneTrack track_;
    const FlownWorld* world_ = nullptr;
    double min_clearance_m_ = HUGE_VAL;  ///< since the job began, when wanted
    int level_ = 0;                      ///< level of the free motion found last
};

}  // namespace downwash::simulation
