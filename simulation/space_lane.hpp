#pragma once

// One lane of the kernel in space, as the flight of one job. Private: not installed.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "downwash/simulation/lane_flight.hpp"
#include "downwash/simulation/space_flight.hpp"
#include "downwash/simulation/space_flight_job.hpp"
#include "downwash/simulation/space_flight_state.hpp"
#include "downwash/simulation/space_kernel.hpp"
#include "downwash/simulation/space_looks.hpp"
#include "downwash/simulation/space_loop_of.hpp"
#include "downwash/simulation/space_pool_setup.hpp"
#include "downwash/simulation/space_rules.hpp"

namespace downwash::simulation {

/// What the flights of a pool have in common.
template <int n>
struct SpaceSetting {
    SpacePoolSetup setup;
    SpaceWorld nominal_world;    ///< as a description and
    FlownSpaceWorld<n> nominal;  ///< in numbers
};

/// The flight of one job in space in one lane; see LaneOf.
template <int n>
class SpaceLane : public LaneFlight<SpaceFlightJob, SpaceFlightChain> {
 public:
    /// @param track where vehicles were: model.track_ticks rows
    SpaceLane(const SpaceSetting<n>& setting, const SpaceKernelModel<n>& model, SpaceLanes<n>& lanes,
              SpaceTrackRow<n>* track, int number)
        : LaneFlight(number), setting_(&setting), model_(&model), lanes_(&lanes), track_(track) {}

    void begin(SpaceFlightJob& job) {
        start(job);
        description_ = job.world != nullptr ? job.world : &setting_->nominal_world;
        world_ = job.world != nullptr ? make_space_world<n>(setting_->setup.robot, *job.world) : setting_->nominal;
        SpaceFlightState<double, n> now{};
        copy_common(job.start, now);
        write<SpaceVehicle<double, n>>(now, lanes_->vehicle);
        for (int i = 0; i < 5; ++i) {
            lanes_->gust[i][number_] = now.world.gust[i];
        }
        for (int age = 1; age <= model_->track_ticks; ++age) {
            write(past_at(now.world, age), track_row(age));
        }
        write(world_.numbers, lanes_->world);
        lanes_->tape[number_] = world_.tape;
        lanes_->has_noise[number_] = world_.has_noise ? 1 : 0;
        lanes_->is_active[number_] = 1;
        lanes_->tick[number_] = 0;
        free_ = {};
        min_clearance_m_ = std::numeric_limits<double>::infinity();
        margin_m_ = job.margin_m.value_or(setting_->setup.margin_m);
        begin_leg();
        if (const Rejection rejection = rejection_at_start(); rejection != Rejection::none) {
            end_with(rejection);
        }
    }

    void idle_like(const SpaceLane& other) {
        copy_numbers(other);
        lanes_->is_active[number_] = 0;
        is_idle_ = true;
    }

    void move_from(SpaceLane& other) {
        copy_numbers(other);
        take_job_of(other);
        description_ = other.description_;
        world_ = other.world_;
        looked_at_ = other.looked_at_;
        free_ = other.free_;
        min_clearance_m_ = other.min_clearance_m_;
        hover_ = other.hover_;
        margin_m_ = other.margin_m_;
        lanes_->is_active[other.number_] = 0;
    }

    /// See SpaceLookAround.
    void look_around() {
        lanes_->rejection[number_] = static_cast<double>(rejection_nearby());
        lanes_->is_unclear[number_] = 0;
    }

