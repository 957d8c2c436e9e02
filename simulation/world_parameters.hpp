#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/simulation/robot.hpp"
#include "downwash/simulation/uncertainty.hpp"
#include "downwash/simulation/world.hpp"

// The one table of what worlds draw. Keys of files, random draws, the worlds of a search, sensitivities and the columns
// of Python come from it.

namespace downwash {

/// Where a parameter stands in the four worlds of a search in which dangers come early, as a quantile of its spread;
/// 0.5 where such a world leaves it alone.
struct DangerQuantiles {
    double strong = 0.5;    ///< Strong suction under a low scene, with slow rotors.
    double weak = 0.5;      ///< The reverse.
    double forward = 0.5;   ///< Wind and bias forwards, under a scene that is somewhat low, to the left of the plane.
    double backward = 0.5;  ///< Wind and bias backwards, under the same scene, to the right.
};

/// A number that worlds draw, each for itself.
struct WorldParameter {
    std::string name;  ///< Key below `uncertainty`, and an axis or a rotor's number where a key stands for several.
    Spread Uncertainty::*spread = nullptr;
    double (*nominal)(const Robot&) =
        nullptr;                     ///< Value of a number that the robot has; its range is that of the number itself.
    double World::*value = nullptr;  ///< nullptr: World::rotor_thrust_scale[rotor]
    int rotor = 0;
    DangerQuantiles danger = {};
    bool (*is_in_effect)(const Robot&) = nullptr;  ///< nullptr: it matters to every robot
    bool is_lateral = false;                       ///< It displaces the vehicle beside the plane, and nothing else.

    [[nodiscard]] bool matters_to(const Robot& robot) const noexcept {
        return is_in_effect == nullptr || is_in_effect(robot);
    }
    /// The parameter's value in a world.
    [[nodiscard]] double of(const World& world) const noexcept {
        return value != nullptr ? world.*value : world.rotor_thrust_scale[rotor];
    }
    /// Gives a world the value at a quantile of the spread, 0 to 1.
    DOWNWASH_EXPORT void put(World& world, const Uncertainty& uncertainty, const Robot& robot,
                             double quantile) const noexcept;
};

/// A key below `uncertainty`: a group of keys, or a spread.
struct UncertaintyKey {
    std::string_view path;  ///< "vehicle.mass_scale"
    std::string_view description;
    bool is_of_robot = false;               ///< A robot file may state it, too.
    Spread Uncertainty::*spread = nullptr;  ///< nullptr: a group
    std::vector<std::string_view> forms = {};
    double low = 0, high = 0;                   ///< Least and greatest number in the spread.
    double (*nominal)(const Robot&) = nullptr;  ///< See WorldParameter::nominal.
    /// Whether the robot has what is uncertain, and in words; nullptr: every robot has.
    bool (*is_in_effect)(const Robot&) = nullptr;
    std::string_view condition = {};
    double World::*noise = nullptr;  ///< Where worlds keep the sd of a number that is drawn anew in every tick.
};

/// Every key but `wind.gust_length_m`, which is no spread, in the order of files; groups come before their keys.
[[nodiscard]] DOWNWASH_EXPORT std::span<const UncertaintyKey> uncertainty_keys();

/// Every number that worlds draw, in the order of the draws, the lateral ones last; those of rotors that a robot does
/// not have change nothing.
[[nodiscard]] DOWNWASH_EXPORT std::span<const WorldParameter> world_parameters();

/// Those that matter to a robot, in the same order.
[[nodiscard]] DOWNWASH_EXPORT std::vector<const WorldParameter*> world_parameters_of(const Robot& robot);

/// The world in which each parameter is at a quantile of its spread.
/// @param quantiles from 0 to 1, in the order of world_parameters_of(robot)   @param tape which noise and which gusts
[[nodiscard]] DOWNWASH_EXPORT World world_at(const Uncertainty& uncertainty, const Robot& robot,
                                             std::span<const double> quantiles, std::uint64_t tape);

/// A world drawn at random. The same seed and index give the same world on any machine; index 0 is the nominal world.
[[nodiscard]] DOWNWASH_EXPORT World draw_world(const Uncertainty& uncertainty, const Robot& robot, std::uint64_t seed,
                                               std::uint64_t index);

/// What is wrong with an uncertainty beside a robot: rotors that would follow faster than ticks can tell, delays that
/// are too long. Keys as in files.
[[nodiscard]] DOWNWASH_EXPORT std::vector<KeyError> uncertainty_errors(const Uncertainty& uncertainty,
                                                                       const Robot& robot);

}  // namespace downwash
