#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "downwash/identification/gust_model.hpp"
#include "downwash/identification/logged_flight.hpp"
#include "downwash/identification/surface_nodes.hpp"
#include "downwash/identification/trial.hpp"

// Private to identification/.

namespace downwash::identification {

/// What a pass of the filter says of the noise, summed over its innovations.
struct FilterPass {
    bool is_finite = false;
    PerChannel excess{};  ///< of squared innovations over the squares of their variances
    PerChannel weight{};  ///< of one over these variances
    PerChannel counts{};
    double cost = 0;  ///< -2 log likelihood, but for a constant

    FilterPass& operator+=(const FilterPass& other) {
        is_finite = is_finite && other.is_finite;
        for (std::size_t k = 0; k < channel_count; ++k) {
            excess[k] += other.excess[k];
            weight[k] += other.weight[k];
            counts[k] += other.counts[k];
        }
        cost += other.cost;
        return *this;
    }
};

/// A Kalman filter along a logged flight (docs/identification.md). Its gains are those of one trial, from pass(). With
/// them, the innovations of other trials are predictions that differ by what these trials change.
class FlightFilter {
 public:
    FlightFilter() = default;
    virtual ~FlightFilter() = default;
    FlightFilter(const FlightFilter&) = delete;
    FlightFilter& operator=(const FlightFilter&) = delete;

    /// Number of innovations.
    [[nodiscard]] virtual Eigen::Index size() const = 0;
    /// Innovations of one tick.
    [[nodiscard]] virtual Eigen::Index per_tick() const = 0;
    /// Finds the gains of a trial, and linearises its motion for later passes.
    virtual FilterPass linearise(const Trial& trial, const Noise& noise) = 0;
    /// Finds the gains of a trial whose motion is linear like that of the last linearise(): a fraction of its time.
    virtual FilterPass pass(const Trial& trial, const Noise& noise) = 0;
    /// Innovations over their standard deviations, tick after tick. @return whether all are finite
    [[nodiscard]] virtual bool innovations(const Trial& trial, Eigen::Ref<Eigen::VectorXd> out) const = 0;
};

/// How flights are filtered.
struct FilterSettings {
    GustSettings gusts;
    double lead_s = 0.1;   ///< what of the log comes before the first innovation: the greatest delay
    SurfaceNodes surface;  ///< nowhere: free air
};

/// @pre the flight has ticks beyond the lead; the robot is sound and has a number of joints that this library has
[[nodiscard]] std::unique_ptr<FlightFilter> make_flight_filter(const SpaceRobot& robot, const LoggedFlight& flight,
                                                               const FilterSettings& settings);

}  // namespace downwash::identification