    void look(bool is_interrupted) {
        SpaceFlightLeg& leg = job_->legs[leg_];
        leg.flight.ticks = static_cast<std::int64_t>(lanes_->tick[number_]);
        const auto sums = read<BasicSpaceSums<double>>(lanes_->sums);
        leg.flight.max_tracking_error_m = sums.max_tracking_error_m;
        leg.flight.max_saturation = sums.max_saturation;
        leg.flight.max_tilt_rate_rad_s = sums.max_tilt_rate_rad_s;
        leg.flight.length_m = sums.length_m;
        const bool is_end = leg.flight.ticks >= leg.segment.ticks();
        const bool is_due = lanes_->tick[number_] >= lanes_->ticks[number_];
        Rejection rejection = static_cast<Rejection>(static_cast<int>(lanes_->rejection[number_]));
        if (rejection == Rejection::none && lanes_->is_unclear[number_] > 0) {
            rejection = rejection_nearby();
        }
        if (rejection == Rejection::none && is_end) {
            rejection = rejection_of(leg.flight);
        }
        if (rejection == Rejection::none && is_due && is_judged_leg() && !meets_goal_now()) {
            rejection = Rejection::goal_missed;
        }
        const auto& budget_j = setting_->setup.energy_budget_j;
        if (rejection == Rejection::none && is_end && leg_ + 1 == job_->legs.size() && budget_j &&
            plant().energy_j > *budget_j) {
            rejection = Rejection::over_budget;
        }
        if (rejection != Rejection::none || is_end) {
            end_with(rejection);
        } else if (is_interrupted) {
            end_with(Rejection::interrupted);
        } else if (is_due) {
            lanes_->ticks[number_] = std::min(lanes_->ticks[number_] + SpaceFlightJob::judging_step_ticks,
                                              static_cast<double>(leg.segment.ticks()));
        }
    }

 private:
    static constexpr int coordinates = dynamics::space_coordinates<n>;

    void copy_numbers(const SpaceLane& other) {
        copy_rows(other, *lanes_);
        for (SpaceTrackRow<n>& past : std::span(track_, static_cast<std::size_t>(model_->track_ticks))) {
            copy_rows(other, past);
        }
    }

    /// The row of all lanes so many ticks ago, from 1 to the ticks of the track.
    [[nodiscard]] LaneRows<PastSpaceMotion<double, n>>& track_row(int age) const noexcept {
        return track_[model_->track_ticks - age].motion;
    }

    [[nodiscard]] dynamics::SpaceState<double, n> plant() const {
        return read<SpaceVehicle<double, n>>(lanes_->vehicle).plant;
    }
    [[nodiscard]] AnySpaceState state() const {
        SpaceFlightState<double, n> now{};
        static_cast<SpaceVehicle<double, n>&>(now) = read<SpaceVehicle<double, n>>(lanes_->vehicle);
        for (int i = 0; i < 5; ++i) {
            now.world.gust[i] = lanes_->gust[i][number_];
        }
        for (int age = 1; age <= recent_ticks; ++age) {
            now.world.past[age - 1] = read<PastSpaceMotion<double, n>>(track_row(age));
        }
        const auto older = static_cast<int>(older_ticks(world_.numbers.delay_ticks));
        for (int i = 1; i <= older; ++i) {
            now.world.older.push_back(read<PastSpaceMotion<double, n>>(track_row(recent_ticks + i)));
        }
        AnySpaceState any{};
        copy_common(now, any);
        return any;
    }

    /// Where obstacles see the vehicle. @param rows its coordinates come first
    [[nodiscard]] SpacePose pose_in(const double (*rows)[lane_count]) const {
        SpaceMotion motion;
        for (std::size_t i = 0; i < 3; ++i) {
            motion.position_m[i] = rows[i][number_];
        }
        for (std::size_t i = 0; i < 4; ++i) {
            motion.attitude[i] = rows[3 + i][number_];
        }
        for (std::size_t i = 0; i < n; ++i) {
            motion.joints_rad[i] = rows[7 + i][number_];
        }
        return among_obstacles(motion, *description_);
    }

