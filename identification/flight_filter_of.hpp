#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "downwash/dynamics/space_integration.hpp"
#include "downwash/identification/flight_filter.hpp"
#include "downwash/simulation/space_world.hpp"

// Private to identification/: the filter of one number of joints.

namespace downwash::identification {

/// What acts on a vehicle in a logged flight: rotors, air, and surfaces as a trial has them.
struct LoggedSpace : dynamics::CalmSpace {
    const double* rotor_scale;  ///< thrust over that of the nominal coefficient, of each rotor
    const double* ratio;        ///< K of each rotor
    dynamics::LaneVector<double> wind_m_s;
    const SpaceSlipstreams* streams;
    double stream_scale;

    template <class T>
    T thrust_ratio(int rotor, const dynamics::LaneVector<T>& /*hub_m*/, const dynamics::LaneVector<T>& /*axis*/) const {
        return T(ratio[rotor]);
    }
    [[nodiscard]] double thrust_scale(int rotor) const { return rotor_scale[rotor]; }
    static constexpr bool has_wind = true;
    [[nodiscard]] dynamics::LaneVector<double> wind() const { return wind_m_s; }
    static constexpr bool has_wash = true;
    [[nodiscard]] const SpaceSlipstreams& slipstreams() const { return *streams; }
    [[nodiscard]] double wash_scale() const { return stream_scale; }
};

/// The turn by a vector, as a quaternion.
inline Eigen::Quaterniond turn_by(const Eigen::Vector3d& by_rad) {
    const double angle_rad = by_rad.norm();
    const double scale = angle_rad > 1e-12 ? std::sin(0.5 * angle_rad) / angle_rad : 0.5;
    return {std::cos(0.5 * angle_rad), scale * by_rad.x(), scale * by_rad.y(), scale * by_rad.z()};
}

/// The vector of a turn of less than pi.
inline Eigen::Vector3d vector_of_turn(Eigen::Quaterniond turn) {
    if (turn.w() < 0) {
        turn.coeffs() = -turn.coeffs();
    }
    const double sine = turn.vec().norm();
    return (sine > 1e-12 ? 2 * std::atan2(sine, turn.w()) / sine : 2.0) * turn.vec();
}

/// See FlightFilter. States differ from each other by: position, turn about body axes, joints, velocity, body rates,
/// joint rates; then the lagged thrusts of the rotors, and the gust along three axes. The first `measured` of these are
/// what a log has.
template <int n>
class FlightFilterOf final : public FlightFilter {
 public:
    FlightFilterOf(const SpaceRobot& robot, const LoggedFlight& flight, const FilterSettings& settings)
        : flight_(flight),
          settings_(settings),
          rotors_(static_cast<int>(robot.plant.rotors.size())),
          lags_(robot.plant.time_constant_s > 0 ? rotors_ : 0),
          states_(measured + lags_ + 3),
          streams_(space_slipstreams_of(robot.plant, robot.rotor_radius_m)) {
        const auto& ticks = flight.ticks;
        while (first_ + 1 < ticks.size() && ticks[first_].t_s < ticks.front().t_s + settings.lead_s) {
            ++first_;
        }
        const double mean_s = (ticks.back().t_s - ticks.front().t_s) / static_cast<double>(ticks.size() - 1);
        is_at_ticks_ = std::abs(mean_s * robot.controller.rate_hz - 1) < 0.01;
        find_surface_weights(robot);
    }

    [[nodiscard]] Eigen::Index size() const override { return static_cast<Eigen::Index>(steps()) * measured; }
    [[nodiscard]] Eigen::Index per_tick() const override { return measured; }

