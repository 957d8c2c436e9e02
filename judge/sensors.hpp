#pragma once

#include <array>
#include <vector>

#include "downwash/judge/equations_of_motion.hpp"
#include "downwash/simulation/noise.hpp"

// What a world adds to what the controller sees and to the air (docs/model.md 9). Private: not installed.

namespace downwash::judge {

/// The standard normal numbers of one control tick: noise of position x, z, velocity x, z and gyro; three of gusts.
using Tape = std::array<double, simulation::noise_count>;

/// The numbers of a tick; zeros in a world without noise and gusts.
[[nodiscard]] Tape tape_at(const World& world, std::int64_t tick);

/// Whether a world has noise or gusts.
[[nodiscard]] bool has_noise(const World& world) noexcept;

/// A world in calm air and with sensors without noise.
[[nodiscard]] World without_noise(World world) noexcept;

/// Sensors with a delay, a bias and noise.
class Sensors {
 public:
    /// @param now the vehicle was always as it is
    Sensors(const World& world, const Robot& robot, const Motion& now);

    /// What the controller sees in a tick: linear between what was so many ticks ago.
    [[nodiscard]] Motion seen(const Motion& now, const Tape& tape) const;

    /// Keeps what was at this tick, for the next ones.
    void remember(const Motion& now);

 private:
    const World& world_;
    double delay_ticks_;
    std::vector<Motion> past_;  ///< one tick ago, two ticks ago, ...
};

/// Gusts of the Dryden model, sampled at the control ticks.
class Gusts {
 public:
    /// They blow already: their state is drawn with the numbers before the first tick.
    DOWNWASH_EXPORT Gusts(const World& world, double tick_s);

    /// Velocity of the air in a tick, steady wind included [m/s].
    [[nodiscard]] DOWNWASH_EXPORT Planar wind() const;

    /// Goes on by a tick.
    DOWNWASH_EXPORT void next(const Tape& tape);

 private:
    const World& world_;
    double x_decay_ = 0, x_noise_ = 0;
    double z_decay_ = 0, z_coupling_ = 0;
    std::array<double, 3> z_noise_{};  ///< lower triangle 11, 21, 22
    double x_ = 0;                     ///< Filters of unit variance.
    double z_first_ = 0, z_second_ = 0;
};

}  // namespace downwash::judge
