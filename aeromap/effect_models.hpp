#pragma once

#include <string_view>

#include "downwash/aeromap/aero_settings.hpp"
#include "downwash/base/export.hpp"

namespace downwash {

/// Factor of a wide flat surface at distance z_over_r (in rotor radii, >= 0) from the rotor plane, clamped to
/// [1, max_factor]. Below the pole of its formula a model stays at max_factor. `none` gives 1.
[[nodiscard]] DOWNWASH_EXPORT double surface_factor(const SurfaceEffect& effect, double z_over_r, double max_factor);

/// What a person should know of a model before using it.
struct EffectModelInfo {
    EffectModel model;
    std::string_view name;      ///< as in a problem file, for example "cheeseman-bennett"
    std::string_view source;    ///< where the formula comes from
    std::string_view validity;  ///< range of z / R in which it was shown to hold
};

/// Every model there is, in the order of EffectModel.
[[nodiscard]] DOWNWASH_EXPORT const EffectModelInfo& info(EffectModel model);

/// The model of that name; nullptr when there is none.
[[nodiscard]] DOWNWASH_EXPORT const EffectModelInfo* find_effect_model(std::string_view name);

}  // namespace downwash
