#pragma once

#include <vector>

#include "downwash/judge/space_vehicle.hpp"

// From what a law demands of the rotors to their commands (docs/model.md 5.11). Private: not installed.

namespace downwash::judge {

/// What a law asks of the rotors, by what acts: lift along b3, and a torque about the multirotor's centre of mass.
struct LiftAndTorque {
    double lift_n;
    Eigen::Vector3d torque_nm;  ///< body axes
};

/// What the rotors do in a tick, as the law expects it.
struct ExpectedRotors {
    std::vector<double> command_n;       ///< within the limits
    Eigen::Vector3d force_n, torque_nm;  ///< in the middle of the tick, body axes
    double saturation;                   ///< greatest demand over its limit
};

/// How rotors share a demand. Immutable.
class RotorShares {
 public:
    /// @param nominal outlives this
    DOWNWASH_EXPORT RotorShares(const SpaceVehicle& nominal, double tick_s, double rotor_lead);

    /// The direction of the force of a lift without torque, body axes.
    [[nodiscard]] const Eigen::Vector3d& lift_axis() const noexcept { return lift_axis_; }
    /// The thrust along that axis when all rotors give their least.
    [[nodiscard]] double min_lift_n() const noexcept { return min_lift_n_; }
    /// The same when all give their greatest.
    [[nodiscard]] double max_lift_n() const noexcept { return max_lift_n_; }
    /// The thrusts of a lift without torque.
    [[nodiscard]] DOWNWASH_EXPORT std::vector<double> thrusts_of(double lift_n) const;

    /// @param ratio K of each rotor   @param now_n thrusts that the lag has reached
    [[nodiscard]] DOWNWASH_EXPORT ExpectedRotors command(const LiftAndTorque& demand, const std::vector<double>& ratio,
                                                         const std::vector<double>& now_n) const;

 private:
    using Shares = Eigen::Matrix<double, Eigen::Dynamic, 4>;
    [[nodiscard]] Eigen::VectorXd clipped(const Eigen::VectorXd& torque_n, const Eigen::VectorXd& yaw_n, double lift_n,
                                          const Eigen::VectorXd& low_n, const Eigen::VectorXd& high_n) const;

    const SpaceVehicle& nominal_;
    double tick_s_, rotor_lead_;
    Shares share_;  ///< of lift and of the three torques
    Eigen::Vector3d lift_axis_;
    double min_lift_n_ = 0, max_lift_n_ = 0;
};

}  // namespace downwash::judge
