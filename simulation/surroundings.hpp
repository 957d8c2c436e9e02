#pragma once

#include "downwash/dynamics/flight_step.hpp"
#include "downwash/effects/sided_factor.hpp"
#include "downwash/simulation/world_numbers.hpp"

// What surrounds the rotors of a vehicle, for the plant. One template over the lane type.

namespace downwash::simulation {

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
