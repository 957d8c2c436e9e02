#include "downwash/judge/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <numeric>

namespace downwash::judge {
namespace {

constexpr double tail = 0.025;  // on either side

/// The order in which values rise; equal ones keep theirs.
std::vector<std::size_t> rising_order(std::span<const double> values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    return order;
}

/// Ranks from 1, the mean one for equal values.
std::vector<double> ranks_of(std::span<const double> values) {
    const std::vector<std::size_t> order = rising_order(values);
    std::vector<double> ranks(values.size());
    for (std::size_t first = 0; first < order.size();) {
        std::size_t last = first;
        while (last + 1 < order.size() && values[order[last + 1]] == values[order[first]]) {
            ++last;
        }
        for (std::size_t i = first; i <= last; ++i) {
            ranks[order[i]] = 1 + 0.5 * static_cast<double>(first + last);
        }
        first = last + 1;
    }
    return ranks;
}

}  // namespace

Probability probability_of(std::size_t hits, std::size_t runs) {
    using Binomial = boost::math::binomial_distribution<double>;
    const auto n = static_cast<double>(runs);
    const auto k = static_cast<double>(hits);
    Probability probability;
    probability.estimate = k / n;
    probability.low =
        hits == 0 ? 0 : Binomial::find_lower_bound_on_p(n, k, tail, Binomial::clopper_pearson_exact_interval);
    probability.high =
        hits == runs ? 1 : Binomial::find_upper_bound_on_p(n, k, tail, Binomial::clopper_pearson_exact_interval);
    return probability;
}

std::optional<double> rank_correlation(std::span<const double> a, std::span<const double> b) {
    const std::vector<double> x = ranks_of(a);
    const std::vector<double> y = ranks_of(b);
    const double mean = 0.5 * (static_cast<double>(x.size()) + 1);
    double xy = 0;
    double xx = 0;
    double yy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xy += (x[i] - mean) * (y[i] - mean);
        xx += (x[i] - mean) * (x[i] - mean);
        yy += (y[i] - mean) * (y[i] - mean);
    }
    if (!(xx > 0 && yy > 0)) {
        return std::nullopt;
    }
    return xy / std::sqrt(xx * yy);
}

std::optional<std::array<double, deciles>> share_by_decile(std::span<const double> values,
                                                           const std::vector<bool>& hits) {
    if (values.size() < deciles) {
        return std::nullopt;
    }
    const std::vector<std::size_t> order = rising_order(values);
    std::array<double, deciles> shares{};
    for (std::size_t d = 0; d < deciles; ++d) {
        const std::size_t first = d * order.size() / deciles;
        const std::size_t last = (d + 1) * order.size() / deciles;
        for (std::size_t i = first; i < last; ++i) {
            shares[d] += hits[order[i]] ? 1 : 0;
        }
        shares[d] /= static_cast<double>(last - first);
    }
    return shares;
}

}  // namespace downwash::judge
