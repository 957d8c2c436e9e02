#include <cmath>
#include <optional>
#include <string>

#include "downwash/base/text.hpp"
#include "downwash/bench/campaign_rows.hpp"

namespace downwash::bench {
namespace {

std::string count_text(const Share& share) {
    return std::to_string(share.hits) + "/" + std::to_string(share.attempts);
}

std::string shown_seconds(double seconds) {
    return std::isfinite(seconds) ? to_text(seconds, 3) + " s" : "none";
}

double median_cost(const Row& row, double time_s) {
    return costs_at(row, time_s).cost.median;
}

/// Checks the cells of a campaign against one target.
class TargetCheck {
 public:
    TargetCheck(const CampaignExpectation& target, const std::vector<Row>& rows, CampaignReport& report)
        : target_(target), rows_(rows), report_(report) {}

    void check(std::size_t cell) {
        const CellFigures& figures = report_.cells[cell];
        check_success(figures);
        check_times(figures);
        check_worlds(figures);
        if (target_.cost_to_best) {
            compare_with_best(cell);
        }
        if (target_.cheaper_than) {
            compare_with_rival(cell);
        }
    }

 private:
    void add(const CellFigures& cell, const std::string& what, const std::string& found, bool is_met) {
        report_.targets.push_back({cell.experiment, cell.planner, what, found, is_met && cell.missing == 0});
    }

    void check_success(const CellFigures& cell) {
        if (target_.solved_ratio) {
            const auto min_hits = *target_.solved_ratio * static_cast<double>(cell.solved.attempts);
            add(cell, "solved share at least " + to_text(*target_.solved_ratio), count_text(cell.solved),
                static_cast<double>(cell.solved.hits) >= min_hits * (1 - 1e-12));
        }
        if (target_.failed_flights) {
            add(cell, "failed flights at most " + std::to_string(*target_.failed_flights),
                count_text(cell.failed_flights), cell.failed_flights.hits <= *target_.failed_flights);
        }
    }

    void check_times(const CellFigures& cell) {
        const auto within = [&](const char* what, const std::optional<double>& limit_s, double found_s) {
            if (limit_s) {
                add(cell, what + shown_seconds(*limit_s), shown_seconds(found_s), found_s <= *limit_s);
            }
        };
        within("median first solution within ", target_.first_solution_median_s, cell.first_solution_s.median);
        within("95 % of first solutions within ", target_.first_solution_95_s, cell.first_solution_s.quantile_95);
        within("median first verified plan within ", target_.verified_median_s, cell.verified_s.median);
        within("median first certified plan within ", target_.first_certified_median_s,
               cell.in_worlds.first_certified_s.median);
    }

    void check_worlds(const CellFigures& cell) {
        if (target_.max_failure_share) {
            const Share& failed = cell.in_worlds.failed;
            add(cell, "failed flights in worlds at most " + to_text(*target_.max_failure_share), count_text(failed),
                failed.attempts > 0 && static_cast<double>(failed.hits) <= *target_.max_failure_share *
                                                                               static_cast<double>(failed.attempts) *
                                                                               (1 + 1e-12));
        }
        if (target_.certified_ratio) {
            const Share& certified = cell.in_worlds.certified;
            const auto min_hits = *target_.certified_ratio * static_cast<double>(certified.attempts);
            add(cell, "certified share at least " + to_text(*target_.certified_ratio), count_text(certified),
                static_cast<double>(certified.hits) >= min_hits * (1 - 1e-12));
        }
    }

    void compare_with_best(std::size_t cell) {
        const std::size_t experiment = report_.cells[cell].experiment;
        double best = infinite;
        bool is_complete = true;
        for (const CellFigures& other : report_.cells) {
            if (other.experiment == experiment) {
                best = std::fmin(best, other.flown_cost.min);
                is_complete = is_complete && other.missing == 0;
            }
        }
        const double ratio = median_cost(rows_[cell], *target_.cost_after_s) / best;
        add(report_.cells[cell],
            "median cost after " + shown_seconds(*target_.cost_after_s) + " at most " + to_text(*target_.cost_to_best) +
                " of the minimum executed cost",
            std::isfinite(ratio) ? to_text(ratio, 4) : "none", is_complete && ratio <= *target_.cost_to_best);
    }

    void compare_with_rival(std::size_t cell) {
        const CellFigures& figures = report_.cells[cell];
        const PlannerSetup& setup = report_.plan.planners[figures.planner];
        for (std::size_t other = 0; other < rows_.size(); ++other) {
            const PlannerSetup& rival = report_.plan.planners[report_.cells[other].planner];
            if (report_.cells[other].experiment != figures.experiment || rival.algorithm != *target_.cheaper_than ||
                rival.variant != setup.variant || rival.margin_m != setup.margin_m || other == cell) {
                continue;
            }
            const double own = median_cost(rows_[cell], *target_.cost_after_s);
            const double its = median_cost(rows_[other], *target_.cheaper_than_after_s);
            const auto text = [](double cost) { return std::isfinite(cost) ? to_text(cost, 5) : "none"; };
            add(figures,
                "median cost after " + shown_seconds(*target_.cost_after_s) + " below that of " + rival.algorithm +
                    " after " + shown_seconds(*target_.cheaper_than_after_s),
                text(own) + " against " + text(its), own < its && report_.cells[other].missing == 0);
        }
    }

    const CampaignExpectation& target_;
    const std::vector<Row>& rows_;
    CampaignReport& report_;
};

}  // namespace

void check_targets(const std::vector<Row>& rows, CampaignReport& report) {
    for (const CampaignExpectation& target : report.plan.expectations) {
        TargetCheck check(target, rows, report);
        for (std::size_t cell = 0; cell < report.cells.size(); ++cell) {
            const PlannerSetup& setup = report.plan.planners[report.cells[cell].planner];
            if (setup.variant == target.variant && (!target.algorithm || setup.algorithm == *target.algorithm)) {
                check.check(cell);
            }
        }
    }
}

}  // namespace downwash::bench
