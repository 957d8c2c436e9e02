#pragma once

#include <Eigen/Core>
#include <vector>

// Private to identification/.

namespace downwash::identification {

/// What the innovations of one flight are like at the most likely numbers.
struct FlightInnovations {
    Eigen::VectorXd value;  ///< over their standard deviations, tick after tick
    Eigen::MatrixXd slope;  ///< by the numbers of the vehicle, then by those of the flight's wind
    Eigen::Index per_tick = 1;
    double tick_s = 0;  ///< mean time between two ticks
};

/// What flights say of the numbers, in standard deviations of what was known before.
struct Information {
    Eigen::MatrixXd fisher;      ///< of the flights alone, of the vehicle's numbers: winds are marginalised
    Eigen::MatrixXd covariance;  ///< of all numbers with what was known before: the vehicle's, then each flight's wind
};

/// Fisher's information and the covariance of the estimate. Where innovations are correlated in time, the covariance
/// grows by what that changes (E. A. Morelli and V. Klein, Accuracy of aerodynamic model parameters estimated from
/// flight test data, Journal of Guidance, Control, and Dynamics 20, 1997).
/// @param of_vehicle how many numbers all flights share
[[nodiscard]] Information information_of(const std::vector<FlightInnovations>& flights, Eigen::Index of_vehicle);

}  // namespace downwash::identification
