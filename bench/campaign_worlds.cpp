#include <algorithm>
#include <boost/math/distributions/binomial.hpp>

#include "downwash/bench/campaign_rows.hpp"

namespace downwash::bench {
namespace {

/// With the 95 % interval of Clopper and Pearson (1934). Boost's takes no longer for many flights, as the certificate's
/// does, whose digits do not depend on a library.
Share failed_of(std::uint64_t failures, std::uint64_t flights) {
    using Binomial = boost::math::binomial_distribution<double>;
    constexpr double tail = 0.025;  // on either side
    const auto n = static_cast<double>(flights);
    const auto k = static_cast<double>(failures);
    return {failures, flights, failures == 0 ? 0 : Binomial::find_lower_bound_on_p(n, k, tail),
            failures >= flights ? 1 : Binomial::find_upper_bound_on_p(n, k, tail)};
}

void count(const ParameterFlights& flights, std::vector<ParameterFigures>& all) {
    const auto same =
        std::find_if(all.begin(), all.end(), [&](const auto& known) { return known.parameter == flights.parameter; });
    ParameterFigures& figures = same != all.end() ? *same : all.emplace_back(ParameterFigures{flights.parameter});
    ++figures.plans;
    figures.failed_low += flights.fails_low ? 1 : 0;
    figures.failed_high += flights.fails_high ? 1 : 0;
}

}  // namespace

WorldsFigures worlds_of(const Row& row) {
    WorldsFigures figures;
    std::size_t attempts = 0, certified = 0;
    std::uint64_t flights = 0, failures = 0;
    for (const RunFigures* run : row) {
        if (run == nullptr) {
            continue;
        }
        ++attempts;
        if (run->is_certified) {
            ++figures.tested;
            certified += *run->is_certified ? 1 : 0;
        }
        if (run->worlds > 0) {
            ++figures.flown;
            flights += run->worlds;
            failures += run->failures_in_worlds;
            for (const ParameterFlights& alone : *run->alone) {
                if (run->holds()) {
                    count(alone, figures.alone);
                }
            }
        }
    }
    figures.certified = share_of(certified, attempts);
    figures.first_certified_s = spread_of(figures_of(row, first_certified_s));
    figures.failed = failed_of(failures, flights);
    return figures;
}

}  // namespace downwash::bench