    FilterPass pass(const Trial& trial, const Noise& noise) override {
        const Model model(*this, trial);
        FilterPass sums;
        gains_.assign(steps(), Eigen::MatrixXd(states_, measured));
        scales_.assign(steps(), Eigen::VectorXd(measured));
        Estimate at = start(model);
        Eigen::MatrixXd covariance = start_covariance(noise.measured);
        for (std::size_t i = 0; i < steps(); ++i) {
            const std::size_t row = first_ + i;
            covariance = predicted_covariance(model, at, row, covariance);
            const double dt_s = flight_.ticks[row + 1].t_s - flight_.ticks[row].t_s;
            for (Eigen::Index j = 6 + n; j < measured; ++j) {
                covariance(j, j) += noise.accelerations[acceleration_of(j)] * dt_s;
            }
            at = after(model, at, row);
            const Eigen::VectorXd innovation = innovation_of(model, at, row + 1);
            Eigen::VectorXd correction = Eigen::VectorXd::Zero(states_);
            for (Eigen::Index j = 0; j < measured; ++j) {
                const auto channel = static_cast<std::size_t>(channel_of(j));
                const double variance = covariance(j, j) + noise.measured[channel];
                const double error = innovation[j] - correction[j];
                sums.squares[channel] += error * error;
                sums.predicted[channel] += covariance(j, j);
                sums.counts[channel] += 1;
                sums.cost += error * error / variance + std::log(variance);
                gains_[i].col(j) = covariance.col(j) / variance;
                scales_[i][j] = 1 / std::sqrt(variance);
                correction += error * gains_[i].col(j);
                covariance -= (gains_[i].col(j) * covariance.row(j)).eval();
                covariance = (0.5 * (covariance + covariance.transpose())).eval();
            }
            at = corrected(at, correction);
            if (!covariance.allFinite() || !correction.allFinite()) {
                return sums;
            }
        }
        sums.is_finite = true;
        return sums;
    }

    [[nodiscard]] bool innovations(const Trial& trial, Eigen::Ref<Eigen::VectorXd> out) const override {
        const Model model(*this, trial);
        Estimate at = start(model);
        for (std::size_t i = 0; i < steps(); ++i) {
            at = after(model, at, first_ + i);
            const Eigen::VectorXd innovation = innovation_of(model, at, first_ + i + 1);
            Eigen::VectorXd correction = Eigen::VectorXd::Zero(states_);
            auto whitened = out.segment(static_cast<Eigen::Index>(i) * measured, measured);
            for (Eigen::Index j = 0; j < measured; ++j) {
                const double error = innovation[j] - correction[j];
                whitened[j] = error * scales_[i][j];
                correction += error * gains_[i].col(j);
            }
            if (!correction.allFinite()) {
                return false;
            }
            at = corrected(at, correction);
        }
        return out.allFinite();
    }

 private:
    static constexpr Eigen::Index measured = 12 + 2 * n;

    /// An estimate of the vehicle, of the point that the robot file calls its centre of mass, and of the gust.
    struct Estimate {
        dynamics::SpaceState<double, n> vehicle;
        Eigen::Vector3d gust_m_s;
        /// What is seen of the vehicle less the vehicle: controllers see it linear between two ticks (docs/model.md 9).
        Eigen::Matrix<double, measured, 1> seen;
    };

    /// A trial as the filter needs it.
    struct Model {
        SpaceModel<n> plant;
        int joint_steps;
        Eigen::Vector3d center_of_mass_m, wind_m_s;
        double rotor_scale[max_rotors];
        double stream_scale, delay_s;
        Eigen::Quaterniond attitude_bias;
        double joint_offset_rad[room_for<n>] = {};
        std::vector<double> surface_effects;

        Model(const FlightFilterOf& filter, const Trial& trial)
            : plant(make_space_model<n>(simulation::real_plant(trial.robot, trial.world))),
              joint_steps(dynamics::joint_steps(plant, longest_step_s)),
              center_of_mass_m(vector_of(trial.world.center_of_mass_m)),
              wind_m_s(vector_of(trial.world.wind_m_s)),
              stream_scale(1 + trial.world.wash_scale),
              delay_s(std::clamp(trial.robot.controller.delay_s + trial.world.delay_s, 0.0, filter.settings_.lead_s)),
              attitude_bias(turn_by(vector_of(trial.world.attitude_bias_rad))),
              surface_effects(trial.surface_effects) {
            for (int i = 0; i < max_rotors; ++i) {
                rotor_scale[i] = (1 + trial.world.thrust_scale) * (1 + trial.world.rotor_thrust_scale[i]);
            }
            std::copy_n(trial.world.joint_offset_rad, n, joint_offset_rad);
            if (filter.flight_.is_true_motion) {
                delay_s = 0;
                attitude_bias.setIdentity();
                std::fill_n(joint_offset_rad, n, 0.0);
            }
        }
    };

