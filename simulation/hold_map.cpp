#include "downwash/simulation/hold_map.hpp"

#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <thread>

#include "downwash/base/text.hpp"

namespace downwash {
namespace {

/// Nodes from low to high, one step apart, both ends included as far as rounding allows.
double nodes_between(double low_m, double high_m, double step_m) {
    return std::floor((high_m - low_m) / step_m + 1e-9) + 1;
}

HoldMap empty_map(const Bounds& bounds, double step_m, double arm_rad) {
    if (!(bounds.x_high_m > bounds.x_low_m && bounds.z_high_m > bounds.z_low_m)) {
        throw InputError({Fault{"bounds", "are empty: expected x and z to have a low end below the high one"}});
    }
    if (!(step_m > 0 && std::isfinite(step_m))) {
        throw InputError({Fault{"step_m", "is " + to_text(step_m) + ": expected a distance above 0 m"}});
    }
    const double columns = nodes_between(bounds.x_low_m, bounds.x_high_m, step_m);
    const double rows = nodes_between(bounds.z_low_m, bounds.z_high_m, step_m);
    if (!(columns * rows <= most_hold_nodes)) {
        throw InputError(
            {Fault{"step_m", "is " + to_text(step_m) + ", which would give " + to_text(columns * rows, 3) +
                                 " nodes: expected a step that gives at most " + to_text(most_hold_nodes)}});
    }
    HoldMap map{arm_rad,
                bounds.x_low_m,
                bounds.z_low_m,
                step_m,
                static_cast<std::size_t>(columns),
                static_cast<std::size_t>(rows),
                {},
                {}};
    map.verdicts.resize(map.columns * map.rows);
    map.growth_rates_1_s.assign(map.columns * map.rows, std::numeric_limits<double>::quiet_NaN());
    return map;
}

void fill_row(const FlightModel& model, std::size_t row, HoldMap& map) {
    for (std::size_t column = 0; column < map.columns; ++column) {
        const double x_m = map.x_low_m + static_cast<double>(column) * map.step_m;
        const double z_m = map.z_low_m + static_cast<double>(row) * map.step_m;
        const HoverAnalysis analysis = analyse_hover(model, x_m, z_m, map.arm_rad);
        const std::size_t node = row * map.columns + column;
        map.verdicts[node] = analysis.verdict;
        if (analysis.verdict >= HoldVerdict::unstable) {
            map.growth_rates_1_s[node] = analysis.stability.growth_rate_1_s;
        }
    }
}

}  // namespace

HoldMap make_hold_map(const FlightModel& model, const Bounds& bounds, double step_m, double arm_rad, int threads) {
    HoldMap map = empty_map(bounds, step_m, arm_rad);
    std::atomic<std::size_t> next_row{0};
    const auto work = [&] {
        for (std::size_t row = next_row++; row < map.rows; row = next_row++) {
            fill_row(model, row, map);
        }
    };
    {
        std::vector<std::jthread> others;
        for (int i = 1; i < threads; ++i) {
            others.emplace_back(work);
        }
        work();
    }
    return map;
}

}  // namespace downwash
