#pragma once

#include <limits>
#include <vector>

#include "downwash/bench/campaign_figures.hpp"
#include "downwash/bench/run_figures.hpp"

namespace downwash::bench {

inline constexpr double infinite = std::numeric_limits<double>::infinity();

/// The runs of one planner on one experiment in the order of their seeds; nullptr where a run is missing.
using Row = std::vector<const RunFigures*>;

/// Figures of a run; infinite without one.
[[nodiscard]] double first_solution_s(const RunFigures& run);
[[nodiscard]] double verified_s(const RunFigures& run);
[[nodiscard]] double flown_cost(const RunFigures& run);
[[nodiscard]] double first_certified_s(const RunFigures& run);

/// A figure of every attempted seed.
template <class Figure>
std::vector<double> figures_of(const Row& row, const Figure& figure) {
    std::vector<double> values;
    for (const RunFigures* run : row) {
        if (run != nullptr) {
            values.push_back(figure(*run));
        }
    }
    return values;
}

/// So many elements at most, evenly chosen; the last one is among them.
template <class Element>
std::vector<Element> evenly_chosen(const std::vector<Element>& all, std::size_t max_count) {
    if (all.size() <= max_count) {
        return all;
    }
    std::vector<Element> chosen;
    chosen.reserve(max_count);
    for (std::size_t i = 1; i <= max_count; ++i) {
        chosen.push_back(all[i * all.size() / max_count - 1]);
    }
    return chosen;
}

[[nodiscard]] Spread spread_of(std::vector<double> values);

/// The costs of the best plans so far at a moment of the searches.
[[nodiscard]] CostAt costs_at(const Row& row, double time_s);

/// How the plans of some runs do in worlds.
[[nodiscard]] WorldsFigures worlds_of(const Row& row);

/// Checks the cells of a report against the targets of its plan, and stores the results in the report.
/// @param rows of all cells, in their order
void check_targets(const std::vector<Row>& rows, CampaignReport& report);

}  // namespace downwash::bench
