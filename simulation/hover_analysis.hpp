#pragma once

#include <cstdint>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/simulation/flight_model.hpp"
#include "downwash/simulation/hover_trim.hpp"

namespace downwash {

/// Whether a vehicle can hover at a point.
enum class HoldVerdict : std::uint8_t {
    not_flyable,     ///< a rotor disc is nearer to an obstacle than the effects are known (docs/model.md 4.4)
    in_collision,    ///< touches an obstacle
    no_equilibrium,  ///< no reference makes the controller balance weight and surface effects
    unstable,        ///< an equilibrium, but the smallest disturbance grows
    unknown,         ///< stable, unless a ceiling pulls more than the model knows: K is capped or was not measured
    stable,          ///< an equilibrium, and small disturbances decay
};

/// Name in files: "no_equilibrium".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(HoldVerdict verdict);
/// Name in files: "rotor_thrust".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(HoldLimit limit);

/// How a small disturbance of a hover develops, and the stiffnesses that compete.
struct HoverStability {
    /// Spectral radius of the Jacobian of one tick at the fixed point; stable below 1. Infinite where numbers are too
    /// large to tell.
    double spectral_radius = 0;
    double growth_rate_1_s = 0;  ///< rate of the slowest decay, or fastest growth: ln(spectral radius) / tick
    double frequency_rad_s = 0;  ///< frequency of that mode; 0 if it does not oscillate
    int growing_modes = 0;       ///< eigenvalues outside the unit circle

    double force_slope_n_m = 0;      ///< dF/dz at the trim commands; positive pulls away from the height that is held
    double force_gain_n_m = 0;       ///< what position_kp sets against it: force in effect per metre of error
    double torque_slope_nm_rad = 0;  ///< dT2/dpitch at the trim commands; positive tips over
    double torque_gain_nm_rad = 0;   ///< what k5 ku5 set against it: torque in effect per radian of error
};

/// Whether and how a vehicle can hover at a point with its own controller.
struct HoverAnalysis {
    HoldVerdict verdict = HoldVerdict::not_flyable;
    HoverTrim trim;            ///< from no_equilibrium on
    HoverStability stability;  ///< from unstable on; for unknown, as if the model were complete
};

/// Whether the vehicle can hover with its centre of mass at (x, z) and the arm at an angle, with surface effects
/// evaluated directly. Linear theory: it tells how disturbances of a millimetre develop, not how large they may be.
/// @param x_m,z_m,arm_rad finite; where the vehicle itself should be (not its reference)
[[nodiscard]] DOWNWASH_EXPORT HoverAnalysis analyse_hover(const FlightModel& model, double x_m, double z_m,
                                                          double arm_rad);

}  // namespace downwash