    void begin_leg() {
        const SpaceSegment& segment = job_->legs[leg_].segment;
        const BasicSpacePoint<double, n> from = point_for<n>(segment.from());
        write(from, lanes_->reference);
        write(point_for<n>(segment.to()), lanes_->end);
        for (int axis = 0; axis < space_axes<n>; ++axis) {
            for (int power = 0; power < 6; ++power) {
                lanes_->coefficient[axis][power][number_] = segment.coefficients()[axis][power];
            }
        }
        lanes_->inverse_duration_1_s[number_] = segment.inverse_duration_1_s();
        lanes_->tick[number_] = 0;
        lanes_->first_tick[number_] = static_cast<double>(first_tick_);
        // Where the goal is judged, the kernel stops as at an end. A hover is the same point there.
        lanes_->ticks[number_] = static_cast<double>(
            is_judged_leg() ? std::max<std::int64_t>(1, segment.ticks() - job_->judged_ticks) : segment.ticks());
        write(BasicSpaceSums<double>{space_tracking_error_m(plant().q, from.position)}, lanes_->sums);
        if (is_judged_leg()) {
            hover_ = goal().hover_at(0, segment.to());
        }
    }

    /// The rules where a job begins.
    Rejection rejection_at_start() {
        const double error_m = lanes_->sums[0][number_];
        if (!are_within(plant(), max_state) || !(error_m <= unstable_error_m)) {
            return Rejection::unstable;
        }
        for (int i = 0; i < coordinates; ++i) {
            lanes_->before[i][number_] = lanes_->vehicle[i][number_];
        }
        return rejection_nearby();
    }

    [[nodiscard]] bool is_judged_leg() const noexcept {
        return job_->judged_ticks > 0 && leg_ + 1 == job_->legs.size();
    }
    [[nodiscard]] bool meets_goal_now() const {
        const SpaceMotion motion = motion_of<n>(plant());
        return meets_goal(goal().error(hover_, motion, *description_), motion);
    }
    [[nodiscard]] const SpaceGoalRule& goal() const noexcept {
        return job_->goal != nullptr ? *job_->goal : *setting_->setup.goal;
    }

    /// What speaks against a leg that was flown to its end.
    [[nodiscard]] Rejection rejection_of(const SpaceSegmentFlight& flight) const noexcept {
        const auto& rules = setting_->setup.rules;
        if (rules && !(flight.max_tracking_error_m <= rules->max_tracking_error_m)) {
            return Rejection::tracking;
        }
        if (rules && !(flight.max_saturation <= rules->max_saturation)) {
            return Rejection::saturation;
        }
        return rules && flight.max_tilt_rate_rad_s > rules->max_tilt_rate_rad_s ? Rejection::unstable : Rejection::none;
    }

