#pragma once

#include "downwash/base/numbers.hpp"
#include "downwash/dynamics/flight_step.hpp"
#include "downwash/effects/sided_factor.hpp"

// What a world has otherwise than the controller believes, as numbers for the tick: docs/model.md 9.

namespace downwash::simulation {

/// Control ticks by which the state that the controller sees may be late.
inline constexpr int max_delay_ticks = 3;

/// Standard normal numbers that a world draws for every tick.
inline constexpr int noise_count = 8;

/// Where and how fast the vehicle was.
template <class T>
struct PastMotion {
    T q[4], u[4];
};

/// What a world remembers of a flight besides the vehicle: nothing but T.
template <class T>
struct WorldMemory {
    PastMotion<T> past[max_delay_ticks];  ///< one tick ago, two ticks ago, ...
    T gust[3];  ///< filters of the Dryden model: along x; along z, first and second order; of unit variance
};

/// A world in numbers; with a pack every lane flies in a world of its own. Nothing but T: see base/numbers.hpp.
template <class T>
struct WorldNumbers {
    PlantNumbers<T> plant;                     ///< what really flies, about its true centre of mass
    T center_of_mass_x_m, center_of_mass_z_m;  ///< The multirotor's, in the body frame of the robot file.
    T rotor_thrust_scale[max_rotors];          ///< thrust coefficient over the nominal one
    T ground_scale, ceiling_scale;             ///< relative changes of K - 1
    T scene_x_m, scene_z_m;                    ///< Displacement of all surfaces.
    T delay_ticks;                             ///< age of what the controller sees, 0 to max_delay_ticks
    T position_bias_m[2], pitch_bias_rad;      ///< Constant errors of what it sees.
    T position_noise_m, velocity_noise_m_s, gyro_noise_rad_s;  ///< standard deviations, of every tick
    T wind_m_s[2];                                             ///< steady, x and z
    T gust_m_s;                                     ///< standard deviation of the gusts, the same for x and z
    T gust_x_decay, gust_z_decay, gust_z_coupling;  ///< Decay of the filters from tick to tick.
    T gust_x_noise, gust_z_noise[3];                ///< Cholesky factor of what each tick adds: x; z as 11, 21, 22
};

/// What the controller sees: late, biased and noisy. It knows the arm's angle and the rotors' speeds exactly.
/// @param noise standard normal numbers of this tick
template <class T>
dynamics::PlantState<T> seen_state(const WorldNumbers<T>& world, const dynamics::PlantState<T>& now,
                                   const WorldMemory<T>& memory, const T noise[noise_count]) {
    dynamics::PlantState<T> seen = now;
    // Linear between two ticks: a weight of 1 less the distance in ticks from the wanted age.
    const auto weight = [&](int age) { return lane::max(T(0), T(1) - lane::abs(world.delay_ticks - T(age))); };
    const T newest = weight(0);
    for (int i = 0; i < 4; ++i) {
        seen.q[i] = newest * now.q[i];
        seen.u[i] = newest * now.u[i];
    }
    for (int age = 1; age <= max_delay_ticks; ++age) {
        const T w = weight(age);
        const PastMotion<T>& past = memory.past[age - 1];
        for (int i = 0; i < 4; ++i) {
            seen.q[i] = seen.q[i] + w * past.q[i];
            seen.u[i] = seen.u[i] + w * past.u[i];
        }
    }
    for (int axis = 0; axis < 2; ++axis) {
        seen.q[axis] = seen.q[axis] + (world.position_bias_m[axis] + world.position_noise_m * noise[axis]);
        seen.u[axis] = seen.u[axis] + world.velocity_noise_m_s * noise[2 + axis];
    }
    seen.q[2] = seen.q[2] + world.pitch_bias_rad;
    seen.u[2] = seen.u[2] + world.gyro_noise_rad_s * noise[4];
    return seen;
}

/// Steady wind and gusts of a tick [m/s] (Dryden; MIL-F-8785C 3.7.2).
template <class T>
dynamics::PlanePoint<T> wind_in(const WorldNumbers<T>& world, const WorldMemory<T>& memory) {
    constexpr double root3 = 1.7320508075688772;
    const T along_z = T(root3) * memory.gust[1] + T(1 - root3) * memory.gust[2];
    return {world.wind_m_s[0] + world.gust_m_s * memory.gust[0], world.wind_m_s[1] + world.gust_m_s * along_z};
}

/// The memory one tick later.
template <class T>
WorldMemory<T> later(const WorldNumbers<T>& world, const dynamics::PlantState<T>& now, const WorldMemory<T>& memory,
                     const T noise[noise_count]) {
    WorldMemory<T> next;
    for (int age = max_delay_ticks - 1; age > 0; --age) {
        next.past[age] = memory.past[age - 1];
    }
    for (int i = 0; i < 4; ++i) {
        next.past[0].q[i] = now.q[i];
        next.past[0].u[i] = now.u[i];
    }
    next.gust[0] = world.gust_x_decay * memory.gust[0] + world.gust_x_noise * noise[5];
    next.gust[1] = world.gust_z_decay * memory.gust[1] + world.gust_z_noise[0] * noise[6];
    next.gust[2] = world.gust_z_decay * memory.gust[2] + world.gust_z_coupling * memory.gust[1] +
                   (world.gust_z_noise[1] * noise[6] + world.gust_z_noise[2] * noise[7]);
    return next;
}

/// The surface effect on a vehicle that tilts, for the plant.
/// @tparam Effect see WorldSurroundings
template <class T, class Effect>
class TiltedEffect {
 public:
    TiltedEffect(Effect& effect, const TiltLoss& tilt_loss) : effect_(effect), tilt_loss_(tilt_loss) {}

