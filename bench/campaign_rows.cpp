#include "downwash/bench/campaign_rows.hpp"

#include <algorithm>
#include <iterator>

#include "downwash/base/quantile.hpp"

namespace downwash::bench {
namespace {

double cost_at(const RunFigures& run, double time_s) {
    const auto next = std::upper_bound(run.steps.begin(), run.steps.end(), time_s,
                                       [](double at, const CostStep& step) { return at < step.wall_s; });
    return next != run.steps.begin() ? std::prev(next)->cost : infinite;
}

}  // namespace

double first_solution_s(const RunFigures& run) {
    return run.status == RunStatus::solved ? run.first_solution_s.value_or(infinite) : infinite;
}

double verified_s(const RunFigures& run) {
    return run.status == RunStatus::solved && !run.steps.empty() ? run.steps.front().wall_s : infinite;
}

double flown_cost(const RunFigures& run) {
    return run.holds() ? run.flight_cost : infinite;
}

double first_certified_s(const RunFigures& run) {
    return run.first_certified_s;
}

Spread spread_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return {quantile_of_sorted(values, 0), quantile_of_sorted(values, 0.25), quantile_of_sorted(values, 0.5),
            quantile_of_sorted(values, 0.75), quantile_of_sorted(values, 0.95)};
}

CostAt costs_at(const Row& row, double time_s) {
    return {time_s, spread_of(figures_of(row, [&](const RunFigures& run) { return cost_at(run, time_s); }))};
}

}  // namespace downwash::bench
