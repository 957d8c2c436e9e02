#pragma once

#include <memory>

#include "downwash/judge/vehicle.hpp"
#include "downwash/simulation/flight_model.hpp"
#include "downwash/simulation/world.hpp"

// What surfaces do to the rotors in a world (docs/model.md 4 and 9), evaluated directly. Private: not installed.

namespace downwash::judge {

/// The effects of a scene, the same in all worlds. Safe to share between threads.
struct SurfaceEffects {
    std::shared_ptr<const FlightModel> all;       ///< its formulas only
    std::shared_ptr<const FlightModel> ceilings;  ///< those of the surfaces above alone; may be nullptr
    bool has_fountain = false;                    ///< the ground model pushes the body (docs/model.md 4.3)
};

/// The effects in one world.
class Surroundings {
 public:
    /// @param effects nullptr: free air
    Surroundings(const SurfaceEffects* effects, const World& world) : effects_(effects), world_(world) {}

    /// K at the hub of a rotor in the plane [m].
    [[nodiscard]] double thrust_ratio(int rotor, Planar hub_m) const {
        if (effects_ == nullptr) {
            return 1;
        }
        const Planar seen = hub_m - Planar{world_.scene_x_m, world_.scene_z_m};
        const double all = effects_->all->direct_factor(rotor, seen.x, seen.z);
        double above = 1;
        if (world_.ceiling_scale != world_.ground_scale && effects_->ceilings != nullptr && all != 1) {
            above = effects_->ceilings->direct_factor(rotor, seen.x, seen.z);
        }
        return all + world_.ground_scale * (all - above) + world_.ceiling_scale * (above - 1);
    }

    /// K_body - 1 at the centre between the rotors: a push from the ground. 0 without a fountain.
    /// @param body its number, behind those of the rotors
    [[nodiscard]] double fountain(int body, Planar center_m) const {
        if (effects_ == nullptr || !effects_->has_fountain) {
            return 0;
        }
        const Planar seen = center_m - Planar{world_.scene_x_m, world_.scene_z_m};
        return (1 + world_.ground_scale) * (effects_->all->direct_factor(body, seen.x, seen.z) - 1);
    }

 private:
    const SurfaceEffects* effects_;
    const World& world_;
};

}  // namespace downwash::judge
