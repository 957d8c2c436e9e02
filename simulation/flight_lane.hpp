#pragma once

// One lane of the kernel, as the flight of one job. Private: not installed.

#include <algorithm>
#include <cmath>
#include <utility>

#include "downwash/simulation/between_ticks.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/flight_batch.hpp"
#include "downwash/simulation/flight_kernel.hpp"
#include "downwash/simulation/flight_loop.hpp"

namespace downwash::simulation {

/// How much clearance beyond the margin is asked for at first, then less and less [m]: a large one lets the robot fly
/// far until the next look, a small one is found sooner.
inline constexpr double free_motions_m[] = {0.4, 0.1, 0.025};
inline constexpr int no_free_motion = 3;

/// Queries of clearance are certain but for so much [m].
inline constexpr double clearance_error_m = 1e-7;

/// What the flights of a batch have in common.
struct FlightWorld {
    const FlightModel& model;
    const AeroMap* map;
    const FlightRules& rules;
    const Goal* goal;
};

/// The flight of one job in one lane.
class FlightLane {
 public:
    FlightLane(const FlightWorld& world, FlightLanes& lanes, int number)
        : world_(&world), lanes_(&lanes), number_(number) {}

    [[nodiscard]] bool is_free() const noexcept { return job_ == nullptr; }

    /// Takes on a job. One that is refused before its first tick leaves the lane free.
    void begin(FlightJob& job) {
        job_ = &job;
        leg_ = 0;
        put_state(job.start);
        lanes_->is_active[number_] = 1;
        level_ = 0;
        look_after_every_tick();
        begin_leg();
    }

    /// Copies another lane, so that a lane without a job computes nothing that is odd.
    void idle_like(const FlightLane& other) {
        copy_numbers(other);
        lanes_->is_active[number_] = 0;
    }

    /// Goes on with another lane's job, and leaves that one free.
    void take_over(FlightLane& other) {
        copy_numbers(other);
        job_ = std::exchange(other.job_, nullptr);
        leg_ = other.leg_;
        level_ = other.level_;
        lanes_->is_active[other.number_] = 0;
    }

    /// Judges where the kernel stopped.
    void look(bool is_interrupted) {
        FlightLeg& leg = job_->legs[leg_];
        leg.flight.ticks = static_cast<std::int64_t>(lanes_->tick[number_]);
        leg.flight.length_m = lanes_->length_m[number_];
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
        static_assert(sizeof(FlightLanes) % (lane_count * sizeof(double)) == 0);
        double* const first = &lanes_->q[0][0];
        for (std::size_t row = 0; row < sizeof(FlightLanes) / (lane_count * sizeof(double)); ++row) {
            first[row * lane_count + static_cast<std::size_t>(number_)] =
                first[row * lane_count + static_cast<std::size_t>(other.number_)];
        }
    }

    [[nodiscard]] const PlantModel& plant() const noexcept { return world_->model.tick().plant; }

