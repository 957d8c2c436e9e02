#pragma once

#include <concepts>

#include "downwash/dynamics/surroundings.hpp"
#include "downwash/simulation/effect_field.hpp"
#include "downwash/simulation/world_numbers.hpp"

// What surrounds a vehicle in flight: an EffectField as its rotors feel it. One template over the lane type.

namespace downwash::simulation {

/// The surroundings of a vehicle in the nominal world: surface effects on rotors that tilt. A control law reads the
/// same.
template <class T, EffectField<T> Field>
class NominalSurroundings : public dynamics::CalmSurroundings<T> {
 public:
    NominalSurroundings(Field& field, const TiltLoss& tilt_loss) : field_(field), tilt_loss_(tilt_loss) {}

    T thrust_ratio(int rotor, const dynamics::PlanePoint<T>& hub_m, const T& sin_pitch) const {
        return of_tilted(field_.at_rotor(rotor, hub_m.x, hub_m.z), sin_pitch);
    }
    [[nodiscard]] int same_as(int rotor) const { return field_.same_as(rotor); }
    T body_ratio(const dynamics::PlanePoint<T>& center_m, const T& sin_pitch) const {
        return of_tilted(field_.at_body(center_m.x, center_m.z), sin_pitch);
    }
    /// Walls are near whatever the tilt.
    T wall_nearness(const dynamics::PlanePoint<T>& center_m) const {
        return field_.wall_nearness(center_m.x, center_m.z);
    }

 private:
    T of_tilted(const SidedFactor<T>& level, const T& sin_pitch) const {
        if constexpr (std::same_as<Field, NoEffect>) {
            return T(1);  // the compiler does not see that tilt changes nothing then
        }
        return tilt_loss_.is_any() ? tilted(level, tilt_loss_, sin_pitch).all : level.all;
    }

    Field& field_;
    const TiltLoss& tilt_loss_;
};

/// The same of a vehicle with drag: the air stands still. The arm is in no slipstream.
template <class T, EffectField<T> Field>
class StillAir : public NominalSurroundings<T, Field> {
 public:
    using NominalSurroundings<T, Field>::NominalSurroundings;
    static constexpr bool has_wind = true;
};

/// The surroundings of a vehicle in a world: surface effects, rotors, wind, slipstreams.
/// @tparam may_have_wash false: there are no slipstreams, and no code for them
template <class T, EffectField<T> Field, bool may_have_wash = true>
class WorldSurroundings : public dynamics::CalmSurroundings<T> {
 public:
    WorldSurroundings(const WorldNumbers<T>& world, const dynamics::PlanePoint<T>& wind, Field& field,
                      const TiltLoss& tilt_loss, const Slipstreams& slipstreams = no_slipstreams)
        : world_(world), wind_(wind), field_(field), tilt_loss_(tilt_loss), slipstreams_(slipstreams) {}

    T thrust_ratio(int rotor, const dynamics::PlanePoint<T>& hub_m, const T& sin_pitch) const {
        return in_world(field_.at_rotor(rotor, hub_m.x - world_.scene_x_m, hub_m.z - world_.scene_z_m), sin_pitch);
    }
    [[nodiscard]] int same_as(int rotor) const { return field_.same_as(rotor); }
    T body_ratio(const dynamics::PlanePoint<T>& center_m, const T& sin_pitch) const {
        return in_world(field_.at_body(center_m.x - world_.scene_x_m, center_m.z - world_.scene_z_m), sin_pitch);
    }
    /// Worlds move walls, and change nothing else of them.
    T wall_nearness(const dynamics::PlanePoint<T>& center_m) const {
        return field_.wall_nearness(center_m.x - world_.scene_x_m, center_m.z - world_.scene_z_m);
    }
    T thrust_scale(int rotor) const { return world_.rotor_thrust_scale[rotor]; }
    static constexpr bool has_wind = true;
    dynamics::PlanePoint<T> wind() const { return wind_; }
    static constexpr bool has_wash = may_have_wash;
    [[nodiscard]] const Slipstreams& slipstreams() const { return slipstreams_; }
    T wash_scale() const { return world_.arm_wash_scale; }

 private:
    T in_world(const SidedFactor<T>& level, const T& sin_pitch) const {
        const SidedFactor<T> k = tilted(level, tilt_loss_, sin_pitch);
        return k.all +
               (world_.ground_scale * (k.all - T(1)) + (world_.ceiling_scale - world_.ground_scale) * (k.above - T(1)));
    }

    const WorldNumbers<T>& world_;
    dynamics::PlanePoint<T> wind_;
    Field& field_;
    const TiltLoss& tilt_loss_;
    const Slipstreams& slipstreams_;
};

}  // namespace downwash::simulation
