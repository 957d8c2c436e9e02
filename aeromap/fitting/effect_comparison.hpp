#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
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
    /// Mean of K minus thrust ratio; 0 without points. Above zero the model overstates the effect: plans are too
    /// cautious under a ceiling and too optimistic over the ground. Below zero it is the reverse.
    double mean_error = 0;
};

/// A model compared with measurements. K is clamped to [1, max_factor], as in flights.
struct ModelScore {
    SurfaceEffect effect;
    bool is_refitted = false;  ///< false: with the parameters of its source
    bool is_at_bound = false;  ///< refitted, and a parameter is at the end of its allowed range
    double rmse = 0;
    double level_rmse = 0;  ///< RMSE if the rotors are treated as level
    /// Only if refitted: the RMSE over all level measurements of other sources at the same surface, if there are any.
    std::optional<double> others_rmse;
    std::vector<ErrorBand> bands;
};

/// All models of one surface compared with the measurements of one source at one tilt.
struct DataSetComparison {
    std::string source, surface;  ///< empty if the file has no such column
    double tilt_deg = 0;
    std::size_t points = 0;
    double z_low = 0, z_high = 0;  ///< nearest and farthest z/R
    std::vector<ModelScore> scores;
};

/// Where bands of errors begin and end, in radii.
inline constexpr std::array error_band_edges{0.0, 0.5, 1.0, 2.0, std::numeric_limits<double>::infinity()};

/// Whether a model can be compared with measurements at a surface. @param surface empty: unknown
[[nodiscard]] bool is_comparable(const EffectModelInfo& model, const std::string& surface,
                                 const RotorNeighbours& neighbours);

/// Compares every model made for a surface with the measurements of each source, surface and tilt: with the parameters
/// of the model's source and, where level measurements suffice, refitted to them with K unclamped (fit_effect). Over
/// the ground the effect of a tilted rotor is reduced as default_ground_tilt_loss says.
/// @param neighbours of the vehicle measured; for one rotor alone the multirotor models are left out
/// @param max_factor >= 1
/// @throws InputError when there are more than 100 sets of source, surface and tilt, or a surface is neither "ground"
/// nor "ceiling" nor empty
[[nodiscard]] DOWNWASH_EXPORT std::vector<DataSetComparison> compare_effects(const std::vector<Measurements>& data,
                                                                             const RotorNeighbours& neighbours = {},
                                                                             double max_factor = 2);

}  // namespace downwash
