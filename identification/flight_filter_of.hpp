#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "downwash/identification/flight_filter.hpp"
#include "downwash/identification/flight_propagation.hpp"

// Private to identification/: the filter of one number of joints.

namespace downwash::identification {

/// See FlightFilter. The state is a difference of estimates: see difference().
template <int n>
class FlightFilterOf final : public FlightFilter {
 public:
    FlightFilterOf(const SpaceRobot& robot, const LoggedFlight& flight, const FilterSettings& settings)
        : way_(robot, flight, settings),
          states_(measured + way_.lags() + GustModel::size),
          slopes_(way_.steps()),
          bends_(way_.steps()),
          gains_(way_.steps(), Eigen::MatrixXd(states_, measured)),
          scales_(way_.steps(), Eigen::VectorXd(measured)) {}

    [[nodiscard]] Eigen::Index size() const override { return static_cast<Eigen::Index>(way_.steps()) * measured; }
    [[nodiscard]] Eigen::Index per_tick() const override { return measured; }

    FilterPass linearise(const Trial& trial, const Noise& noise) override {
        way_.blow(vector_of(trial.world.wind_m_s));
        return pass(trial, noise, true);
    }
    FilterPass pass(const Trial& trial, const Noise& noise) override { return pass(trial, noise, false); }

    [[nodiscard]] bool innovations(const Trial& trial, Eigen::Ref<Eigen::VectorXd> out) const override {
        const Model model = way_.model_of(trial);
        Estimate at = way_.start(model);
        for (std::size_t i = 0; i < way_.steps(); ++i) {
            const std::size_t row = way_.first() + i;
            at = corrected(way_.after(model, at, row), bends_[i], way_.lags());
            const Eigen::VectorXd innovation = way_.innovation(model, at, row + 1);
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
            at = corrected(at, correction, way_.lags());
        }
        return out.allFinite();
    }

 private:
    static constexpr Eigen::Index measured = measured_numbers<n>;
    static constexpr Eigen::Index most_states = measured + max_rotors + GustModel::size;
    using Estimate = VehicleEstimate<n>;
    using Model = TrialModel<n>;
    using States = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_states, 1>;
    using StateMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_states, most_states>;

    /// Gains and scales of a trial. @param linearises whether slopes are computed anew
    FilterPass pass(const Trial& trial, const Noise& noise, bool linearises) {
        const Model model = way_.model_of(trial);
        FilterPass sums;
        Estimate at = way_.start(model);
        StateMatrix covariance = start_covariance(noise.measured);
        for (std::size_t i = 0; i < way_.steps(); ++i) {
            const std::size_t row = way_.first() + i;
            Estimate next = way_.after(model, at, row);
            if (linearises) {
                slopes_[i] = slope_of(model, at, next, row).template cast<float>();
                bends_[i] = bend_of(model, at, next, row, covariance);
            }
            next = corrected(next, bends_[i], way_.lags());
            grow(row, slopes_[i], noise, covariance);
            const Eigen::VectorXd innovation = way_.innovation(model, next, row + 1);
            const Eigen::VectorXd correction = correct(i, innovation, noise, covariance, sums);
            at = corrected(next, correction, way_.lags());
            if (!covariance.allFinite() || !correction.allFinite()) {
                return sums;
            }
        }
        sums.is_finite = std::isfinite(sums.cost);
        return sums;
    }

    /// Takes in what is measured at a tick, number by number. @return what it adds to the estimate
    Eigen::VectorXd correct(std::size_t step, const Eigen::VectorXd& innovation, const Noise& noise,
                            StateMatrix& covariance, FilterPass& sums) {
        Eigen::VectorXd correction = Eigen::VectorXd::Zero(states_);
        for (Eigen::Index j = 0; j < measured; ++j) {
            const auto channel = static_cast<std::size_t>(channel_of<n>(j));
            const double variance = covariance(j, j) + noise.measured[channel];
            const double error = innovation[j] - correction[j];
            sums.excess[channel] += error * error / (variance * variance);
            sums.weight[channel] += 1 / variance;
            sums.counts[channel] += 1;
            sums.cost += error * error / variance + std::log(variance);
            const double scale = 1 / std::sqrt(variance);
            const States root = scale * covariance.col(j);
            scales_[step][j] = scale;
            gains_[step].col(j) = scale * root;
            correction += error * gains_[step].col(j);
            covariance.noalias() -= root * root.transpose();
        }
        return correction;
    }

