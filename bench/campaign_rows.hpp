#pragma once

#include <limits>
#include <vector>

#include "downwash/bench/campaign_report.hpp"

namespace downwash::bench {

inline constexpr double infinite = std::numeric_limits<double>::infinity();

/// The runs of one planner on one experiment by place of their seeds; nullptr where a seed is still to be run.
using Row = std::vector<const Run*>;

/// Figures of a run, infinite where it has none.
[[nodiscard]] double first_solution_s(const Run& run);
[[nodiscard]] double verified_s(const Run& run);
[[nodiscard]] double flown_cost(const Run& run);

/// A figure of every attempted seed.
template <class Figure>
std::vector<double> figures_of(const Row& row, const Figure& figure) {
    std::vector<double> values;
    for (const Run* run : row) {
        if (run != nullptr) {
            values.push_back(figure(*run));
        }
    }
    return values;
}

[[nodiscard]] Spread spread_of(const std::vector<double>& values);

/// What the best plans so far cost at a moment of the searches.
[[nodiscard]] CostAt costs_at(const Row& row, double time_s);

/// Holds the cells of a report to the bars of its plan, and notes what it finds in the report.
/// @param rows of all cells, in their order
void judge_bars(const std::vector<Row>& rows, CampaignReport& report);

}  // namespace downwash::bench
