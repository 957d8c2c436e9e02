#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "downwash/dynamics/space_integration.hpp"
#include "downwash/identification/flight_filter.hpp"
#include "downwash/identification/surface_weights.hpp"
#include "downwash/identification/trial_model.hpp"

// Private to identification/: a vehicle of n joints under the commands of a log.

namespace downwash::identification {

template <int n>
class FlightPropagation {
 public:
    using Estimate = VehicleEstimate<n>;
    using Model = TrialModel<n>;

    FlightPropagation(const SpaceRobot& robot, const LoggedFlight& flight, const FilterSettings& settings)
        : flight_(flight),
          settings_(settings),
          gusts_(settings.gusts, Eigen::Vector3d::Zero()),
          rotors_(static_cast<int>(robot.plant.rotors.size())),
          lags_(robot.plant.time_constant_s > 0 ? rotors_ : 0),
          streams_(space_slipstreams_of(robot.plant, robot.rotor_radius_m)),
          weights_(robot, flight, settings.surface) {
        const auto& ticks = flight.ticks;
        while (first_ + 1 < ticks.size() && ticks[first_].t_s < ticks.front().t_s + settings.lead_s) {
            ++first_;
        }
        const double mean_s = (ticks.back().t_s - ticks.front().t_s) / static_cast<double>(ticks.size() - 1);
        is_at_ticks_ = std::abs(mean_s * robot.controller.rate_hz - 1) < 0.01;
    }

    [[nodiscard]] Model model_of(const Trial& trial) const { return {trial, flight_, settings_.lead_s}; }
    [[nodiscard]] Eigen::Index lags() const { return lags_; }
    /// The tick of the first estimate.
    [[nodiscard]] std::size_t first() const { return first_; }
    [[nodiscard]] std::size_t steps() const { return flight_.ticks.size() - 1 - first_; }
    [[nodiscard]] double step_s(std::size_t row) const { return flight_.ticks[row + 1].t_s - flight_.ticks[row].t_s; }
    /// Mean thrust of a rotor at the first estimate [N].
    [[nodiscard]] double mean_command_n() const {
        const auto& commands_n = flight_.ticks[first_].rotor_command_n;
        double sum_n = 0;
        for (int i = 0; i < rotors_; ++i) {
            sum_n += commands_n[static_cast<std::size_t>(i)];
        }
        return sum_n / rotors_;
    }

    /// The vehicle as it was seen at the first tick, with thrusts that followed the commands before.
    [[nodiscard]] Estimate start(const Model& model) const {
        Estimate at{};
        at.gust.setZero();
        at.seen.setZero();
        at.vehicle = vehicle_seen(model, first_);
        const auto& ticks = flight_.ticks;
        std::copy_n(ticks.front().rotor_command_n.begin(), max_rotors, at.vehicle.thrust_n);
        const double until_s = ticks[first_].t_s - model.delay_s;
        for (std::size_t row = 0; lags_ > 0 && ticks[row].t_s < until_s; ++row) {
            const double length_s = std::min(ticks[row + 1].t_s, until_s) - ticks[row].t_s;
            const double kept = std::exp(-length_s / model.plant.rotor_time_constant_s);
            for (int i = 0; i < rotors_; ++i) {
                const double command_n = ticks[row].rotor_command_n[static_cast<std::size_t>(i)];
                at.vehicle.thrust_n[i] = command_n + kept * (at.vehicle.thrust_n[i] - command_n);
            }
        }
        return at;
    }

    /// The estimate of what is seen at the tick after `row`, from that of what is seen at `row`: both are as late as
    /// the trial has it. Commands change on the way.
    [[nodiscard]] Estimate after(const Model& model, const Estimate& from, std::size_t row) const {
        const auto& ticks = flight_.ticks;
        double now_s = ticks[row].t_s - model.delay_s;
        const double end_s = ticks[row + 1].t_s - model.delay_s;
        std::size_t held = row;
        while (held > 0 && ticks[held].t_s > now_s) {
            --held;
        }
        double ratio[max_rotors];
        weights_.find_ratios(model.surface_effects, row, ratio);
        const LoggedSpace around = surroundings(model, model.wind_m_s + gusts_.gust_m_s(from.gust), ratio);
        Estimate at = from;
        shift(model.center_of_mass_m, 1, at.vehicle);
        dynamics::SpaceState<double, n> before = at.vehicle, ahead = at.vehicle;
        double share_before = 0;
        while (now_s < end_s) {
            before = at.vehicle;
            const double until_s = held + 1 < ticks.size() ? std::min(ticks[held + 1].t_s, end_s) : end_s;
            const double length_s = until_s - now_s;
            if (length_s > 1e-9) {
                const dynamics::SpaceCommand<double, n> command = command_at(held);
                move(model, command, length_s, around, at.vehicle);
                ahead = at.vehicle;
                if (is_at_ticks_ && until_s == end_s && held + 1 < ticks.size()) {
                    const double rest_s = ticks[held + 1].t_s - end_s;
                    share_before = rest_s / (ticks[held + 1].t_s - ticks[held].t_s);
                    if (rest_s > 1e-9) {
                        move(model, command, rest_s, around, ahead);
                    }
                }
            }
            now_s = until_s;
            ++held;
        }
        shift(model.center_of_mass_m, -1, at.vehicle);
        at.seen.setZero();
        if (share_before > 1e-9) {
            shift(model.center_of_mass_m, -1, before);
            shift(model.center_of_mass_m, -1, ahead);
            at.seen = seen_between<n>(before, ahead, share_before, at.vehicle);
        }
        at.gust = gusts_.after(from.gust, step_s(row));
        return at;
    }

