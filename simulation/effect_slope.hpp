#pragma once

#include <memory>

#include "downwash/simulation/effect_field.hpp"
#include "downwash/simulation/flight_model.hpp"

// The surface effect around one configuration, as values and slopes: all that the stability of a hover depends on.

namespace downwash::simulation {

/// Steps of central differences over a surface effect: small beside a rotor, large beside the error of the quadrature
/// over its disc.
inline constexpr double slope_step_m = 1e-3;

/// A surface effect near one pose, linear in the position of every rotor. It counts as that of the ground.
class LinearEffect final : public FlightEffect {
 public:
    /// The tangent of the direct effect at the rotors of a level vehicle at a pose, and of what its control law reads.
    /// Where K has a kink (a disc at its cap) the slope is the mean of both sides over slope_step_m.
    LinearEffect(const FlightModel& model, const PlanarPose& pose);

    SidedFactor<double> at_rotor(int rotor, double x_m, double z_m) override { return {rotor_[rotor](x_m, z_m), 1}; }
    SidedFactor<double> at_body(double x_m, double z_m) override { return {body_(x_m, z_m), 1}; }
    double wall_nearness(double x_m, double z_m) override { return walls_(x_m, z_m) - 1; }
    LinearEffect& as_read() override { return read_ ? *read_ : *this; }

 private:
    struct Tangent {
        double x_m, z_m, factor, slope_x_1_m, slope_z_1_m;
        double operator()(double at_x_m, double at_z_m) const noexcept {
            return factor + slope_x_1_m * (at_x_m - x_m) + slope_z_1_m * (at_z_m - z_m);
        }
    };

    /// @param offset_x_m,offset_z_m displacement of the surfaces
    LinearEffect(const FlightModel& model, const PlanarPose& pose, double offset_x_m, double offset_z_m);

    Tangent rotor_[max_rotors] = {};
    Tangent body_ = {};
    Tangent walls_ = {};                  ///< wall nearness + 1
    std::unique_ptr<LinearEffect> read_;  ///< effect that the law reads, if its map is displaced
};

}  // namespace downwash::simulation