    /// K at the hub of a rotor, or of the body, in the plane.
    T operator()(int rotor, T x_m, T z_m, T sin_pitch) const {
        return tilt_loss_.is_any() ? tilted(effect_.sided(rotor, x_m, z_m), tilt_loss_, sin_pitch).all
                                   : effect_(rotor, x_m, z_m);
    }
    [[nodiscard]] int same_as(int rotor) const { return dynamics::rotor_with_factor_of(effect_, rotor); }
    /// How near walls are, whatever the tilt.
    T wall_nearness(int walls, T x_m, T z_m) const { return effect_(walls, x_m, z_m) - T(1); }

 private:
    Effect& effect_;
    const TiltLoss& tilt_loss_;
};

/// The surroundings of a vehicle in a world, for the plant: surface effects, rotors, wind.
/// @tparam Effect has K by side where the controller believes the surfaces, `sided(rotor, x_m, z_m)`; one that is a
/// mere factor (rotor, x_m, z_m) -> K counts as that of the ground, whatever the tilt
template <class T, class Effect>
class WorldSurroundings {
 public:
    WorldSurroundings(const WorldNumbers<T>& world, const dynamics::PlanePoint<T>& wind, Effect& effect,
                      const TiltLoss& tilt_loss)
        : world_(world), wind_(wind), effect_(effect), tilt_loss_(tilt_loss) {}

    /// K at the hub of a rotor, or of the body, in the plane.
    T operator()(int rotor, T x_m, T z_m, T sin_pitch) const {
        const SidedFactor<T> k = factor(rotor, x_m - world_.scene_x_m, z_m - world_.scene_z_m, sin_pitch);
        return k.all +
               (world_.ground_scale * (k.all - T(1)) + (world_.ceiling_scale - world_.ground_scale) * (k.above - T(1)));
    }
    [[nodiscard]] int same_as(int rotor) const { return dynamics::rotor_with_factor_of(effect_, rotor); }
    /// How near walls are. Worlds move them, and change nothing else of them.
    T wall_nearness(int walls, T x_m, T z_m) const {
        return effect_(walls, x_m - world_.scene_x_m, z_m - world_.scene_z_m) - T(1);
    }
    [[nodiscard]] dynamics::PlanePoint<T> wind() const { return wind_; }
    [[nodiscard]] T thrust_scale(int rotor) const { return world_.rotor_thrust_scale[rotor]; }

 private:
    [[nodiscard]] SidedFactor<T> factor(int rotor, T x_m, T z_m, T sin_pitch) const {
        if constexpr (requires { effect_.sided(rotor, x_m, z_m); }) {
            return tilted(effect_.sided(rotor, x_m, z_m), tilt_loss_, sin_pitch);
        } else {
            return {effect_(rotor, x_m, z_m), T(1)};
        }
    }

    const WorldNumbers<T>& world_;
    dynamics::PlanePoint<T> wind_;
    Effect& effect_;
    const TiltLoss& tilt_loss_;
};

}  // namespace downwash::simulation
