#pragma once

#include <cmath>
#include <memory>

#include "downwash/judge/vehicle.hpp"
#include "downwash/simulation/flight_model.hpp"
#include "downwash/simulation/world.hpp"

// What surfaces do to the rotors in a world (docs/model.md 4 and 9), evaluated directly. Private: not installed.

namespace downwash::judge {

/// The effects of a scene, the same in all worlds. Safe to share between threads.
struct SurfaceEffects {
    std::shared_ptr<const FlightModel> all;  ///< its formulas only
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

    /// K at the hub of a rotor in the plane [m].
    [[nodiscard]] double thrust_ratio(int rotor, Planar hub_m, double pitch_rad) const {
        if (effects_ == nullptr) {
            return 1;
        }
        const Planar seen = hub_m - Planar{world_.scene_x_m, world_.scene_z_m};
        const auto level = effects_->all->sided_factor(rotor, seen.x, seen.z);
        const double below = faded(level.all - level.above, effects_->ground_tilt_loss, pitch_rad);
        const double above = faded(level.above - 1, effects_->ceiling_tilt_loss, pitch_rad);
        return 1 + (1 + world_.ground_scale) * below + (1 + world_.ceiling_scale) * above;
    }

    /// K_body - 1 at the centre between the rotors: a push from the ground. 0 without a fountain.
    [[nodiscard]] double fountain(Planar center_m, double pitch_rad) const {
        if (effects_ == nullptr || !effects_->has_fountain) {
            return 0;
        }
        const Planar seen = center_m - Planar{world_.scene_x_m, world_.scene_z_m};
        const FlightModel& all = *effects_->all;
        const double push = all.factor_in_layer(all.body_layer(), seen.x, seen.z).all - 1;
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
        const Planar seen = center_m - Planar{world_.scene_x_m, world_.scene_z_m};
        const FlightModel& all = *effects_->all;
        const double ahead = all.factor_in_layer(all.wall_layer(), seen.x, seen.z).all - 1;
        return {-ahead * effects_->wall_force * thrust_n, ahead * effects_->wall_moment_m * thrust_n};
    }

 private:
    /// K - 1 of a tilted rotor: half of the level one's where that is loss sin^2 of the tilt.
    [[nodiscard]] static double faded(double change, double loss, double tilt_rad) {
        const double half = loss * std::sin(tilt_rad) * std::sin(tilt_rad);
        return half == 0 ? change : change / (1 + half / std::abs(change));
    }

    const SurfaceEffects* effects_;
    const World& world_;
};

}  // namespace downwash::judge
