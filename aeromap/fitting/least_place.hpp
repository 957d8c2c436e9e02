#pragma once

#include <functional>

namespace downwash {

/// Where a function is least within a range.
struct LeastPlace {
    double at = 0;
    bool is_at_bound = false;  ///< whether it lies at an end of the range
};

/// Finds the least value of a function of one variable.
/// @param function finite from `low` to `high`   @pre 0 <= low < high
[[nodiscard]] LeastPlace least_place(const std::function<double(double)>& function, double low, double high);

}  // namespace downwash
