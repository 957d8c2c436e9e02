#pragma once

#include <Eigen/Core>

// Private to identification/.

namespace downwash::identification {

/// What is known of the gusts of a flight.
struct GustSettings {
    double sd_m_s = 0;                           ///< in every direction
    double level_length_m = 1, up_length_m = 1;  ///< length scales along the ground, and upward
};

/// The Dryden gusts of worlds (docs/model.md 9.1) as a linear process that a filter can follow. Its state has unit
/// variance: one number of the gust along the wind's way, then two of that to the left and two of that upward.
class GustModel {
 public:
    static constexpr int size = 5;
    using State = Eigen::Matrix<double, size, 1>;
    using Matrix = Eigen::Matrix<double, size, size>;

    /// @param steady_wind_m_s carries the gusts past the vehicle, with 1 m/s at least
    GustModel(const GustSettings& settings, const Eigen::Vector3d& steady_wind_m_s);

    /// The gust of a state [m/s].
    [[nodiscard]] Eigen::Vector3d gust_m_s(const State& state) const { return to_gust_ * state; }
    /// What is left of a state after a time.
    [[nodiscard]] State after(const State& state, double time_s) const;
    /// The covariance of the state before anything is seen.
    [[nodiscard]] static Matrix covariance();
    /// What a time adds to the covariance.
    [[nodiscard]] Matrix added(double time_s) const;

 private:
    Eigen::Matrix<double, 3, size> to_gust_;
    double level_1_s_, up_1_s_;  ///< length scales that pass in a second
};

}  // namespace downwash::identification
