#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "downwash/base/numbers.hpp"
#include "downwash/controllers/actuation.hpp"
#include "downwash/simulation/between_ticks.hpp"
#include "downwash/simulation/flight_record.hpp"
#include "downwash/simulation/rule_checks.hpp"
#include "downwash/simulation/surroundings.hpp"
#include "downwash/simulation/touch_flight.hpp"
#include "downwash/simulation/vehicle_effect.hpp"

// The rows and figures of an executed flight. Private: not installed.

namespace downwash::simulation {

/// Writes the log of one flight while it is flown.
class FlightRecorder {
 public:
    using Given = controllers::Actuation<double>;

    /// @param world nullptr: the plain tick
    FlightRecorder(const FlightModel& model, const FlownWorld* world, FlightEffect& effect, Execution& execution)
        : model_(model),
          plant_(model.tick().plant),
          world_(world),
          surroundings_(world != nullptr ? world->numbers : model.nominal_world().numbers, {}, effect,
                        model.tick().tilt_loss),
          execution_(execution) {}

    /// From here on the vehicle may touch a surface: rows tell the force, and obstacles see the vehicle a little off
    /// it. @param touch nullptr: none any more
    void expect(const Touch* touch) { touch_ = touch; }

    /// From here on counts the states at which the robot is in unseen space, if the scene has any.
    void count_unseen() {
        if (const std::shared_ptr<const Scene> unseen = model_.scene().unseen_space()) {
            unseen_.emplace(unseen, model_.plane(), model_.robot().shape());
        }
    }
    /// The share of those states in all that were counted; empty without unseen space.
    [[nodiscard]] std::optional<double> unseen_share() const {
        return unseen_ ? std::optional(static_cast<double>(unseen_states_) / static_cast<double>(states_))
                       : std::nullopt;
    }

    /// Flown so far.
    [[nodiscard]] std::int64_t ticks() const noexcept { return tick_; }

    /// @return false if the commands are beyond max_result, and the row holds none
    bool add_row(const FlightState& state, const ReferencePoint& reference, const Given& given) {
        FlightRow row = row_of(state, reference, given);
        const bool is_usable = is_in_range(row) && given.saturation <= max_result;
        if (!is_usable) {
            row = row_of(state, reference, Given{});
        }
        ++tick_;
        execution_.rows.push_back(row);
        execution_.max_saturation = std::max(execution_.max_saturation, is_usable ? given.saturation : max_result);
        return is_usable;
    }

    /// Looks at a new state: what it means for the flight, and for the figures of the whole.
    Rejection judge(const FlightState& state, const ReferencePoint& reference, bool is_first = false) {
        const PlanarPose pose = among_obstacles(pose_of(state), world_);
        clearance_m_ = model_.executed_clearance_m(pose);
        if (unseen_) {
            ++states_;
            unseen_states_ += unseen_->is_nearer_than(pose, 0) ? 1 : 0;
        }
        const PlanarPose checked = touch_ != nullptr ? off_surface(pose, *touch_, depth_m_) : pose;
        const double checked_m = touch_ != nullptr ? model_.executed_clearance_m(checked) : clearance_m_;
        const PlanarPose checked_before = std::exchange(checked_, checked);
        const double checked_before_m = std::exchange(checked_m_, checked_m);
        if (touch_ == nullptr) {
            execution_.min_clearance_m = std::min(execution_.min_clearance_m, clearance_m_);
        }
        execution_.max_tracking_error_m = std::max(execution_.max_tracking_error_m, tracking_error_m(state, reference));
        if (!is_stable(state, reference)) {
            return Rejection::unstable;
        }
        if (checked_m <= 0) {
            execution_.min_clearance_m = std::min(execution_.min_clearance_m, checked_m);
            return Rejection::collision;
        }
        if (!is_first) {
            const double between_m = least_clearance_between_m(model_, checked_before, checked_before_m, checked,
                                                               checked_m, executed_clearance_m);
            if (between_m <= 0) {
                execution_.min_clearance_m = std::min(execution_.min_clearance_m, between_m);
                return Rejection::collision;
            }
        }
        if (execution_.aero && !is_flyable(model_, pose)) {
            return Rejection::flyable_area;
        }
        return Rejection::none;
    }

