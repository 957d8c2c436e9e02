#pragma once

#include <span>
#include <string>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/effects/rotor_layout.hpp"
#include "downwash/effects/surface_effect.hpp"

namespace downwash {

/// A number of a model that may be changed or fitted.
struct ModelParameter {
    std::string_view name;  ///< as in a problem file
    double source_value;    ///< as the model's source gives it
    double low, high;       ///< allowed range
    bool is_open;           ///< `low` itself is not allowed
    std::string_view description;

    [[nodiscard]] constexpr bool allows(double value) const {
        return value >= low && value <= high && !(is_open && value == low);
    }
    /// "above 0 and at most 100"
    [[nodiscard]] DOWNWASH_EXPORT std::string range_text() const;
};

/// The description of a model.
struct EffectModelInfo {
    EffectModel model;
    std::string_view name;      ///< as in a problem file, for example "cheeseman-bennett"
    std::string_view surface;   ///< what it was made for: "ground", "ceiling" or "any"
    std::string_view source;    ///< where the formula comes from
    std::string_view formula;   ///< formula in plain text; K over zeta = z/R
    std::string_view validity;  ///< range of z/R in which the model was shown to hold
    double valid_from;          ///< where that range begins; 0 if unknown
    double valid_to;            ///< where that range ends; infinite if unknown
    std::span<const ModelParameter> parameters = {};
};

/// All models, in the order of EffectModel.
[[nodiscard]] DOWNWASH_EXPORT std::span<const EffectModelInfo> effect_models();

/// The description of one of them.
[[nodiscard]] DOWNWASH_EXPORT const EffectModelInfo& info(EffectModel model);

/// Whether a model considers the vehicle's other rotors.
[[nodiscard]] constexpr bool is_multirotor(EffectModel model) {
    return model == EffectModel::multirotor_images || model == EffectModel::multirotor_body;
}

/// The model of that name; nullptr if there is none.
[[nodiscard]] DOWNWASH_EXPORT const EffectModelInfo* find_effect_model(std::string_view name);

/// The part of a rotor's induced velocity that the image of another one, `distance_radii` beside it, cancels over a
/// wide flat surface: (1/2) zeta / (d^2 + 4 zeta^2)^1.5 (thesis (2.14)); 1 / (16 zeta^2) of its own velocity at
/// distance 0.
[[nodiscard]] DOWNWASH_EXPORT double image_loss(double z_over_r, double distance_radii);

/// K of a wide flat surface at distance `z_over_r` >= 0 as the formula or table says, not clamped; infinite at a
/// formula's pole and below. The multirotor models see the other rotors in `neighbours`; `multirotor_body` gives the
/// whole vehicle's K (thesis (2.17)). @pre the effect has a table if the model is `table`
[[nodiscard]] DOWNWASH_EXPORT double formula_factor(const SurfaceEffect& effect, double z_over_r,
                                                    const RotorNeighbours& neighbours = {});

}  // namespace downwash
