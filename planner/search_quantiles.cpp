#include "downwash/planner/search_quantiles.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace downwash::planning {
namespace {

/// Spreads points evenly: Kronecker's sequence with the generalised golden ratio (Roberts 2018).
/// @param point one of the sequence, filled   @param number which one
void spread_evenly(std::span<double> point, std::uint64_t number) {
    double phi = 2;
    for (int i = 0; i < 30; ++i) {
        double power = 1;
        for (std::size_t k = 0; k < point.size(); ++k) {
            power *= phi;
        }
        phi = phi - (power * phi - phi - 1) / (static_cast<double>(point.size() + 1) * power - 1);
    }
    double step = 1;
    for (double& coordinate : point) {
        step /= phi;
        const double place = 0.5 + static_cast<double>(number) * step;
        coordinate = place - std::floor(place);
    }
}

}  // namespace

std::vector<double> search_quantiles(std::span<const DangerQuantiles> dangers, std::size_t first_apart,
                                     std::uint64_t number) {
    constexpr double DangerQuantiles::*all[] = {&DangerQuantiles::strong, &DangerQuantiles::weak,
                                                &DangerQuantiles::forward, &DangerQuantiles::backward};
    std::vector<double> quantiles(dangers.size());
    if (number <= std::size(all)) {
        std::ranges::transform(dangers, quantiles.begin(),
                               [&](const DangerQuantiles& danger) { return danger.*all[number - 1]; });
        return quantiles;
    }
    const std::span<double> both = quantiles;
    spread_evenly(both.first(first_apart), number);
    spread_evenly(both.subspan(first_apart), number);
    return quantiles;
}

}  // namespace downwash::planning
