#include "downwash/aeromap/disc_query.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/aeromap/gauss_rule.hpp"

namespace downwash {

double DiscQuery::mean_factor(double one_m, double other_m) const {
    if (mean != nullptr) {
        return (*mean)(one_m / unit_m, other_m / unit_m);
    }
    const auto there = [this](double gap_m) { return factor(gap_m); };
    const double low = std::min(one_m, other_m);
    const double high = std::max(one_m, other_m);
    if (high - low < 1e-3 * unit_m) {
        return factor(0.5 * (low + high));
    }
    // The model's cap is a kink which the rule must not run across.
    const double kink = std::clamp(kink_m(), low, high);
    return (integrate(plain_6, low, kink, there) + integrate(plain_6, kink, high, there)) / (high - low);
}

}  // namespace downwash
