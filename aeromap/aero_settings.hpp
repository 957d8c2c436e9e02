#pragma once

namespace downwash {

/// A model of how a flat, wide surface changes the thrust of a rotor at distance z = zeta * R (constant PWM).
/// Further models of the thesis and the field will join.
enum class EffectModel {
    none,               ///< K = 1
    cheeseman_bennett,  ///< ground, K = 1 / (1 - (R / 4z)^2); Cheeseman and Bennett 1955, thesis (2.9)
    sanchez_cuevas,     ///< ceiling, K = 1 / (1 - (1 / k1) (R / (z + k2))^2); thesis (2.18)
};

/// One side's model with its parameters.
struct SurfaceEffect {
    EffectModel model = EffectModel::none;
    double k1 = 6.924;               ///< sanchez_cuevas, > 0
    double k2_over_radius = 0.3168;  ///< sanchez_cuevas, >= 0; the thesis' 0.03782 m over its rotor radius 0.1194 m
};

/// How surfaces act on the rotors.
struct AeroSettings {
    bool enabled = true;                                   ///< false: K = 1 everywhere
    SurfaceEffect ground{EffectModel::cheeseman_bennett};  ///< surfaces below a rotor
    SurfaceEffect ceiling{EffectModel::sanchez_cuevas};    ///< surfaces above a rotor
    double max_factor = 2.0;                               ///< cap of each side and of their superposition, >= 1
    double min_distance_radii = 0.3;                       ///< flyable area: least distance of the disc, in radii
    double grid_m = 0.05;                                  ///< cell size of the map; cells refine themselves
};

}  // namespace downwash
