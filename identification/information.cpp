#include "downwash/identification/information.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace downwash::identification {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Innovations that are farther apart in time do not count as correlated [s].
constexpr double longest_correlation_s = 1;

/// One number of every tick.
template <class Rows>
auto every(const Rows& rows, Index first, Index step) {
    return rows(Eigen::seq(first, Eigen::last, step), Eigen::all);
}

/// Correlations of a series with itself from a lag of 1 on; those that chance explains are 0.
VectorXd correlations(const VectorXd& series, Index lags) {
    constexpr double significant = 3;  // standard deviations
    const auto count = static_cast<double>(series.size());
    const double power = series.squaredNorm();
    VectorXd all = VectorXd::Zero(lags);
    for (Index lag = 1; lag <= lags && power > 0; ++lag) {
        const Index rest = series.size() - lag;
        const double value = series.head(rest).dot(series.tail(rest)) / power;
        all[lag - 1] = std::abs(value) > significant / std::sqrt(count) ? value : 0;
    }
    return all;
}

/// Covariance of the score of a flight: S^T R S with the correlations R of its innovations in time.
MatrixXd score_covariance(const FlightInnovations& flight) {
    const Index columns = flight.slope.cols();
    const Index ticks = flight.value.size() / flight.per_tick;
    const Index lags = std::min(ticks / 4, static_cast<Index>(longest_correlation_s / flight.tick_s));
    MatrixXd sum = MatrixXd::Zero(columns, columns);
    for (Index measure = 0; measure < flight.per_tick; ++measure) {
        const MatrixXd slope = every(flight.slope, measure, flight.per_tick);
        const VectorXd correlation = correlations(every(flight.value, measure, flight.per_tick), lags);
        MatrixXd weighted = slope;
        for (Index lag = 1; lag <= lags; ++lag) {
            if (correlation[lag - 1] != 0) {
                weighted.topRows(ticks - lag) += correlation[lag - 1] * slope.bottomRows(ticks - lag);
                weighted.bottomRows(ticks - lag) += correlation[lag - 1] * slope.topRows(ticks - lag);
            }
        }
        sum += slope.transpose() * weighted;
    }
    return 0.5 * (sum + sum.transpose());
}

/// Adds a flight's matrix to that of all numbers.
void add_flight(const MatrixXd& own, Index of_vehicle, Index wind_at, MatrixXd& all) {
    const Index winds = own.rows() - of_vehicle;
    all.topLeftCorner(of_vehicle, of_vehicle) += own.topLeftCorner(of_vehicle, of_vehicle);
    all.block(wind_at, wind_at, winds, winds) += own.bottomRightCorner(winds, winds);
    all.block(0, wind_at, of_vehicle, winds) += own.topRightCorner(of_vehicle, winds);
    all.block(wind_at, 0, winds, of_vehicle) += own.bottomLeftCorner(winds, of_vehicle);
}

}  // namespace

Information information_of(const std::vector<FlightInnovations>& flights, Index of_vehicle) {
    Index count = of_vehicle;
    for (const FlightInnovations& flight : flights) {
        count += flight.slope.cols() - of_vehicle;
    }
    MatrixXd fisher = MatrixXd::Zero(count, count), score = fisher;
    Index wind_at = of_vehicle;
    for (const FlightInnovations& flight : flights) {
        add_flight(flight.slope.transpose() * flight.slope, of_vehicle, wind_at, fisher);
        add_flight(score_covariance(flight), of_vehicle, wind_at, score);
        wind_at += flight.slope.cols() - of_vehicle;
    }
    const MatrixXd one = MatrixXd::Identity(count, count);
    const MatrixXd bound = (fisher + one).llt().solve(one);
    Information all;
    const MatrixXd coloured = bound * (score + one) * bound;
    all.covariance = bound;
    // Never better than the bound of Cramer and Rao, nor worse than what was known before.
    const VectorXd wider =
        (coloured.diagonal().array().max(bound.diagonal().array()).min(1.0) / bound.diagonal().array()).sqrt();
    all.covariance = wider.asDiagonal() * bound * wider.asDiagonal();
    const Index winds = count - of_vehicle;
    const MatrixXd coupling = fisher.topRightCorner(of_vehicle, winds);
    all.fisher = fisher.topLeftCorner(of_vehicle, of_vehicle) -
                 coupling * (fisher.bottomRightCorner(winds, winds) + MatrixXd::Identity(winds, winds))
                                .llt()
                                .solve(coupling.transpose());
    return all;
}

}  // namespace downwash::identification
