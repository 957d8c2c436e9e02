#include "downwash/simulation/beyond_model.hpp"

#include <algorithm>

#include "downwash/scene/collision_checker.hpp"
#include "downwash/simulation/effect_slope.hpp"

namespace downwash::simulation {

bool is_beyond_model(const DirectEffect& effect, const Vector3& hub_m) {
    const AeroSettings& settings = effect.settings();
    if (!settings.enabled || settings.map || effect.ceiling().is_none()) {
        return false;
    }
    // Slopes are taken over a step to either side.
    constexpr double h = slope_step_m;
    constexpr double farthest_m = 1e6;
    const double flat_m = effect.rotor_radius_m() * effect.ceiling().flat_distance();
    if (flat_m > 0 &&
        !column_is_clear(effect.scene(), hub_m, effect.rotor_radius_m(), std::min(flat_m + h, farthest_m))) {
        return true;
    }
    const auto above = effect.factors({hub_m[0], hub_m[1], hub_m[2] + h});
    const auto below = effect.factors({hub_m[0], hub_m[1], hub_m[2] - h});
    return std::max(above.total, below.total) >= settings.max_factor &&
           std::max(above.ground, below.ground) < settings.max_factor &&
           above.ground + above.ceiling > below.ground + below.ceiling;
}

}  // namespace downwash::simulation