    /// The same of a tick beside the surface that is touched.
    Rejection after_touching_tick(const FlightState& before, const ReferencePoint& reference, const Given& given,
                                  const FlightState& next, const ReferencePoint& next_reference,
                                  const dynamics::ContactTickRecord& contact) {
        // The row is that of the state before, and of the tick that led to it.
        depth_m_ = contact.depth_m;
        const Rejection rejection = after_tick(before, reference, given, next, next_reference);
        contact_force_n_ = contact.normal_impulse_n_s / model_.tick().tick_s;
        return rejection;
    }

    Rejection after_tick(const FlightState& before, const ReferencePoint& reference, const Given& given,
                         const FlightState& next, const ReferencePoint& next_reference) {
        if (!add_row(before, reference, given) || !are_within(next.plant, max_state)) {
            return Rejection::unstable;
        }
        add_tick(execution_, plant_, before, next);
        const Rejection rejection = judge(next, next_reference);
        execution_.clearance_integral += model_.tick().tick_s * clearance_density(clearance_m_);
        return rejection;
    }

 private:
    static bool is_in_range(FlightRow row) {
        row.clearance_m = std::isinf(row.clearance_m) ? 0 : row.clearance_m;
        return are_within(row, max_result);
    }

    [[nodiscard]] FlightRow row_of(const FlightState& state, const ReferencePoint& reference, const Given& given) {
        FlightRow row;
        row.t_s = static_cast<double>(tick_) * model_.tick().tick_s;
        row.reference = reference;
        std::copy(std::begin(state.plant.q), std::end(state.plant.q), row.q);
        std::copy(std::begin(state.plant.u), std::end(state.plant.u), row.u);
        const auto attitude = dynamics::attitude(plant_, row.q[2], row.q[3]);
        const bool has_lag = plant_.rotor_time_constant_s > 0;
        const double* thrust_n = has_lag ? state.plant.thrust_n : given.command.thrust_n;
        for (int i = 0; i < plant_.rotor_count; ++i) {
            const auto hub = dynamics::rotor_position(plant_, attitude, row.q[0], row.q[1], i);
            row.rotor_command_n[i] = given.command.thrust_n[i];
            row.rotor_lag_n[i] = state.plant.thrust_n[i];
            row.rotor_factor[i] = surroundings_.thrust_ratio(i, hub, attitude.sin_pitch);
            row.thrust_command_n += row.rotor_command_n[i];
            row.pitch_torque_command_nm -= plant_.rotor_x_m[i] * row.rotor_command_n[i];
            const double free_air_n = surroundings_.thrust_scale(i) * thrust_n[i];
            row.thrust_n += row.rotor_factor[i] * free_air_n;
            row.pitch_torque_nm -= plant_.rotor_x_m[i] * row.rotor_factor[i] * free_air_n;
        }
        row.arm_torque_nm = given.command.joint_torque_nm;
        row.clearance_m = clearance_m_;
        const auto tip = dynamics::end_effector_position(plant_, attitude, row.q[0], row.q[1]);
        row.end_effector_x_m = tip.x;
        row.end_effector_z_m = tip.z;
        row.power_w = dynamics::rotor_power(plant_, thrust_n) + std::abs(row.arm_torque_nm * row.u[3]);
        row.energy_j = state.plant.energy_j;
        row.contact_force_n = contact_force_n_;
        return row;
    }

    const FlightModel& model_;
    const PlantModel& plant_;
    const FlownWorld* world_;
    WorldSurroundings<double, FlightEffect> surroundings_;
    Execution& execution_;
    std::optional<CollisionChecker> unseen_;  ///< the robot in unseen space
    std::int64_t states_ = 0, unseen_states_ = 0;
    std::int64_t tick_ = 0;
    double clearance_m_ = std::numeric_limits<double>::infinity();
    PlanarPose checked_;    ///< for collisions, at the last state
    double checked_m_ = 0;  ///< its clearance
    const Touch* touch_ = nullptr;
    double depth_m_ = 0;          ///< of the deepest point in the surface that is touched, at the last state
    double contact_force_n_ = 0;  ///< over the last tick
};

}  // namespace downwash::simulation