    /// Runge-Kutta steps are at most so long.
    static constexpr double longest_step_s = 0.005;

    static Eigen::Vector3d vector_of(const Vector3& v) { return {v[0], v[1], v[2]}; }
    static Eigen::Quaterniond attitude_of(const double q[7]) { return {q[3], q[4], q[5], q[6]}; }
    static Channel channel_of(Eigen::Index measure) {
        return measure < 3        ? Channel::position
               : measure < 6      ? Channel::attitude
               : measure < 6 + n  ? Channel::joints
               : measure < 9 + n  ? Channel::velocity
               : measure < 12 + n ? Channel::body_rates
                                  : Channel::joint_rates;
    }

    /// Which acceleration changes a rate.
    static std::size_t acceleration_of(Eigen::Index rate) { return rate < 9 + n ? 0 : rate < 12 + n ? 1 : 2; }

    [[nodiscard]] std::size_t steps() const { return flight_.ticks.size() - 1 - first_; }

    /// The vehicle as it was seen at the first tick, with thrusts that followed the commands before.
    Estimate start(const Model& model) const {
        Estimate at{};
        at.gust_m_s.setZero();
        at.seen.setZero();
        const SpaceMotion& seen = flight_.ticks[first_].seen;
        const std::array<double, 4>& q = seen.attitude;
        const Eigen::Quaterniond attitude =
            (Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * model.attitude_bias.conjugate()).normalized();
        dynamics::SpaceState<double, n>& vehicle = at.vehicle;
        std::copy_n(seen.position_m.begin(), 3, vehicle.q);
        put_attitude(attitude, vehicle.q);
        std::copy_n(seen.velocity_m_s.begin(), 3, vehicle.u);
        std::copy_n(seen.body_rates_rad_s.begin(), 3, vehicle.u + 3);
        for (int i = 0; i < n; ++i) {
            vehicle.q[7 + i] = seen.joints_rad[static_cast<std::size_t>(i)] - model.joint_offset_rad[i];
            vehicle.u[6 + i] = seen.joint_rates_rad_s[static_cast<std::size_t>(i)];
        }
        const auto& ticks = flight_.ticks;
        std::copy_n(ticks.front().rotor_command_n.begin(), max_rotors, vehicle.thrust_n);
        const double until_s = ticks[first_].t_s - model.delay_s;
        for (std::size_t row = 0; lags_ > 0 && ticks[row].t_s < until_s; ++row) {
            const double step_s = std::min(ticks[row + 1].t_s, until_s) - ticks[row].t_s;
            const double kept = std::exp(-step_s / model.plant.rotor_time_constant_s);
            for (int i = 0; i < rotors_; ++i) {
                const double command_n = ticks[row].rotor_command_n[static_cast<std::size_t>(i)];
                vehicle.thrust_n[i] = command_n + kept * (vehicle.thrust_n[i] - command_n);
            }
        }
        return at;
    }

    [[nodiscard]] Eigen::MatrixXd start_covariance(const PerChannel& noise) const {
        Eigen::VectorXd variances(states_);
        for (Eigen::Index j = 0; j < measured; ++j) {
            variances[j] = noise[static_cast<std::size_t>(channel_of(j))];
        }
        double mean_n = 0;
        for (int i = 0; i < rotors_; ++i) {
            mean_n += flight_.ticks[first_].rotor_command_n[static_cast<std::size_t>(i)] / rotors_;
        }
        constexpr double thrust_error = 0.05;  // of a lag that has run over the lead
        variances.segment(measured, lags_).setConstant(std::pow(thrust_error * mean_n, 2));
        variances.tail(3).setConstant(settings_.gust_m_s * settings_.gust_m_s);
        return variances.asDiagonal();
    }

    static void put_attitude(const Eigen::Quaterniond& attitude, double q[7]) {
        q[3] = attitude.w();
        q[4] = attitude.x();
        q[5] = attitude.y();
        q[6] = attitude.z();
    }