    void begin_leg() {
        const ReferenceSegment& segment = job_->legs[leg_].segment;
        const auto write = [&](double(&rows)[3][3][lane_count], const ReferencePoint& point) {
            for (int axis = 0; axis < 3; ++axis) {
                rows[0][axis][number_] = point.position[axis];
                rows[1][axis][number_] = point.velocity[axis];
                rows[2][axis][number_] = point.acceleration[axis];
            }
        };
        write(lanes_->reference, segment.from());
        write(lanes_->end, segment.to());
        for (int axis = 0; axis < 3; ++axis) {
            for (int power = 0; power < 6; ++power) {
                lanes_->coefficient[axis][power][number_] = segment.coefficients()[axis][power];
            }
        }
        lanes_->inverse_duration_1_s[number_] = segment.inverse_duration_1_s();
        lanes_->tick[number_] = 0;
        lanes_->ticks[number_] = static_cast<double>(segment.ticks());
        lanes_->length_m[number_] = 0;
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

    /// Whether the goal is met now; if so, the robot may move no farther and no faster without a look than it surely
    /// stays so.
    Rejection goal_rejection() {
        const FlightState now = state();
        if (!meets_goal(*world_->goal, plant(), now)) {
            return Rejection::goal_missed;
        }
        const double motion_m =
            motion_within_goal_m(*world_->goal, plant(), now.plant.q, world_->model.collisions().body_reach_m());
        lanes_->free_motion_m[number_] = std::min(lanes_->free_motion_m[number_], motion_m - clearance_error_m);
        lanes_->max_speed_m_s[number_] = goal_max_speed_m_s;
        lanes_->look_tick[number_] = HUGE_VAL;
        return Rejection::none;
    }

    void look_after_every_tick() { lanes_->free_motion_m[number_] = -1; }

    /// Flyable area and collision at the state of now; how far the robot may move until the next look.
    Rejection rejection_nearby() {
        const FlightState now = state();
        if (world_->map != nullptr && !all_rotors(world_->model, now, [&](int rotor, double x_m, double z_m) {
                return world_->map->is_flyable(world_->model.rotor_layer(rotor), x_m, z_m);
            })) {
            return Rejection::flyable_area;
        }
        const PlanarPose pose = pose_of(now);
        const CollisionChecker& collisions = world_->model.collisions();
        // Within the free motion nothing is near between ticks either: both ends are, and the bound is convex.
        if (comes_nearer_between(world_->model, pose_before(), pose, world_->rules.margin_m)) {
            return Rejection::collision;
        }
        if (world_->rules.measures_clearance || !find_free_motion(pose)) {
            look_after_every_tick();
            if (collisions.is_nearer_than(pose, world_->rules.margin_m)) {
                return Rejection::collision;
            }
        }
        if (world_->rules.measures_clearance) {
            SegmentFlight& flight = job_->legs[leg_].flight;
            flight.clearance_integral += world_->model.tick().tick_s * clearance_density(collisions.clearance_m(pose));
        }
        return Rejection::none;
    }

    bool find_free_motion(const PlanarPose& pose) {
        for (int level = std::max(0, level_ - 1); level < no_free_motion; ++level) {
            if (!world_->model.collisions().is_nearer_than(pose, world_->rules.margin_m + free_motions_m[level])) {
                level_ = level;
                const double at[] = {pose.x_m, pose.z_m, pose.pitch_rad, pose.arm_rad};
                for (int i = 0; i < 4; ++i) {
                    lanes_->anchor[i][number_] = at[i];
                }
                lanes_->free_motion_m[number_] = free_motions_m[level] - clearance_error_m;
                return true;
            }
        }
        level_ = no_free_motion;
        return false;
    }

    [[nodiscard]] PlanarPose pose_before() const noexcept {
        const auto& before = lanes_->before;
        return {before[0][number_], before[1][number_], before[2][number_], before[3][number_]};
    }

    void end_with(Rejection rejection) {
        FlightLeg& leg = job_->legs[leg_];
        leg.flight.rejection = rejection;
        leg.end = state();
        if (rejection == Rejection::none && ++leg_ < job_->legs.size()) {
            begin_leg();
            return;
        }
        job_ = nullptr;
        lanes_->is_active[number_] = 0;
    }

    [[nodiscard]] FlightState state() const noexcept {
        FlightState s{};
        for (int i = 0; i < 4; ++i) {
            s.plant.q[i] = lanes_->q[i][number_];
            s.plant.u[i] = lanes_->u[i][number_];
        }
        for (int i = 0; i < max_rotors; ++i) {
            s.plant.thrust_n[i] = lanes_->thrust_n[i][number_];
        }
        s.plant.energy_j = lanes_->energy_j[number_];
        s.controller = {{lanes_->position_integral[0][number_], lanes_->position_integral[1][number_]},
                        lanes_->pitch_rate_integral[number_],
                        lanes_->arm_integral[number_],
                        lanes_->pitch_reference_rad[number_],
                        lanes_->pitch_reference_rate[number_],
                        lanes_->rate_reference[number_]};
        return s;
    }

    void put_state(const FlightState& s) noexcept {
        for (int i = 0; i < 4; ++i) {
            lanes_->q[i][number_] = s.plant.q[i];
            lanes_->u[i][number_] = s.plant.u[i];
        }
        for (int i = 0; i < max_rotors; ++i) {
            lanes_->thrust_n[i][number_] = s.plant.thrust_n[i];
        }
        lanes_->energy_j[number_] = s.plant.energy_j;
        lanes_->position_integral[0][number_] = s.controller.position_integral[0];
        lanes_->position_integral[1][number_] = s.controller.position_integral[1];
        lanes_->pitch_rate_integral[number_] = s.controller.pitch_rate_integral;
        lanes_->arm_integral[number_] = s.controller.arm_integral;
        lanes_->pitch_reference_rad[number_] = s.controller.pitch_reference_rad;
        lanes_->pitch_reference_rate[number_] = s.controller.pitch_reference_rate;
        lanes_->rate_reference[number_] = s.controller.rate_reference;
    }

    const FlightWorld* world_;
    FlightLanes* lanes_;
    int number_;
    FlightJob* job_ = nullptr;
    std::size_t leg_ = 0;
    int level_ = 0;  ///< of the free motion found last
};

}  // namespace downwash::simulation
