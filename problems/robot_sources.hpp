#pragma once

#include <string_view>

#include "downwash/base/export.hpp"

namespace downwash {

/// Which tags of a URDF become which keys of a robot file, in a sentence.
inline constexpr std::string_view urdf_keys =
    "masses: multirotor.mass_kg and arm.mass_kg; iyy: multirotor.pitch_inertia_kg_m2 and arm.inertia_kg_m2; <origin> "
    "of "
    "the rotors' joints: rotors.positions_m; of the arm's joint: arm.joint_m; its <limit> lower and upper, in radians: "
    "arm.limits_deg; effort: arm.max_torque_nm; <collision>: multirotor.body";

/// Which numbers of a thrust stand become which keys, in a sentence.
inline constexpr std::string_view thrust_stand_keys =
    "a thrust stand gives rotors.max_thrust_n, the greatest thrust of one rotor in N (gram-force times 0.00980665), "
    "and rotors.power_coefficient_w_n1p5, power in W over thrust in N to the 1.5";

/// Whether names of columns are those of a thrust stand: thrust, and power or current.
[[nodiscard]] DOWNWASH_EXPORT bool is_thrust_stand(std::string_view header);

/// What `explain` says of a word that is no key: where the numbers of a robot file come from. Empty for others.
[[nodiscard]] DOWNWASH_EXPORT std::string_view robot_source_text(std::string_view word);

}  // namespace downwash
