#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/simulation/robot.hpp"
#include "downwash/simulation/stability_margins.hpp"

namespace downwash {

/// The commands at which a loop is opened, one at a time, the others closed.
enum class LoopInput : std::uint8_t { thrust, pitch_torque, joint_torque };

/// All of them, in the order of their numbers.
inline constexpr std::array all_loop_inputs{LoopInput::thrust, LoopInput::pitch_torque, LoopInput::joint_torque};

/// Name in files: "pitch_torque".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(LoopInput input);

/// The margins of a vehicle that hovers in free air with its arm at an angle, for every LoopInput. The loop is that of
/// the sampled system: controller, rotor lag, delay and plant, linearised at the trim.
/// @pre robot_errors(robot) is empty   @throws InputError when it cannot hover or is unstable there
[[nodiscard]] DOWNWASH_EXPORT std::array<LoopMargins, 3> loop_margins(const Robot& robot, double arm_rad);

}  // namespace downwash
