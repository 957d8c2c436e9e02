#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "downwash/judge/ray_effect.hpp"
#include "downwash/judge/vehicle.hpp"
#include "downwash/simulation/flight_model.hpp"
#include "downwash/simulation/world.hpp"

// What surfaces do to the rotors in a world (docs/model.md 4 and 9), evaluated directly, among many parts by rays.
// Private: not installed.

namespace downwash::judge {

/// The effects of a scene, the same in all worlds. Safe to share between threads.
struct SurfaceEffects {
    std::shared_ptr<const FlightModel> all;  ///< its formulas only
    std::shared_ptr<const RayEffect> rays;   ///< in place of its direct evaluation, where there are many parts
    bool has_fountain = false;               ///< the ground model pushes the body (docs/model.md 4.3)
    double ground_tilt_loss = 0;             ///< docs/model.md 4.7
    double ceiling_tilt_loss = 0;
    double wall_force = 0, wall_moment_m = 0;  ///< docs/model.md 4.8; over the thrust; 0: walls do nothing
};

/// The effects in one world.
class Surroundings {
 public:
    /// @param effects nullptr: free air
    Surroundings(const SurfaceEffects* effects, const World& world) : effects_(effects), world_(world) {}

    /// The effect near the rotors of a vehicle, for the tick that begins there. Rays cost so much that a tick casts
    /// them at its beginning only, and what they say is not smooth. Empty without rays.
    using Tangents = std::optional<std::array<RayEffect::Tangent, max_rotors>>;
    /// @param position_m of the multirotor's centre of mass
    [[nodiscard]] Tangents tangents(const Vehicle& vehicle, Planar position_m, double pitch_rad) const {
        if (effects_ == nullptr || effects_->rays == nullptr) {
            return {};
        }
        Tangents all;
        all.emplace();
        for (int i = 0; i < vehicle.rotor_count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            (*all)[k] = effects_->rays->tangent(i, seen(position_m + from_body(vehicle.hub_m[k], pitch_rad)));
        }
        return all;
    }

    /// K at the hub of a rotor in the plane [m]. @param near where the hub is not far from
    [[nodiscard]] double thrust_ratio(int rotor, Planar hub_m, double pitch_rad, const Tangents& near = {}) const {
        if (effects_ == nullptr) {
            return 1;
        }
        const Planar at = seen(hub_m);
        const auto level = near             ? (*near)[static_cast<std::size_t>(rotor)].near(at)
                           : effects_->rays ? effects_->rays->at_rotor(rotor, at)
                                            : effects_->all->sided_factor(rotor, at.x, at.z);
        const double below = faded(level.all - level.above, effects_->ground_tilt_loss, pitch_rad);
        const double above = faded(level.above - 1, effects_->ceiling_tilt_loss, pitch_rad);
        return 1 + (1 + world_.ground_scale) * below + (1 + world_.ceiling_scale) * above;
    }

    /// K_body - 1 at the centre between the rotors: a push from the ground. 0 without a fountain.
    [[nodiscard]] double fountain(Planar center_m, double pitch_rad) const {
        if (effects_ == nullptr || !effects_->has_fountain) {
            return 0;
        }
        const Planar at = seen(center_m);
        const FlightModel& all = *effects_->all;
        const double push = all.factor_in_layer(all.body_layer(), at.x, at.z).all - 1;
        return (1 + world_.ground_scale) * faded(push, effects_->ground_tilt_loss, pitch_rad);
    }

    /// What walls do to the vehicle.
    struct WallLoad {
        double force_x_n = 0, moment_nm = 0;
    };
    /// @param center_m between the rotors   @param thrust_n of all rotors in free air
    [[nodiscard]] WallLoad walls(Planar center_m, double thrust_n) const {
        if (effects_ == nullptr || (effects_->wall_force == 0 && effects_->wall_moment_m == 0)) {
            return {};
        }
        const Planar at = seen(center_m);
        const FlightModel& all = *effects_->all;
        const double ahead = all.factor_in_layer(all.wall_layer(), at.x, at.z).all - 1;
        return {-ahead * effects_->wall_force * thrust_n, ahead * effects_->wall_moment_m * thrust_n};
    }

 private:
    /// A place as the surfaces see it.
    [[nodiscard]] Planar seen(Planar place_m) const { return place_m - Planar{world_.scene_x_m, world_.scene_z_m}; }

    /// K - 1 of a tilted rotor: half of the level one's where that is loss sin^2 of the tilt.
    [[nodiscard]] static double faded(double change, double loss, double tilt_rad) {
        const double half = loss * std::sin(tilt_rad) * std::sin(tilt_rad);
        return half == 0 ? change : change / (1 + half / std::abs(change));
    }

    const SurfaceEffects* effects_;
    const World& world_;
};

}  // namespace downwash::judge
