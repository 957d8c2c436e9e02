#include "downwash/base/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace downwash {

double quantile(std::vector<double> values, double q) {
    std::sort(values.begin(), values.end());
    return quantile_of_sorted(values, q);
}

double quantile_of_sorted(const std::vector<double>& values, double q) {
    if (values.empty()) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    const double at = q * static_cast<double>(values.size() - 1);
    const auto low = static_cast<std::size_t>(at);
    const double share = at - static_cast<double>(low);
    if (share == 0 || low + 1 == values.size() || values[low] == values[low + 1]) {
        return values[low];
    }
    return std::isfinite(values[low]) ? values[low] + share * (values[low + 1] - values[low]) : values[low + 1];
}

}  // namespace downwash
