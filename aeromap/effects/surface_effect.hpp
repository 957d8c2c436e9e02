#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "downwash/base/export.hpp"

namespace downwash {

class EffectTable;

/// A model of how a flat, wide surface changes the thrust of a rotor at distance z = zeta * R, at constant command.
/// info() in effect_models.hpp says what each model is, where it comes from and where it holds.
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

/// No model has more parameters than this.
inline constexpr std::size_t max_model_parameters = 2;

/// One side's model with its parameters.
struct DOWNWASH_EXPORT SurfaceEffect {
    SurfaceEffect() = default;
    /// The model with its parameters as its source gives them.
    // NOLINTNEXTLINE(google-explicit-constructor): a model's name is all that most users say
    SurfaceEffect(EffectModel which);

    EffectModel model = EffectModel::none;
    std::array<double, max_model_parameters> parameters{};  ///< values in the order of info(model).parameters
    // Of the model `table` only:
    std::string file;                          ///< where the table comes from
    std::shared_ptr<const EffectTable> table;  ///< K of points; never empty while the model is `table`
    /// The file holds K of whole discs over a pipe of this radius in rotor radii, and `table` is points_of_pipe() of
    /// it. Empty: over a wide flat surface.
    std::optional<double> pipe_radii;
    /// The second coordinate of a table over (z/R, d/R): a fixed value, or the distance to the nearest wall, measured
    /// in the rotor plane from the hub.
    std::optional<double> d_over_r;
};

}  // namespace downwash
