#pragma once

#include <optional>

#include "downwash/controllers/aids.hpp"
#include "downwash/dynamics/flight_step.hpp"

// The surface effect around one configuration, as values and slopes: all that the stability of a hover depends on.

namespace downwash::simulation {

/// Steps of central differences over a surface effect: small beside a rotor, large beside the error of the quadrature
/// over its disc.
inline constexpr double slope_step_m = 1e-3;

/// A surface effect near one configuration, linear in the position of every rotor.
class LinearEffect {
 public:
    /// The tangent of `factor` where a vehicle at this configuration has its rotors. Where K has a kink (a disc at
    /// its cap) the slope is the mean of both sides over slope_step_m.
    /// @param factor callable (rotor, x_m, z_m) -> K   @param feed_forward of the control law, which reads elsewhere
    template <class Factor>
    LinearEffect(const PlantModel& plant, const dynamics::Attitude<double>& attitude, double x_m, double z_m,
                 const Factor& factor, const std::optional<controllers::FeedForward>& feed_forward = {}) {
        // Whatever the plant asks for on its way to a force is what has to be known.
        const double nothing_n[max_rotors] = {};
        static_cast<void>(
            dynamics::rotor_wrench(plant, attitude, x_m, z_m, nothing_n, [&](int rotor, double x, double z) {
                acting_[rotor] = tangent_of(factor, rotor, x, z);
                read_[rotor] = acting_[rotor];
                if (feed_forward) {
                    read_[rotor] =
                        tangent_of(factor, rotor, x - feed_forward->offset_x_m, z - feed_forward->offset_z_m);
                }
                return 1.0;
            }));
    }

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
    template <class Factor>
    static Tangent tangent_of(const Factor& factor, int rotor, double x, double z) {
        constexpr double h = slope_step_m;
        return {x, z, factor(rotor, x, z), (factor(rotor, x + h, z) - factor(rotor, x - h, z)) / (2 * h),
                (factor(rotor, x, z + h) - factor(rotor, x, z - h)) / (2 * h)};
    }

    // Two more for what acts on the body.
    Tangent acting_[max_rotors + 2] = {};
    Tangent read_[max_rotors + 2] = {};
};

}  // namespace downwash::simulation
