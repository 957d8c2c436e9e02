#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/simulation/space_robot.hpp"
#include "downwash/simulation/space_world_description.hpp"
#include "downwash/simulation/world_parameters.hpp"

// The one table of what worlds in space draw, as world_parameters.hpp is that of the plane: keys of files and random
// draws come from it. Spreads are those of the same Uncertainty.

namespace downwash {

/// A number that worlds in space draw, each for itself.
struct SpaceWorldParameter {
    std::string name;  ///< Key below `uncertainty`, and an axis or a number of a rotor or joint.
    Spread Uncertainty::*spread = nullptr;
    double& (*place)(SpaceWorld&, int number) = nullptr;  ///< Where a world keeps it.
    int number = 0;                                       ///< Of the axis, the rotor or the joint, from 0.
    double (*nominal)(const SpaceRobot&) = nullptr;       ///< See WorldParameter.
    DangerQuantiles danger = {};
    bool (*is_in_effect)(const SpaceRobot&, int number) = nullptr;  ///< nullptr: it matters to every robot

    [[nodiscard]] bool matters_to(const SpaceRobot& robot) const noexcept {
        return is_in_effect == nullptr || is_in_effect(robot, number);
    }
    /// The parameter's value in a world.
    [[nodiscard]] double of(SpaceWorld world) const noexcept { return place(world, number); }
    /// Gives a world the value at a quantile of the spread, 0 to 1.
    DOWNWASH_EXPORT void put(SpaceWorld& world, const Uncertainty& uncertainty, const SpaceRobot& robot,
                             double quantile) const noexcept;
};

/// Every key below `uncertainty` of a problem in space but `wind.gust_length_m`, in the order of files; groups come
/// before their keys. Conditions ask a planar robot with the same rotors, controller and wash.
[[nodiscard]] DOWNWASH_EXPORT std::span<const UncertaintyKey> space_uncertainty_keys();

/// Every number that worlds in space draw, in the order of the draws. Those of rotors and joints that a robot does not
/// have are drawn, too, and change nothing: a robot's worlds do not depend on their number.
[[nodiscard]] DOWNWASH_EXPORT std::span<const SpaceWorldParameter> space_world_parameters();

/// Those that matter to a robot, in the same order.
[[nodiscard]] DOWNWASH_EXPORT std::vector<const SpaceWorldParameter*> space_world_parameters_of(
    const SpaceRobot& robot);

/// The world in which each parameter is at a quantile of its spread.
/// @param quantiles from 0 to 1, in the order of space_world_parameters_of(robot)   @param tape which noise and gusts
[[nodiscard]] DOWNWASH_EXPORT SpaceWorld space_world_at(const Uncertainty& uncertainty, const SpaceRobot& robot,
                                                        std::span<const double> quantiles, std::uint64_t tape);

/// A world drawn at random. The same seed and index give the same world on any machine; index 0 is the nominal world.
[[nodiscard]] DOWNWASH_EXPORT SpaceWorld draw_space_world(const Uncertainty& uncertainty, const SpaceRobot& robot,
                                                          std::uint64_t seed, std::uint64_t index);

}  // namespace downwash
