#pragma once

#include <concepts>

#include "downwash/dynamics/space_surroundings.hpp"
#include "downwash/effects/sided_factor.hpp"
#include "downwash/simulation/space_world_numbers.hpp"

// What surrounds a vehicle in flight in space: the effects of surfaces as its rotors feel them, and the air. One
// template over the lane type; surroundings.hpp has that of the plane.

namespace downwash::simulation {

/// The effects of surfaces in their nominal places on level rotors: a field over the world.
/// - `at_rotor(rotor, hub_m)`: K by side of a rotor with its hub there
/// - `at_body(center_m)`: K by side of the body with the centre between its rotors there, where there is a fountain
/// - `wall_nearness(center_m)`: level vector towards the nearest wall, of length 1 where a rotor touches it
template <class F, class T>
concept SpaceField = requires(F& field, int rotor, const dynamics::LaneVector<T>& at_m) {
    { field.at_rotor(rotor, at_m) } -> std::same_as<SidedFactor<T>>;
    { field.at_body(at_m) } -> std::same_as<SidedFactor<T>>;
    { field.wall_nearness(at_m) } -> std::same_as<dynamics::LaneVector<T>>;
};

/// A SpaceField that knows what the attitude of the vehicle changes, as among the images of several rotors:
/// at_rotor() and at_body() of such a field are of a level vehicle that heads along x.
template <class F, class T>
concept TurningSpaceField = SpaceField<F, T> &&
    requires(F& field, int rotor, const dynamics::LaneVector<T>& at_m, const dynamics::LaneRotation<T>& attitude) {
    { field.at_turned_rotor(rotor, at_m, attitude) } -> std::same_as<SidedFactor<T>>;
    { field.at_turned_body(at_m, attitude) } -> std::same_as<SidedFactor<T>>;
};

/// No surface effect anywhere.
struct NoSpaceEffect {
    template <class T>
    SidedFactor<T> at_rotor(int /*rotor*/, const dynamics::LaneVector<T>& /*hub_m*/) const {
        return {T(1), T(1)};
    }
    template <class T>
    SidedFactor<T> at_body(const dynamics::LaneVector<T>& /*center_m*/) const {
        return {T(1), T(1)};
    }
    template <class T>
    dynamics::LaneVector<T> wall_nearness(const dynamics::LaneVector<T>& /*center_m*/) const {
        return {T(0), T(0), T(0)};
    }
};

/// K of a tilted rotor by side. @param axis of its thrust, of length 1, in the world
template <class T>
SidedFactor<T> tilted_in_space(const SidedFactor<T>& level, const TiltLoss& loss, const dynamics::LaneVector<T>& axis) {
    // Few rotors have a surface on a side whose effect fades.
    const T of_ground = loss.ground > 0 ? lane::abs(level.all - level.above) : T(0);
    const T of_ceiling = loss.ceiling > 0 ? lane::abs(level.above - T(1)) : T(0);
    const auto fades = lane::max(of_ground, of_ceiling) > T(0);
    if (lane::bits_of(fades) == 0) {
        return level;
    }
    const SidedFactor<T> k = tilted(level, loss, dynamics::sine_of_tilt(axis));
    return {lane::select(fades, k.all, level.all), lane::select(fades, k.above, level.above)};
}

/// The surroundings of a vehicle in the nominal world: surface effects on rotors that tilt, still air, slipstreams. A
/// control law reads the same.
template <class T, SpaceField<T> Field>
class NominalSpace : public dynamics::CalmSpace {
 public:
    /// @pre all of them outlive this
    NominalSpace(Field& field, const TiltLoss& tilt_loss, const SpaceSlipstreams& slipstreams)
        : field_(field), tilt_loss_(tilt_loss), slipstreams_(slipstreams) {}

    T thrust_ratio(int rotor, const dynamics::LaneVector<T>& hub_m, const dynamics::LaneVector<T>& axis) const {
        return tilted_in_space(field_.at_rotor(rotor, hub_m), tilt_loss_, axis).all;
    }
    T body_ratio(const dynamics::LaneVector<T>& center_m, const dynamics::LaneVector<T>& axis) const {
        return tilted_in_space(field_.at_body(center_m), tilt_loss_, axis).all;
    }
    /// See dynamics::TurningSurroundings.
    class AtAttitude {
     public:
        AtAttitude(const NominalSpace& around, const dynamics::LaneRotation<T>& attitude)
            : around_(around), attitude_(attitude) {}
        T thrust_ratio(int rotor, const dynamics::LaneVector<T>& hub_m, const dynamics::LaneVector<T>& axis) const {
            return tilted_in_space(around_.field_.at_turned_rotor(rotor, hub_m, attitude_), around_.tilt_loss_, axis)
                .all;
        }
        T body_ratio(const dynamics::LaneVector<T>& center_m, const dynamics::LaneVector<T>& axis) const {
            return tilted_in_space(around_.field_.at_turned_body(center_m, attitude_), around_.tilt_loss_, axis).all;
        }

