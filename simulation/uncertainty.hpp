#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/base/spread.hpp"
#include "downwash/simulation/robot_uncertainty.hpp"
#include "downwash/simulation/world.hpp"

namespace downwash {

/// What is not known exactly, and how well it is known: of vehicle and sensors, and of the world around them.
/// docs/model.md 9 says where the defaults come from.
struct Uncertainty : RobotUncertainty {
    // Of K - 1, relative: the scatter of all measurements about the default models (docs/aeromap.md). A normal
    // distribution of the ground's would turn lift into suction; a uniform one of that standard deviation does not.
    Spread ceiling_scale = Spread::of_sd(0.15);
    Spread ground_scale = Spread::over(-0.8, 0.8);
    Spread scene_x_m = Spread::of_sd(0.02);
    Spread scene_z_m = Spread::of_sd(0.02);

    Spread wind_x_m_s = Spread::of_sd(0.5);
    Spread wind_z_m_s = Spread::of_sd(0.1);
    Spread gust_m_s = Spread::of_sd(0.3);
    double gust_length_x_m = 23;  ///< of the Dryden model 3 m above the ground
    double gust_length_z_m = 3;
};

/// A number that worlds draw, each for itself.
struct WorldParameter {
    std::string_view name;  ///< key below `uncertainty`, with a number for each rotor
    Spread Uncertainty::*spread;
    double World::*value;  ///< nullptr: World::rotor_thrust_scale[rotor]
    int rotor = 0;
    double (*believed)(const Robot&) = nullptr;  ///< of a number that the robot has; a range is one of this number then

    /// What a world has.
    [[nodiscard]] double of(const World& world) const noexcept {
        return value != nullptr ? world.*value : world.rotor_thrust_scale[rotor];
    }
};

/// All of them; those of rotors that a robot does not have change nothing.
[[nodiscard]] DOWNWASH_EXPORT std::span<const WorldParameter> world_parameters() noexcept;

/// The world in which each parameter is at a quantile of its spread, in the order of world_parameters().
/// @param quantiles from 0 to 1   @param tape which noise and which gusts
[[nodiscard]] DOWNWASH_EXPORT World world_at(const Uncertainty& uncertainty, const Robot& robot,
                                             std::span<const double> quantiles, std::uint64_t tape) noexcept;

/// A world drawn at random. The same seed and index give the same world on any machine; index 0 is the nominal world.
[[nodiscard]] DOWNWASH_EXPORT World draw_world(const Uncertainty& uncertainty, const Robot& robot, std::uint64_t seed,
                                               std::uint64_t index) noexcept;

/// What is wrong with an uncertainty beside a robot: rotors that would follow faster than ticks can tell, delays that
/// are too long. Keys as in files, without `uncertainty.`.
[[nodiscard]] DOWNWASH_EXPORT std::vector<KeyError> uncertainty_errors(const RobotUncertainty& uncertainty,
                                                                       const Robot& robot);

}  // namespace downwash
