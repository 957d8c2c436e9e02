#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "downwash/base/export.hpp"

namespace downwash {

class EffectTable;
class FactorGrid;

/// A model of how a flat, wide surface changes the thrust of a rotor at distance z = zeta * R, at constant PWM. What
/// each is, where it comes from and where it holds says info() in effect_models.hpp.
enum class EffectModel {
    none,
    cheeseman_bennett,
    multirotor_images,
    multirotor_body,
    hayden,
    li,
    he,
    sanchez_cuevas,
    fairing_cfd,
    momentum_theory,
    table,
};

/// No model has more numbers than this.
inline constexpr std::size_t most_model_parameters = 2;

/// One side's model with its parameters.
struct DOWNWASH_EXPORT SurfaceEffect {
    SurfaceEffect() = default;
    /// The model with its parameters as its source gives them.
    // NOLINTNEXTLINE(google-explicit-constructor): a model's name is all that most users say
    SurfaceEffect(EffectModel which);

    EffectModel model = EffectModel::none;
    std::array<double, most_model_parameters> parameters{};  ///< in the order of info(model).parameters
    // Of the model `table` only:
    std::string file;                          ///< where the table comes from
    std::shared_ptr<const EffectTable> table;  ///< never empty while the model is `table`
    /// The second coordinate of a table over (z/R, d/R): a fixed value, or the distance to the nearest wall, measured
    /// in the rotor plane from the hub.
    std::optional<double> d_over_r;
};

/// How surfaces act on the rotors.
struct AeroSettings {
    bool enabled = true;                                   ///< false: K = 1 everywhere
    SurfaceEffect ground{EffectModel::cheeseman_bennett};  ///< surfaces below a rotor
    SurfaceEffect ceiling{EffectModel::sanchez_cuevas};    ///< surfaces above a rotor
    std::optional<std::string> map_file;                   ///< where `map` comes from
    std::shared_ptr<const FactorGrid> map;                 ///< K as given, in place of both models; empty: none
    double max_factor = 2.0;                               ///< cap of each side and of their superposition, >= 1
    double min_distance_radii = 0.3;                       ///< flyable area: least distance of the disc, in radii
    double grid_m = 0.05;                                  ///< cell size of the map; cells refine themselves
};

}  // namespace downwash
