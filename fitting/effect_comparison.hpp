#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/effects/effect_models.hpp"
#include "downwash/effects/measurements.hpp"

namespace downwash {

/// The error of a model over a band of distances.
struct ErrorBand {
    double z_low = 0, z_high = 0;  ///< z/R in [z_low, z_high); the last band is open, z_high infinite
    std::size_t points = 0;
    /// Mean of K minus thrust ratio; 0 without points. Above zero the model overstates the effect. A plan that believes
    /// it is then careful under a ceiling (more pull than there is, though more saved too) and optimistic over the
    /// ground (lift, stiffness and savings that are not there); below zero it is the other way round.
    double mean_error = 0;
};

/// A model compared with measurements. K is clamped to [1, max_factor], as in flights.
struct ModelScore {
    SurfaceEffect effect;
    bool is_refitted = false;  ///< false: with the parameters of its source
    bool is_at_bound = false;  ///< refitted, and a parameter is at the end of its allowed range
    double rmse = 0;
    std::vector<ErrorBand> bands;
};

/// All models of one surface compared with the measurements of one source.
struct DataSetComparison {
    std::string source, surface;  ///< empty if the file has no such column
    std::size_t points = 0;
    double z_low = 0, z_high = 0;  ///< nearest and farthest z/R
    std::vector<ModelScore> scores;
};

/// Compares every model made for a surface with the measurements of each source and surface: with the parameters of the
/// model's source and, where the measurements suffice, refitted to them (fit_effect; the formula is fitted unclamped).
/// @param neighbours of the vehicle measured; for one rotor alone the multirotor models are left out
/// @param max_factor >= 1
/// @throws InputError when there are more than 100 pairs of source and surface, or a surface is neither "ground" nor
/// "ceiling" nor empty
[[nodiscard]] DOWNWASH_EXPORT std::vector<DataSetComparison> compare_effects(const Measurements& measurements,
                                                                             const RotorNeighbours& neighbours = {},
                                                                             double max_factor = 2);

}  // namespace downwash
