#pragma once

#include <optional>

#include "downwash/base/export.hpp"
#include "downwash/controllers/model_inversion.hpp"
#include "downwash/controllers/space_law.hpp"

// Gains of the laws in space, from how fast each loop shall be or from those of the plane.

namespace downwash {

/// How fast loops shall be: the natural frequencies of position, attitude and joint errors [rad/s], all > 0. The
/// defaults are those of the shipped planar robot.
struct SpaceBandwidths {
    double translation_rad_s = 1.4;        ///< x and y, through the tilt
    double height_rad_s = 3.5;             ///< z, by thrust alone
    std::optional<double> attitude_rad_s;  ///< tilt; empty: 0.35 / lag of the rotors, at most 12
    double yaw_rad_s = 2.5;
    std::optional<double> joint_rad_s;        ///< empty: least_joint_rad_s
    std::optional<double> observer_gain_1_s;  ///< of the disturbance observer, >= 0; 0: none; empty: least_observer_1_s
    static constexpr double least_joint_rad_s = 4.7, least_observer_1_s = 3;
    bool operator==(const SpaceBandwidths&) const = default;
};

/// The gains of a model inversion. Every loop is critically damped but x and y, whose damping is 0.85 as in the plane.
/// @param rotor_time_constant_s of the rotors' lag, >= 0
[[nodiscard]] DOWNWASH_EXPORT SpaceInversion gains_for(double rotor_time_constant_s, const SpaceBandwidths& bandwidths);

/// The same for a model, whose lag counts.
template <int n>
[[nodiscard]] SpaceInversion gains_for(const SpaceModel<n>& model, const SpaceBandwidths& bandwidths = {}) {
    return gains_for(model.has_rotor_lag ? model.rotor_time_constant_s : 0.0, bandwidths);
}

/// The gains of PX4's cascade for the same bandwidths: every outer loop is a quarter as fast as the one inside it. Its
/// joints, which know nothing of their weight, are three times as stiff.
[[nodiscard]] DOWNWASH_EXPORT Px4Cascade cascade_gains_for(double rotor_time_constant_s,
                                                           const SpaceBandwidths& bandwidths);

/// The gains of the planar model inversion for the same bandwidths: those of gains_for(), x, z, pitch and arm.
[[nodiscard]] DOWNWASH_EXPORT ModelInversion planar_gains_for(double rotor_time_constant_s,
                                                              const SpaceBandwidths& bandwidths);

/// The law that flies in the plane of motion, x and z, as the planar one does. What the plane does not know has the
/// gains of what is nearest: y those of x, roll those of pitch. The pitch rate has no limit.
[[nodiscard]] DOWNWASH_EXPORT SpaceInversion from_planar(const ModelInversion& planar);

}  // namespace downwash
