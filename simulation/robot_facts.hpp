#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/simulation/loop_margins.hpp"
#include "downwash/simulation/robot.hpp"

namespace downwash {

/// The least margins of all loops at all examined arm angles, each with its place. Infinite where no loop has one.
struct LeastMargins {
    double gain_margin_db = 0;
    LoopInput gain_input = LoopInput::thrust;
    double gain_arm_rad = 0;
    double phase_margin_rad = 0;
    LoopInput phase_input = LoopInput::thrust;
    double phase_arm_rad = 0;
};

/// What a robot amounts to: numbers by which a user sees whether it is the one that was meant.
struct RobotFacts {
    double mass_kg = 0;           ///< multirotor and arm
    double thrust_to_weight = 0;  ///< greatest thrust of all rotors over the weight
    double reach_m = 0;           ///< farthest that the end of the arm gets from the multirotor's centre of mass
    /// Greatest share of its largest thrust that any rotor needs for a hover in free air, at any arm angle; above 1 it
    /// cannot hover there.
    double hover_share = 0;
    std::size_t hover_rotor = 0;  ///< that rotor, from 0
    double hover_arm_rad = 0;     ///< that arm angle
    /// Empty if at one of the examined arm angles the vehicle does not hover stably in free air.
    std::optional<LeastMargins> margins;
};

/// Where the margins of a robot are examined: with the arm up, level and down, as far as its limits allow; at the
/// limits if they allow none of these.
[[nodiscard]] DOWNWASH_EXPORT std::vector<double> examined_arm_angles_rad(const ArmParameters& arm);

/// @pre robot_errors(robot) is empty
[[nodiscard]] DOWNWASH_EXPORT RobotFacts robot_facts(const Robot& robot);

}  // namespace downwash