    /// Bounds, joint limits, collision and flyable area at the state of now; how far the robot may move until the next
    /// look.
    Rejection rejection_nearby() {
        double free_m = std::numeric_limits<double>::infinity();
        double free_joint_motion_m = std::numeric_limits<double>::infinity();
        if (const auto& rules = setting_->setup.rules) {
            for (std::size_t i = 0; i < 3; ++i) {
                const double at_m = lanes_->vehicle[i][number_];
                free_m = std::min({free_m, at_m - rules->low_m[i], rules->high_m[i] - at_m});
            }
            if (!(free_m >= 0)) {
                return Rejection::bounds;
            }
            if (rules->keeps_joint_limits && !is_within_joint_limits()) {
                return Rejection::arm_limits;
            }
        }
        if (const SpaceChecker* const checker = setting_->setup.checker) {
            const SpacePose pose = pose_in(lanes_->vehicle);
            const SpaceChange<double> change = change_between(looked_at_, pose);
            double moved_m = motion_m(model_->reach, change);
            double bent_m = joint_motion_m(model_->reach, change);
            if (!(moved_m < free_.to_obstacles_m && bent_m < free_.to_itself_m) || !is_within_joint_limits()) {
                free_ = checker->free_motion(pose, margin_m_, max_free_motion_m);
                if (free_.is_none() || checker->comes_nearer_between(pose_in(lanes_->before), pose, margin_m_)) {
                    return Rejection::collision;
                }
                looked_at_ = pose;
                free_.to_obstacles_m -= free_motion_error_m(checker->kind());
                free_.to_itself_m -= free_motion_error_m(checker->kind());
                moved_m = bent_m = 0;
            }
            free_m = std::min(free_m, free_.to_obstacles_m - moved_m);
            free_m = std::min(free_m, motion_until_measured_m(*checker, pose));
            free_joint_motion_m = free_.to_itself_m - bent_m;
        }
        const VolumeMap* const map =
            setting_->setup.volumes != nullptr ? setting_->setup.volumes->rotor.get() : nullptr;
        SpaceEffect* const effect = lanes_->effect[0];
        if (map != nullptr || effect != nullptr) {
            const dynamics::SpaceState<double, n> now = plant();
            const dynamics::LaneRotation<double> attitude = dynamics::rotation_of(now.q + 3);
            const SpaceModel<n>& nominal = model_->tick.nominal.plant;
            for (int i = 0; i < nominal.rotor_count; ++i) {
                const auto at =
                    nominal_place(world_.numbers, dynamics::LaneVector<double>{now.q[0], now.q[1], now.q[2]} +
                                                      attitude * nominal.rotor[i].position_m);
                if (effect != nullptr) {
                    if (!effect->is_flyable(i, at)) {
                        return Rejection::flyable_area;
                    }
                    free_m = -1;  // it does not say how far the end of the area is
                    continue;
                }
                const Vector3 hub_m{at.x, at.y, at.z};
                const double margin_m = map->margin_m(hub_m);
                if (margin_m <= 0 && !map->is_flyable(hub_m)) {
                    return Rejection::flyable_area;
                }
                free_m = std::min(free_m, margin_m - free_motion_error_m(CollisionCheckerKind::own));
            }
        }
        for (int i = 0; i < coordinates; ++i) {
            lanes_->anchor[i][number_] = lanes_->vehicle[i][number_];
        }
        lanes_->free_motion_m[number_] = free_m;
        lanes_->free_joint_motion_m[number_] = free_joint_motion_m;
        return Rejection::none;
    }

    /// Measures the clearance at a pose as far as somebody wants to know it. @return how far the robot may move until
    /// the next time
    double motion_until_measured_m(const SpaceChecker& checker, const SpacePose& pose) {
        const bool adds_up = setting_->setup.measures_clearance;
        const std::optional<ClearanceError>& finds = setting_->setup.finds_min_clearance;
        if (!adds_up && !finds) {
            return std::numeric_limits<double>::infinity();
        }
        const double clearance_m = checker.clearance_m(pose);
        min_clearance_m_ = std::min(min_clearance_m_, clearance_m);
        if (adds_up) {
            if (lanes_->tick[number_] > 0) {  // the density of a tick is that at its end
                job_->legs[leg_].flight.clearance_integral += model_->tick.tick_s * clearance_density(clearance_m);
            }
            return -1;
        }
        return std::max(clearance_m - min_clearance_m_, finds->at_m(clearance_m));
    }

    [[nodiscard]] bool is_within_joint_limits() const noexcept {
        for (int i = 0; i < n; ++i) {
            const double angle_rad = lanes_->vehicle[7 + i][number_];
            if (angle_rad < model_->joint_low_rad[i] || angle_rad > model_->joint_high_rad[i]) {
                return false;
            }
        }
        return true;
    }

    void end_with(Rejection rejection) {
        SpaceFlightLeg& leg = job_->legs[leg_];
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

    const SpaceSetting<n>* setting_;
    const SpaceKernelModel<n>* model_;
    SpaceLanes<n>* lanes_;
    SpaceTrackRow<n>* track_;
    const SpaceWorld* description_ = nullptr;
    FlownSpaceWorld<n> world_{};
    SpacePose looked_at_;                                               ///< where collisions were looked for last, and
    SpaceChecker::FreeMotion free_;                                     ///< how far from there none can be
    double min_clearance_m_ = std::numeric_limits<double>::infinity();  ///< since the job began, when wanted
    SpaceGoalHover hover_;                                              ///< of a leg that is judged
    double margin_m_ = 0;                                               ///< of the job
};

}  // namespace downwash::simulation