    [[nodiscard]] const GustModel& gusts() const { return gusts_; }
    /// Gusts pass along with this wind from now on.
    void blow(const Eigen::Vector3d& steady_wind_m_s) { gusts_ = GustModel(settings_.gusts, steady_wind_m_s); }

    /// What was seen at a tick less what an estimate expects to be seen, as a difference of estimates.
    [[nodiscard]] Eigen::VectorXd innovation(const Model& model, const Estimate& at, std::size_t row) const {
        return motion_between<n>(vehicle_seen(model, row), at.vehicle) - at.seen;
    }

 private:
    /// The vehicle as it was seen at a tick, without constant errors.
    [[nodiscard]] dynamics::SpaceState<double, n> vehicle_seen(const Model& model, std::size_t row) const {
        const SpaceMotion& seen = flight_.ticks[row].seen;
        dynamics::SpaceState<double, n> vehicle{};
        const std::array<double, 4>& q = seen.attitude;
        const Eigen::Quaterniond attitude(q[0], q[1], q[2], q[3]);
        std::copy_n(seen.position_m.begin(), 3, vehicle.q);
        put_attitude((attitude * model.attitude_bias.conjugate()).normalized(), vehicle.q);
        std::copy_n(seen.velocity_m_s.begin(), 3, vehicle.u);
        std::copy_n(seen.body_rates_rad_s.begin(), 3, vehicle.u + 3);
        for (int i = 0; i < n; ++i) {
            vehicle.q[7 + i] = seen.joints_rad[static_cast<std::size_t>(i)] - model.joint_offset_rad[i];
            vehicle.u[6 + i] = seen.joint_rates_rad_s[static_cast<std::size_t>(i)];
        }
        return vehicle;
    }

    [[nodiscard]] dynamics::SpaceCommand<double, n> command_at(std::size_t row) const {
        dynamics::SpaceCommand<double, n> command{};
        std::copy_n(flight_.ticks[row].rotor_command_n.begin(), rotors_, command.thrust_n);
        std::copy_n(flight_.ticks[row].joint_torque_nm.begin(), n, command.joint_torque_nm);
        return command;
    }

    [[nodiscard]] LoggedSpace surroundings(const Model& model, const Eigen::Vector3d& wind_m_s,
                                           const double* ratio) const {
        LoggedSpace around;
        around.rotor_scale = model.rotor_scale;
        around.ratio = ratio;
        around.wind_m_s = {wind_m_s.x(), wind_m_s.y(), wind_m_s.z()};
        around.streams = &streams_;
        around.stream_scale = model.stream_scale;
        return around;
    }

    /// Moves a vehicle on under one command.
    static void move(const Model& model, const dynamics::SpaceCommand<double, n>& command, double length_s,
                     const LoggedSpace& around, dynamics::SpaceState<double, n>& vehicle) {
        const int count = model.joint_steps * static_cast<int>(std::ceil(length_s / longest_step_s - 1e-9));
        const double step_s = length_s / count;
        for (int i = 0; i < count; ++i) {
            vehicle = dynamics::space_step(model.plant, vehicle, command, step_s, around);
        }
    }

    const LoggedFlight& flight_;
    FilterSettings settings_;
    GustModel gusts_;
    bool is_at_ticks_ = false;  ///< whether rows are the ticks of the controller
    int rotors_;
    Eigen::Index lags_;
    SpaceSlipstreams streams_;
    SurfaceWeights weights_;
    std::size_t first_ = 0;
};

}  // namespace downwash::identification
