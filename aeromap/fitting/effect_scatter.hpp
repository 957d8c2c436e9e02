#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/effects/effect_models.hpp"
#include "downwash/effects/measurements.hpp"

namespace downwash {

/// How measured effects differ from a model's, relative to the model's K - 1 = x: the measured ones are (1 + bias) x on
/// average, by least squares, and scatter about that by `scatter` x. With e = thrust ratio - K, bias = sum(e x) /
/// sum(x^2) and scatter^2 = sum((e - bias x)^2) / sum(x^2).
struct RelativeScatter {
    double z_low = 0, z_high = 0;  ///< z/R in [z_low, z_high); infinite: no end
    std::size_t points = 0;
    double bias = 0, scatter = 0;  ///< 0 without points
};

/// That of one model, with the parameters of its source, over all level measurements at a surface.
struct EffectScatter {
    EffectModel model;
    std::string surface;
    std::vector<RelativeScatter> bands;
    RelativeScatter all;  ///< from half a radius on
};

/// Nearer than this K is capped, and the potential-flow models mean nothing: it does not count in EffectScatter::all.
inline constexpr double scatter_from_z_over_r = 0.5;

/// The scatter of every model for a surface, ground first. Measurements of tilted rotors, and those without a surface,
/// are left out. @param neighbours see compare_effects()
[[nodiscard]] DOWNWASH_EXPORT std::vector<EffectScatter> effect_scatter(const std::vector<Measurements>& data,
                                                                        const RotorNeighbours& neighbours = {},
                                                                        double max_factor = 2);

}  // namespace downwash
