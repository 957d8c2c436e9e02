#include "downwash/fitting/least_place.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cstddef>
#include <iterator>
#include <vector>

namespace downwash {

LeastPlace least_place(const std::function<double(double)>& function, double low, double high) {
    // A coarse look first: Brent's method finds the minimum between three points.
    constexpr double factor = 1.1, least_share = 1e-5;
    std::vector<double> places{low};
    for (double place = std::max(factor * low, least_share * high); place < high; place *= factor) {
        places.push_back(place);
    }
    places.push_back(high);
    std::vector<double> values;
    std::transform(places.begin(), places.end(), std::back_inserter(values), function);
    const auto best = static_cast<std::size_t>(std::min_element(values.begin(), values.end()) - values.begin());
    const std::size_t last = places.size() - 1;
    constexpr int bits = 24;
    const auto [at, value] = boost::math::tools::brent_find_minima(function, places[best > 0 ? best - 1 : 0],
                                                                   places[std::min(best + 1, last)], bits);
    if (values[best] <= value) {
        return {places[best], best == 0 || best == last};
    }
    return {at, false};
}

}  // namespace downwash
