#pragma once

#include <array>
#include <cstdint>
#include <deque>

#include "downwash/judge/space_bodies.hpp"
#include "downwash/simulation/noise.hpp"

// What a world in space adds to what the controller sees and to the air (docs/model.md 9). Private: not installed.

namespace downwash::judge {

/// The standard normal numbers of one control tick: noise of position, velocity and gyro, three each; one of the gust
/// along its way, two of the gust to the left, two of the gust upward.
using SpaceTape = std::array<double, simulation::drawn_space_noise_count>;

/// The numbers of a tick; zeros in a world without noise and gusts.
[[nodiscard]] DOWNWASH_EXPORT SpaceTape tape_at(const SpaceWorld& world, std::int64_t tick);

/// A world in calm air and with sensors without noise.
[[nodiscard]] DOWNWASH_EXPORT SpaceWorld without_noise(SpaceWorld world) noexcept;

/// Sensors with a delay, a bias and noise.
class SpaceSensors {
 public:
    /// @param now the vehicle was always as it is
    DOWNWASH_EXPORT SpaceSensors(const SpaceWorld& world, const SpaceRobot& robot, const SpaceCoordinates& now);

    /// What the controller sees in a tick: linear between what was so many ticks ago.
    [[nodiscard]] DOWNWASH_EXPORT SpaceCoordinates seen(const SpaceCoordinates& now, const SpaceTape& tape) const;
    /// Keeps what was at this tick, for the next ones.
    DOWNWASH_EXPORT void remember(const SpaceCoordinates& now);

 private:
    SpaceWorld world_;
    double delay_ticks_;
    std::deque<SpaceCoordinates> past_;  ///< one tick ago, two ticks ago, ...
};

/// Gusts of the Dryden model along three axes, sampled at the control ticks.
class SpaceGusts {
 public:
    /// They blow already: their state is drawn with the numbers before the first tick.
    DOWNWASH_EXPORT SpaceGusts(const SpaceWorld& world, double tick_s);

    /// Velocity of the air in a tick, steady wind included [m/s].
    [[nodiscard]] DOWNWASH_EXPORT Eigen::Vector3d wind() const;
    /// Goes on by a tick.
    DOWNWASH_EXPORT void next(const SpaceTape& tape);

 private:
    /// Two filters of first order in a row: a gust across its way.
    struct Across {
        Eigen::Matrix2d step = Eigen::Matrix2d::Zero(), noise = Eigen::Matrix2d::Zero();
        Eigen::Vector2d state = Eigen::Vector2d::Zero();

        /// @param passed tick times speed over length   @param first the numbers before the first tick
        void start(double passed, const Eigen::Vector2d& first);
        [[nodiscard]] double gust() const;
    };

    SpaceWorld world_;
    Eigen::Vector3d ahead_, left_;  ///< level, along the way of the gusts and across it
    double decay_ = 0, noise_ = 0, along_ = 0;
    Across to_left_, upward_;
};

}  // namespace downwash::judge
