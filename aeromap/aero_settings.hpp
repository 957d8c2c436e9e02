#pragma once

#include <memory>
#include <optional>
#include <string>

#include "downwash/effects/sided_factor.hpp"
#include "downwash/effects/surface_effect.hpp"
#include "downwash/effects/wall_effect.hpp"

namespace downwash {

class FactorGrid;

/// How surfaces act on the rotors.
struct AeroSettings {
    bool enabled = true;                                   ///< false: K = 1 everywhere
    SurfaceEffect ground{EffectModel::cheeseman_bennett};  ///< surfaces below a rotor
    SurfaceEffect ceiling{EffectModel::sanchez_cuevas};    ///< surfaces above a rotor
    TiltLoss tilt_loss{default_ground_tilt_loss, 0};       ///< not of a given map, which is taken as it is
    WallEffect wall;                                       ///< surfaces beside a vehicle; none by default
    std::optional<std::string> map_file;                   ///< the file of `map`
    std::shared_ptr<const FactorGrid> map;                 ///< K given as a grid, in place of both models; empty: none
    double max_factor = 2.0;                               ///< cap of each side and of their superposition, >= 1
    double min_distance_radii = 0.3;                       ///< flyable area: minimum distance of the disc, in radii
    double grid_m = 0.05;                                  ///< cell size of the map, which refines its cells
};

}  // namespace downwash