    [[nodiscard]] StateMatrix start_covariance(const PerChannel& noise) const {
        States variances(states_);
        for (Eigen::Index j = 0; j < measured; ++j) {
            variances[j] = noise[static_cast<std::size_t>(channel_of<n>(j))];
        }
        constexpr double thrust_error = 0.05;  // of a lag that has run over the lead
        variances.segment(measured, way_.lags()).setConstant(std::pow(thrust_error * way_.mean_command_n(), 2));
        variances.template tail<GustModel::size>().setZero();
        StateMatrix covariance = variances.asDiagonal();
        covariance.template bottomRightCorner<GustModel::size, GustModel::size>() = GustModel::covariance();
        return covariance;
    }

    /// The covariance one tick later, with what gusts and unmodelled accelerations add.
    void grow(std::size_t row, const Eigen::MatrixXf& slopes, const Noise& noise, StateMatrix& covariance) const {
        const StateMatrix slope = slopes.cast<double>();
        const StateMatrix half = slope * covariance;
        covariance.noalias() = half * slope.transpose();
        covariance = (0.5 * (covariance + covariance.transpose())).eval();
        const double dt_s = way_.step_s(row);
        covariance.template bottomRightCorner<GustModel::size, GustModel::size>() += way_.gusts().added(dt_s);
        for (Eigen::Index j = 6 + n; j < measured; ++j) {
            const std::size_t which = j < 9 + n ? 0 : j < 12 + n ? 1 : 2;
            covariance(j, j) += noise.accelerations[which] * dt_s;
        }
    }

    /// The linearised step from one tick to the next, by differences. Nothing depends on the position.
    Eigen::MatrixXd slope_of(const Model& model, const Estimate& at, const Estimate& next, std::size_t row) const {
        constexpr double step = 1e-5;  // SI units: the root of the rounding error of what is of order one
        Eigen::MatrixXd slope = Eigen::MatrixXd::Identity(states_, states_);
        Eigen::VectorXd by = Eigen::VectorXd::Zero(states_);
        for (Eigen::Index i = 3; i < states_; ++i) {
            by[i] = step;
            const Estimate moved = way_.after(model, corrected(at, by, way_.lags()), row);
            slope.col(i) = difference(moved, next, way_.lags()) / step;
            by[i] = 0;
        }
        return slope;
    }

    /// By how much the mean of a step differs from the step of the mean, as drag is not linear in the gust: half the
    /// second differences along the axes of the gust's covariance.
    Eigen::VectorXd bend_of(const Model& model, const Estimate& at, const Estimate& next, std::size_t row,
                            const StateMatrix& covariance) const {
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, GustModel::size, GustModel::size>> axes(
            covariance.template bottomRightCorner<GustModel::size, GustModel::size>());
        Eigen::VectorXd bend = Eigen::VectorXd::Zero(states_);
        Eigen::VectorXd by = Eigen::VectorXd::Zero(states_);
        for (int i = 0; i < GustModel::size; ++i) {
            const double sd = std::sqrt(std::max(0.0, axes.eigenvalues()[i]));
            for (const double side : {-sd, sd}) {
                by.template tail<GustModel::size>() = side * axes.eigenvectors().col(i);
                bend += 0.5 * difference(way_.after(model, corrected(at, by, way_.lags()), row), next, way_.lags());
            }
        }
        return bend;
    }

    FlightPropagation<n> way_;
    Eigen::Index states_;
    std::vector<Eigen::MatrixXf> slopes_;  ///< of each tick after the first estimate
    std::vector<Eigen::VectorXd> bends_;   ///< the same
    std::vector<Eigen::MatrixXd> gains_;   ///< the same: a column for each number that is measured
    std::vector<Eigen::VectorXd> scales_;
};

}  // namespace downwash::identification
