#pragma once

#include <utility>
#include <vector>

#include "downwash/thrust_stand/stand_results.hpp"

namespace downwash::thrust_stand {

/// c of y = c x as the ratio of sums: least squares for variances that grow as x. The interval allows for errors that
/// differ from point to point (White 1980); its degrees of freedom are those of errors that grow as x (Satterthwaite).
/// @param points (x, y) with x above 0, at least one
[[nodiscard]] StandEstimate ratio_of(const std::vector<std::pair<double, double>>& points);

/// The mean with its interval. @param values at least one
[[nodiscard]] StandEstimate mean_of(const std::vector<double>& values);

/// The standard deviation within groups, each about its own mean. Nothing below three degrees of freedom: the interval
/// would say nothing.
[[nodiscard]] std::optional<StandScatter> scatter_within(const std::vector<std::vector<double>>& groups);

}  // namespace downwash::thrust_stand