     private:
        const NominalSpace& around_;
        dynamics::LaneRotation<T> attitude_;
    };
    [[nodiscard]] AtAttitude at_attitude(const dynamics::LaneRotation<T>& attitude) const requires
        TurningSpaceField<Field, T> {
        return {*this, attitude};
    }
    /// Walls are near whatever the tilt.
    dynamics::LaneVector<T> wall_nearness(const dynamics::LaneVector<T>& center_m) const {
        return field_.wall_nearness(center_m);
    }
    static constexpr bool has_wind = true;
    static constexpr bool has_wash = true;
    [[nodiscard]] const SpaceSlipstreams& slipstreams() const { return slipstreams_; }

 private:
    Field& field_;
    const TiltLoss& tilt_loss_;
    const SpaceSlipstreams& slipstreams_;
};

/// Where a point of the world is among surfaces in their nominal places.
template <class T>
dynamics::LaneVector<T> nominal_place(const SpaceWorldDifferences<T>& world, const dynamics::LaneVector<T>& at_m) {
    const dynamics::LaneVector<T> from = at_m - world.scene_m;
    return {world.scene_cosine * from.x + world.scene_sine * from.y,
            world.scene_cosine * from.y - world.scene_sine * from.x, from.z};
}

/// The surroundings of a vehicle in a world: surface effects, rotors, wind, slipstreams. In the nominal world they are
/// those of NominalSpace to the last bit.
template <class T, SpaceField<T> Field>
class WorldSpace : public dynamics::CalmSpace {
 public:
    /// @param wind in this tick [m/s]   @pre all but it outlive this
    WorldSpace(const SpaceWorldDifferences<T>& world, const dynamics::LaneVector<T>& wind, Field& field,
               const TiltLoss& tilt_loss, const SpaceSlipstreams& slipstreams)
        : world_(world), wind_(wind), field_(field), tilt_loss_(tilt_loss), slipstreams_(slipstreams) {}

    T thrust_ratio(int rotor, const dynamics::LaneVector<T>& hub_m, const dynamics::LaneVector<T>& axis) const {
        return in_world(field_.at_rotor(rotor, nominal_place(world_, hub_m)), axis);
    }
    T thrust_scale(int rotor) const { return world_.rotor_thrust_scale[rotor]; }
    T body_ratio(const dynamics::LaneVector<T>& center_m, const dynamics::LaneVector<T>& axis) const {
        return in_world(field_.at_body(nominal_place(world_, center_m)), axis);
    }
    /// See dynamics::TurningSurroundings.
    class AtAttitude {
     public:
        AtAttitude(const WorldSpace& around, const dynamics::LaneRotation<T>& attitude)
            : around_(around),
              among_obstacles_{turned(attitude.first), turned(attitude.second), turned(attitude.third)} {}
        T thrust_ratio(int rotor, const dynamics::LaneVector<T>& hub_m, const dynamics::LaneVector<T>& axis) const {
            return around_.in_world(
                around_.field_.at_turned_rotor(rotor, nominal_place(around_.world_, hub_m), among_obstacles_), axis);
        }
        T body_ratio(const dynamics::LaneVector<T>& center_m, const dynamics::LaneVector<T>& axis) const {
            return around_.in_world(
                around_.field_.at_turned_body(nominal_place(around_.world_, center_m), among_obstacles_), axis);
        }

     private:
        [[nodiscard]] dynamics::LaneVector<T> turned(const dynamics::LaneVector<T>& v) const {
            const SpaceWorldDifferences<T>& world = around_.world_;
            return {world.scene_cosine * v.x + world.scene_sine * v.y,
                    world.scene_cosine * v.y - world.scene_sine * v.x, v.z};
        }

        const WorldSpace& around_;
        dynamics::LaneRotation<T> among_obstacles_;  ///< as obstacles in their nominal places see the vehicle
    };
    [[nodiscard]] AtAttitude at_attitude(const dynamics::LaneRotation<T>& attitude) const requires
        TurningSpaceField<Field, T> {
        return {*this, attitude};
    }
    /// Worlds move and turn walls, and change nothing else of them.
    dynamics::LaneVector<T> wall_nearness(const dynamics::LaneVector<T>& center_m) const {
        const dynamics::LaneVector<T> towards = field_.wall_nearness(nominal_place(world_, center_m));
        return {world_.scene_cosine * towards.x - world_.scene_sine * towards.y,
                world_.scene_sine * towards.x + world_.scene_cosine * towards.y, towards.z};
    }
    static constexpr bool has_wind = true;
    dynamics::LaneVector<T> wind() const { return wind_; }
    static constexpr bool has_wash = true;
    [[nodiscard]] const SpaceSlipstreams& slipstreams() const { return slipstreams_; }
    T wash_scale() const { return world_.wash_scale; }

 private:
    T in_world(const SidedFactor<T>& level, const dynamics::LaneVector<T>& axis) const {
        const SidedFactor<T> k = tilted_in_space(level, tilt_loss_, axis);
        return k.all +
               (world_.ground_scale * (k.all - T(1)) + (world_.ceiling_scale - world_.ground_scale) * (k.above - T(1)));
    }

    const SpaceWorldDifferences<T>& world_;
    dynamics::LaneVector<T> wind_;
    Field& field_;
    const TiltLoss& tilt_loss_;
    const SpaceSlipstreams& slipstreams_;
};

}  // namespace downwash::simulation
