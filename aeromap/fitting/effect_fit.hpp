#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/effects/effect_models.hpp"
#include "downwash/effects/measurements.hpp"

namespace downwash {

/// Options of a fit.
struct FitOptions {
    RotorNeighbours neighbours;  ///< rotor layout of the multirotor models; default: one rotor alone
    std::vector<std::pair<std::string, double>> fixed;  ///< parameters that keep a value, by name
    bool is_weighted = false;                           ///< weights each residual by 1 / sigma
    std::string source = "the measurements";            ///< what errors call them: the name of their file
};

/// A parameter of the model after the fit.
struct FittedParameter {
    std::string_view name;
    double value = 0;
    std::optional<double> standard_error;  ///< empty if the data give none: fixed, at a bound, undetermined
    bool is_fixed = false;
    bool is_at_bound = false;  ///< the data ask for a value at or beyond the end of the allowed range
};

/// A model fitted to measurements by least squares, with statistics of its quality.
struct EffectFit {
    SurfaceEffect effect;                     ///< the model with the fitted parameters
    std::vector<FittedParameter> parameters;  ///< all of the model, in its order
    /// Covariance of the parameters, square and in their order; rows and columns of those without a standard error are
    /// zero. Unweighted: from the residuals' own variance over n - p degrees of freedom. Weighted: from the sigmas.
    std::vector<std::vector<double>> covariance;
    std::vector<double> residuals;  ///< thrust_ratio minus K, for each point
    double rmse = 0;                ///< sqrt(mean squared residual), unweighted
    /// Weighted squared residuals over n - p: about 1 when model and sigmas are right. Empty unless weighted with n >
    /// p.
    std::optional<double> reduced_chi_squared;
    bool is_converged = true;
    /// Parameters that the data do not determine: other values fit as well, so these mean nothing. Some have a standard
    /// error nevertheless: they are correlated with another parameter (above 0.999 in size), and for one of the pair
    /// the standard error is larger than the value.
    std::vector<std::string_view> undetermined;

    /// Correlation of two parameters, in [-1, 1]; empty where one has no standard error.
    [[nodiscard]] DOWNWASH_EXPORT std::optional<double> correlation(std::size_t i, std::size_t j) const;
};

/// Finds the parameters for which the model's formula, not clamped, is nearest to the measurements in the sense of
/// least squares, within the ranges of info(model).parameters. The search starts from the best of the source's values
/// and some hundred others spread over the ranges, so that it does not depend on a lucky start; it is repeatable. A
/// model without free parameters is only compared.
/// @throws InputError when the model is `table`, a fixed parameter is unknown or out of range, there are fewer distinct
/// distances than free parameters, no point at all, a sigma is missing, or a point lies within the formula's pole
/// whatever the parameters
[[nodiscard]] DOWNWASH_EXPORT EffectFit fit_effect(EffectModel model, const std::vector<Measurement>& points,
                                                   const FitOptions& options = {});

}  // namespace downwash
