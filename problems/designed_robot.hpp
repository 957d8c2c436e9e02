#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "downwash/base/export.hpp"
#include "downwash/base/parameter.hpp"
#include "downwash/controllers/space_gains.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/simulation/space_robot.hpp"

// Robots whose gains follow from how fast their loops shall be, whether or not their files have a controller.

namespace downwash {

/// Names of the laws that can be designed, as in robot files: "model-inversion". In the plane the first alone.
inline constexpr std::string_view designed_laws[] = {SpaceInversion::name, Px4Cascade::name};

/// A robot of a vertical plane or of space.
using AnyRobot = std::variant<Robot, SpaceRobot>;

/// Reads a robot, which need not have a controller, and gives it gains for bandwidths, rounded to four digits. Of a
/// controller in the file its type, rate and delay are kept.
/// @param law one of designed_laws; empty: that of the file, or the first
/// @throws ProblemFileError as read_robot() and read_space_robot(); also for a law in the plane that has no such gains
[[nodiscard]] DOWNWASH_EXPORT AnyRobot read_robot_for_design(const std::filesystem::path& file,
                                                             const SpaceBandwidths& bandwidths,
                                                             const std::optional<std::string>& law = {});

/// Gives a robot in space gains for bandwidths, rounded to four digits. Type, rate and delay are kept.
/// @param law one of designed_laws; empty: that of the robot   @pre space_robot_errors(robot) is empty
DOWNWASH_EXPORT void design_controller(SpaceRobot& robot, const SpaceBandwidths& bandwidths,
                                       const std::optional<std::string>& law = {});

/// The controller of a robot as its file has it: "controller:" and what is below.
[[nodiscard]] DOWNWASH_EXPORT std::string controller_yaml(const AnyRobot& robot);

}  // namespace downwash
