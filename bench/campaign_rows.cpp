#include "downwash/bench/campaign_rows.hpp"
#include "downwash/base/quantile.hpp"

namespace downwash::bench {
namespace {

double cost_at(const Run& run, double time_s) {
    double cost = infinite;
    for (const Improvement& improvement : run.improvements) {
        if (improvement.wall_s <= time_s) {
            cost = improvement.flown_cost.value_or(improvement.cost);
        }
    }
    return cost;
}

}  // namespace

double first_solution_s(const Run& run) {
    return run.status == RunStatus::solved ? run.first_solution_s.value_or(infinite) : infinite;
}

double verified_s(const Run& run) {
    return run.status == RunStatus::solved && !run.improvements.empty() ? run.improvements.front().wall_s : infinite;
}

double flown_cost(const Run& run) {
    return run.holds() ? run.flight->cost : infinite;
}

double first_certified_s(const Run& run) {
    return run.first_certified_s.value_or(infinite);
}

Spread spread_of(const std::vector<double>& values) {
    return {quantile(values, 0), quantile(values, 0.25), quantile(values, 0.5), quantile(values, 0.75),
            quantile(values, 0.95)};
}

CostAt costs_at(const Row& row, double time_s) {
    return {time_s, spread_of(figures_of(row, [&](const Run& run) { return cost_at(run, time_s); }))};
}

}  // namespace downwash::bench
