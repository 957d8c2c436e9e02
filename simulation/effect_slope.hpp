#pragma once

#include "downwash/simulation/flight_model.hpp"

// The surface effect around one configuration, as values and slopes: all that the stability of a hover depends on.

namespace downwash::simulation {

/// Steps of central differences over a surface effect: small beside a rotor, large beside the error of the quadrature
/// over its disc.
inline constexpr double slope_step_m = 1e-3;

/// A surface effect near one configuration, linear in the position of every rotor.
class LinearEffect {
 public:
    /// The tangent of the direct effect at the rotors of a vehicle at a pose, and of what its control law reads. Where
    /// K has a kink (a disc at its cap) the slope is the mean of both sides over slope_step_m.
    LinearEffect(const FlightModel& model, const PlanarPose& pose);

    double operator()(int rotor, double x_m, double z_m) const noexcept { return acting_[rotor](x_m, z_m); }
    /// What the law reads there; see ReadEffect.
    [[nodiscard]] double read(int rotor, double x_m, double z_m) const noexcept { return read_[rotor](x_m, z_m); }

 private:
    struct Tangent {
        double x_m, z_m, factor, slope_x_1_m, slope_z_1_m;
        double operator()(double at_x_m, double at_z_m) const noexcept {
            return factor + slope_x_1_m * (at_x_m - x_m) + slope_z_1_m * (at_z_m - z_m);
        }
    };

    // Two more for what acts on the body.
    Tangent acting_[max_rotors + 2] = {};
    Tangent read_[max_rotors + 2] = {};
};

}  // namespace downwash::simulation