    /// Moves a vehicle from the point of the robot file to the true centre of mass (sign 1), or back (sign -1).
    static void shift(const Eigen::Vector3d& center_of_mass_m, double sign, dynamics::SpaceState<double, n>& vehicle) {
        const Eigen::Quaterniond attitude = attitude_of(vehicle.q);
        const Eigen::Vector3d place = attitude * center_of_mass_m;
        const Eigen::Vector3d velocity =
            attitude * Eigen::Map<const Eigen::Vector3d>(vehicle.u + 3).cross(center_of_mass_m);
        for (int i = 0; i < 3; ++i) {
            vehicle.q[i] += sign * place[i];
            vehicle.u[i] += sign * velocity[i];
        }
    }

    /// The estimate of what is seen at the tick after `row`, from that of what is seen at `row`: both are as late as
    /// the trial has it. Commands change on the way.
    Estimate after(const Model& model, const Estimate& from, std::size_t row) const {
        const auto& ticks = flight_.ticks;
        double now_s = ticks[row].t_s - model.delay_s;
        const double end_s = ticks[row + 1].t_s - model.delay_s;
        std::size_t held = row;
        while (held > 0 && ticks[held].t_s > now_s) {
            --held;
        }
        double ratio[max_rotors];
        Estimate at = from;
        const Eigen::Vector3d wind = model.wind_m_s + from.gust_m_s;
        LoggedSpace around;
        around.rotor_scale = model.rotor_scale;
        around.ratio = ratio;
        around.wind_m_s = {wind.x(), wind.y(), wind.z()};
        around.streams = &streams_;
        around.stream_scale = model.stream_scale;
        find_ratios(model, row, ratio);
        shift(model.center_of_mass_m, 1, at.vehicle);
        dynamics::SpaceState<double, n> before = at.vehicle, ahead = at.vehicle;
        double share_before = 0;
        while (now_s < end_s) {
            before = at.vehicle;
            const double until_s = held + 1 < ticks.size() ? std::min(ticks[held + 1].t_s, end_s) : end_s;
            const double length_s = until_s - now_s;
            if (length_s > 1e-9) {
                dynamics::SpaceCommand<double, n> command{};
                std::copy_n(ticks[held].rotor_command_n.begin(), rotors_, command.thrust_n);
                std::copy_n(ticks[held].joint_torque_nm.begin(), n, command.joint_torque_nm);
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
            at.seen = seen_between(before, ahead, share_before, at.vehicle);
        }
        const double dt_s = ticks[row + 1].t_s - ticks[row].t_s;
        at.gust_m_s = gust_decay(dt_s).cwiseProduct(from.gust_m_s);
        return at;
    }

    /// Moves a vehicle on under one command.
    void move(const Model& model, const dynamics::SpaceCommand<double, n>& command, double length_s,
              const LoggedSpace& around, dynamics::SpaceState<double, n>& vehicle) const {
        const int count = model.joint_steps * static_cast<int>(std::ceil(length_s / longest_step_s - 1e-9));
        const double step_s = length_s / count;
        for (int i = 0; i < count; ++i) {
            vehicle = dynamics::space_step(model.plant, vehicle, command, step_s, around);
        }
    }

    /// What is seen between two ticks, less where the vehicle is then.
    static Eigen::Matrix<double, measured, 1> seen_between(const dynamics::SpaceState<double, n>& before,
                                                           const dynamics::SpaceState<double, n>& after,
                                                           double share_before,
                                                           const dynamics::SpaceState<double, n>& now) {
        const auto mixed = [&](double a, double b, double here) {
            return share_before * a + (1 - share_before) * b - here;
        };
        Eigen::Matrix<double, measured, 1> by;
        for (int i = 0; i < 3; ++i) {
            by[i] = mixed(before.q[i], after.q[i], now.q[i]);
            by[6 + n + i] = mixed(before.u[i], after.u[i], now.u[i]);
            by[9 + n + i] = mixed(before.u[3 + i], after.u[3 + i], now.u[3 + i]);
        }
        Eigen::Quaterniond attitude;
        attitude.coeffs() =
            share_before * attitude_of(before.q).coeffs() + (1 - share_before) * attitude_of(after.q).coeffs();
        by.template segment<3>(3) = vector_of_turn(attitude_of(now.q).conjugate() * attitude.normalized());
        for (int i = 0; i < n; ++i) {
            by[6 + i] = mixed(before.q[7 + i], after.q[7 + i], now.q[7 + i]);
            by[12 + n + i] = mixed(before.u[6 + i], after.u[6 + i], now.u[6 + i]);
        }
        return by;
    }

    [[nodiscard]] Eigen::Vector3d gust_decay(double dt_s) const {
        const double level = std::exp(-dt_s / settings_.gust_level_s);
        return {level, level, std::exp(-dt_s / settings_.gust_up_s)};
    }

    /// An estimate with a difference added.
    Estimate corrected(const Estimate& from, const Eigen::VectorXd& by) const {
        Estimate at = from;
        dynamics::SpaceState<double, n>& vehicle = at.vehicle;
        for (int i = 0; i < 3; ++i) {
            vehicle.q[i] += by[i];
            vehicle.u[i] += by[6 + n + i];
            vehicle.u[3 + i] += by[9 + n + i];
        }
        put_attitude((attitude_of(vehicle.q) * turn_by(by.template segment<3>(3))).normalized(), vehicle.q);
        for (int i = 0; i < n; ++i) {
            vehicle.q[7 + i] += by[6 + i];
            vehicle.u[6 + i] += by[12 + n + i];
        }
        for (int i = 0; i < lags_; ++i) {
            vehicle.thrust_n[i] += by[measured + i];
        }
        at.gust_m_s += by.tail(3);
        return at;
    }

    /// By what one estimate differs from another.
    Eigen::VectorXd difference(const Estimate& to, const Estimate& from) const {
        Eigen::VectorXd by(states_);
        const auto &a = to.vehicle, &b = from.vehicle;
        for (int i = 0; i < 3; ++i) {
            by[i] = a.q[i] - b.q[i];
            by[6 + n + i] = a.u[i] - b.u[i];
            by[9 + n + i] = a.u[3 + i] - b.u[3 + i];
        }
        by.template segment<3>(3) = vector_of_turn(attitude_of(b.q).conjugate() * attitude_of(a.q));
        for (int i = 0; i < n; ++i) {
            by[6 + i] = a.q[7 + i] - b.q[7 + i];
            by[12 + n + i] = a.u[6 + i] - b.u[6 + i];
        }
        for (int i = 0; i < lags_; ++i) {
            by[measured + i] = a.thrust_n[i] - b.thrust_n[i];
        }
        by.tail(3) = to.gust_m_s - from.gust_m_s;
        return by;
    }

    /// What was seen at a tick less what an estimate expects to be seen, as a difference of estimates.
    Eigen::VectorXd innovation_of(const Model& model, const Estimate& at, std::size_t row) const {
        const SpaceMotion& seen = flight_.ticks[row].seen;
        Eigen::VectorXd by(measured);
        for (std::size_t i = 0; i < 3; ++i) {
            const auto k = static_cast<Eigen::Index>(i);
            by[k] = seen.position_m[i] - at.vehicle.q[i];
            by[6 + n + k] = seen.velocity_m_s[i] - at.vehicle.u[i];
            by[9 + n + k] = seen.body_rates_rad_s[i] - at.vehicle.u[3 + i];
        }
        const std::array<double, 4>& q = seen.attitude;
        const Eigen::Quaterniond attitude =
            Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized() * model.attitude_bias.conjugate();
        by.template segment<3>(3) = vector_of_turn(attitude_of(at.vehicle.q).conjugate() * attitude);
        for (int i = 0; i < n; ++i) {
            const auto k = static_cast<std::size_t>(i);
            by[6 + i] = seen.joints_rad[k] - model.joint_offset_rad[i] - at.vehicle.q[7 + i];
            by[12 + n + i] = seen.joint_rates_rad_s[k] - at.vehicle.u[6 + i];
        }
        return by - at.seen;
    }

    /// The covariance one tick later: of the linearised step by differences, and the gusts that are new.
    Eigen::MatrixXd predicted_covariance(const Model& model, const Estimate& at, std::size_t row,
                                         const Eigen::MatrixXd& covariance) const {
        constexpr double step = 1e-5;  // SI units: the root of the rounding error of what is of order one
        const Estimate next = after(model, at, row);
        Eigen::MatrixXd slope(states_, states_);
        Eigen::VectorXd by = Eigen::VectorXd::Zero(states_);
        for (Eigen::Index i = 0; i < states_; ++i) {
            by[i] = step;
            slope.col(i) = difference(after(model, corrected(at, by), row), next) / step;
            by[i] = 0;
        }
        Eigen::MatrixXd grown = slope * covariance * slope.transpose();
        const Eigen::Vector3d kept = gust_decay(flight_.ticks[row + 1].t_s - flight_.ticks[row].t_s);
        for (Eigen::Index i = 0; i < 3; ++i) {
            grown(states_ - 3 + i, states_ - 3 + i) += std::pow(settings_.gust_m_s, 2) * (1 - kept[i] * kept[i]);
        }
        return grown;
    }

    /// Weights of the nodes at each tick and rotor.
    void find_surface_weights(const SpaceRobot& robot) {
        const SurfaceNodes& surface = settings_.surface;
        if (surface.count() == 0) {
            return;
        }
        weights_.assign(flight_.ticks.size() * static_cast<std::size_t>(rotors_) * surface.count(), 0.0);
        for (std::size_t row = 0; row < flight_.ticks.size(); ++row) {
            const SpaceMotion& seen = flight_.ticks[row].seen;
            const std::array<double, 4>& q = seen.attitude;
            const Eigen::Quaterniond attitude(q[0], q[1], q[2], q[3]);
            for (int i = 0; i < rotors_; ++i) {
                const double hub_m =
                    seen.position_m[2] +
                    (attitude * vector_of(robot.plant.rotors[static_cast<std::size_t>(i)].position_m)).z();
                double* weights = weights_at(row, i);
                if (surface.ground_m) {
                    add_weights((hub_m - *surface.ground_m) / robot.rotor_radius_m, weights);
                    weights += surface.of_one();
                }
                if (surface.ceiling_m) {
                    add_weights((*surface.ceiling_m - hub_m) / robot.rotor_radius_m, weights);
                }
            }
        }
    }
    void add_weights(double z_over_r, double* weights) const {
        const std::vector<double>& nodes = settings_.surface.z_over_r;
        const auto above = static_cast<std::size_t>(std::ranges::upper_bound(nodes, z_over_r) - nodes.begin());
        if (above == 0) {
            weights[0] = 1;
        } else if (above < nodes.size()) {
            const double share = (z_over_r - nodes[above - 1]) / (nodes[above] - nodes[above - 1]);
            weights[above - 1] = 1 - share;
            if (above < settings_.surface.of_one()) {
                weights[above] = share;
            }
        }
    }
    double* weights_at(std::size_t row, int rotor) {
        return weights_.data() +
               (row * static_cast<std::size_t>(rotors_) + static_cast<std::size_t>(rotor)) * settings_.surface.count();
    }
    void find_ratios(const Model& model, std::size_t row, double ratio[max_rotors]) const {
        std::fill_n(ratio, max_rotors, 1.0);
        const std::size_t nodes = settings_.surface.count();
        for (int i = 0; i < rotors_ && nodes > 0; ++i) {
            const double* weights =
                weights_.data() + (row * static_cast<std::size_t>(rotors_) + static_cast<std::size_t>(i)) * nodes;
            for (std::size_t k = 0; k < nodes; ++k) {
                ratio[i] += weights[k] * model.surface_effects[k];
            }
        }
    }

    const LoggedFlight& flight_;
    FilterSettings settings_;
    bool is_at_ticks_ = false;  ///< whether rows are the ticks of the controller
    int rotors_;
    Eigen::Index lags_, states_;
    SpaceSlipstreams streams_;
    std::size_t first_ = 0;               ///< tick of the first estimate
    std::vector<Eigen::MatrixXd> gains_;  ///< of each tick after it, a column for each number that is measured
    std::vector<Eigen::VectorXd> scales_;
    std::vector<double> weights_;
};

}  // namespace downwash::identification
