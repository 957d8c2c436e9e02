#pragma once

// Private to simulation/.

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "downwash/simulation/space_hover_trim.hpp"

// One tick of a vehicle in space around its hover, for what knows nothing of its joints.

namespace downwash::simulation {

/// A small change of a hover at the beginning of a tick.
struct HoverChange {
    enum class Of : std::uint8_t { nothing, state, past_motion, loop };
    Of of = Of::nothing;
    int index = 0;  ///< a number of the state, a number of the motion, or one of space_loops at which `by` is added
    double by = 0;
    int age = 0;  ///< of the past motion, in ticks, from 1
};

/// What a tick comes to.
struct HoverTick {
    std::vector<double> next;   ///< the numbers of the state
    std::vector<double> asked;  ///< by the law at each of space_loops, before anything is added
    double saturation = 0;      ///< greatest demand over its limit
};

/// How surfaces turn and lift a hover; see SpaceHoverStability.
struct HoverSlopes {
    double force_n_m = 0, force_gain_n_m = 0, roll_nm_rad = 0, pitch_nm_rad = 0;
};

/// A vehicle in space in closed loop around its hover. K is replaced by its tangent at each rotor.
class SpaceHoverLoop {
 public:
    SpaceHoverLoop() = default;
    virtual ~SpaceHoverLoop() = default;
    SpaceHoverLoop(const SpaceHoverLoop&) = delete;
    SpaceHoverLoop& operator=(const SpaceHoverLoop&) = delete;

    /// Puts the vehicle there, level and at rest.
    virtual void stand(const SpacePoint& place) = 0;
    /// Finds the equilibrium where it stands; what follows is about that.
    virtual SpaceHoverTrim settle() = 0;
    /// The hubs of the vehicle as it is, in the world.
    [[nodiscard]] virtual std::vector<Vector3> hubs_m() const = 0;
    /// Whether later ticks depend on a number of the state: a flag for each.
    [[nodiscard]] virtual std::vector<bool> feeds_back() const = 0;
    /// The first so many numbers of the state are its motion: coordinates and speeds.
    [[nodiscard]] virtual int motion_numbers() const = 0;
    /// Age of what the controller sees, in ticks.
    [[nodiscard]] virtual double delay_ticks() const = 0;
    [[nodiscard]] virtual double tick_s() const = 0;
    /// One tick from the equilibrium, but for a change. @param[out] result keeps its room from tick to tick
    virtual void tick(const HoverChange& change, HoverTick& result) = 0;
    [[nodiscard]] virtual HoverSlopes slopes() = 0;
};

/// @param surfaces,robot outlive the loop
/// @throws InputError if the robot has more joints than this library was built for
[[nodiscard]] std::unique_ptr<SpaceHoverLoop> make_space_hover_loop(const SpaceRobot& robot, const SpaceAero& aero,
                                                                    SpaceEffect& surfaces);

/// Newton's method with differences: looks for an x with f(x) = 0, as many numbers as x has.
/// @param[in,out] x where to begin; the best that was found   @return whether every number of f is below 1e-9 there
bool find_root(const std::function<void(const std::vector<double>& x, std::vector<double>& f)>& f,
               std::vector<double>& x);

}  // namespace downwash::simulation
