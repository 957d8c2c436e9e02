#include <algorithm>

#include "downwash/bench/campaign_rows.hpp"
#include "downwash/planner/certificate.hpp"

namespace downwash::bench {
namespace {

Share failed_of(std::uint64_t failures, std::uint64_t flights) {
    const FailureInterval interval = failure_interval(failures, flights, 0.95);
    return {failures, flights, interval.low, interval.high};
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
