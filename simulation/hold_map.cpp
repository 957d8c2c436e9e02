#include "downwash/simulation/hold_map.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "downwash/base/grid_contour.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/base/text.hpp"

namespace downwash {
namespace {

/// Nodes from low to high, one step apart, both ends included as far as rounding allows.
double nodes_between(double low_m, double high_m, double step_m) {
    return std::floor((high_m - low_m) / step_m + 1e-9) + 1;
}

HoldMap empty_map(const Bounds& bounds, double step_m, double arm_rad) {
    if (!(bounds.x_high_m > bounds.x_low_m && bounds.z_high_m > bounds.z_low_m)) {
        throw InputError({KeyError{"bounds", "are empty: expected x and z to have a low end below the high one"}});
    }
    if (!(step_m > 0 && std::isfinite(step_m))) {
        throw InputError({KeyError{"step_m", "is " + to_text(step_m) + ": expected a distance above 0 m"}});
    }
    const double columns = nodes_between(bounds.x_low_m, bounds.x_high_m, step_m);
    const double rows = nodes_between(bounds.z_low_m, bounds.z_high_m, step_m);
    if (!(columns * rows <= max_hold_nodes)) {
        throw InputError(
            {KeyError{"step_m", "is " + to_text(step_m) + ", which would give " + to_text(columns * rows, 3) +
                                    " nodes: expected a step that gives at most " + to_text(max_hold_nodes)}});
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

HoldPoint node_of(const HoldMap& map, std::size_t column, std::size_t row) {
    return {map.x_low_m + static_cast<double>(column) * map.step_m,
            map.z_low_m + static_cast<double>(row) * map.step_m};
}

void fill_row(const FlightModel& model, std::size_t row, HoldMap& map) {
    for (std::size_t column = 0; column < map.columns; ++column) {
        const HoldPoint at = node_of(map, column, row);
        const HoverAnalysis analysis = analyse_hover(model, at.x_m, at.z_m, map.arm_rad);
        const std::size_t node = row * map.columns + column;
        map.verdicts[node] = analysis.verdict;
        if (analysis.verdict >= HoldVerdict::unstable) {
            map.growth_rates_1_s[node] = analysis.stability.growth_rate_1_s;
        }
    }
}

/// Where hover turns from stable to unstable between two nodes, by bisection.
HoldPoint crossing_of(const FlightModel& model, const HoldMap& map, const GridEdge& edge) {
    constexpr double tolerance_m = 1e-4;
    const auto is_stable_at = [&](const HoldPoint& at) {
        return analyse_hover(model, at.x_m, at.z_m, map.arm_rad).verdict == HoldVerdict::stable;
    };
    HoldPoint from = node_of(map, edge.column, edge.row);
    HoldPoint to = node_of(map, edge.column + (edge.is_upright ? 0 : 1), edge.row + (edge.is_upright ? 1 : 0));
    const bool is_stable_first = is_stable_at(from);
    double length_m = map.step_m;
    HoldPoint middle = from;
    for (; length_m > tolerance_m; length_m *= 0.5) {
        middle = {0.5 * (from.x_m + to.x_m), 0.5 * (from.z_m + to.z_m)};
        (is_stable_at(middle) == is_stable_first ? from : to) = middle;
    }
    return middle;
}

}  // namespace

HoldMap make_hold_map(const FlightModel& model, const Bounds& bounds, double step_m, double arm_rad, int threads) {
    HoldMap map = empty_map(bounds, step_m, arm_rad);
    run_parallel(map.rows, threads, [&](std::size_t row) { fill_row(model, row, map); });
    return map;
}

std::vector<std::vector<HoldPoint>> stability_boundary(const FlightModel& model, const HoldMap& map) {
    const auto side = [&map](std::size_t column, std::size_t row) {
        const HoldVerdict verdict = map.verdicts[row * map.columns + column];
        return verdict == HoldVerdict::stable ? -1 : verdict == HoldVerdict::unstable ? 1 : 0;
    };
    std::vector<std::vector<HoldPoint>> lines;
    for (const auto& edges : grid_contour(map.columns, map.rows, side)) {
        std::vector<HoldPoint>& line = lines.emplace_back();
        for (const GridEdge& edge : edges) {
            line.push_back(crossing_of(model, map, edge));
        }
    }
    return lines;
}

}  // namespace downwash
