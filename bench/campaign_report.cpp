#include "downwash/bench/campaign_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "downwash/base/quantile.hpp"
#include "downwash/bench/campaign_rows.hpp"
#include "downwash/bench/campaign_store.hpp"

namespace downwash::bench {
namespace {

template <class Test>
Share share_in(const Row& row, const Test& test) {
    const std::vector<double> hits = figures_of(row, [&](const RunFigures& run) { return test(run) ? 1.0 : 0.0; });
    return share_of(static_cast<std::size_t>(std::count(hits.begin(), hits.end(), 1.0)), hits.size());
}

/// Why no flight of a run hovered at the goal; empty when one did.
std::string cause_of(const RunFigures& run) {
    if (run.holds()) {
        return "";
    }
    if (run.status == RunStatus::solved) {
        return run.outcome ? std::string(downwash::name_of(*run.outcome)) : "not flown";
    }
    return std::string(name_of(run.status));
}

/// The cause and the error message, if there is one.
std::string full_cause_of(const RunFigures& run) {
    const std::string cause = cause_of(run);
    return run.error == nullptr ? cause : cause + ": " + *run.error;
}

std::vector<std::pair<std::string, std::size_t>> failures_by_cause(const Row& row) {
    std::map<std::string, std::size_t> counts;
    for (const RunFigures* run : row) {
        if (run != nullptr && !run->holds()) {
            ++counts[cause_of(*run)];
        }
    }
    std::vector<std::pair<std::string, std::size_t>> ordered(counts.begin(), counts.end());
    std::stable_sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    return ordered;
}

double min_clearance_m(const Row& row) {
    double clearance_m = std::numeric_limits<double>::quiet_NaN();
    for (const RunFigures* run : row) {
        if (run != nullptr && run->outcome) {
            clearance_m = std::fmin(clearance_m, run->min_clearance_m);
        }
    }
    return clearance_m;
}

std::vector<CostAt> cost_over_time(const CampaignPlan& plan, const Row& row) {
    std::vector<CostAt> costs;
    for (const double time_s : cost_moments_s) {
        if (!plan.stop_at_first_solution && time_s <= plan.time_limit_s.value_or(infinite)) {
            costs.push_back(costs_at(row, time_s));
        }
    }
    return costs;
}

/// From the first improvement to the end of the searches, sixteen moments per decade.
std::vector<CostAt> cost_curve(const CampaignPlan& plan, const Row& row) {
    double first_s = infinite, end_s = plan.time_limit_s.value_or(0);
    for (const RunFigures* run : row) {
        if (run != nullptr && !run->steps.empty()) {
            first_s = std::min(first_s, run->steps.front().wall_s);
            end_s = std::max(end_s, run->steps.back().wall_s);
        }
    }
    std::vector<CostAt> costs;
    if (plan.stop_at_first_solution || first_s == infinite) {
        return costs;
    }
    constexpr double moments_per_decade = 16, min_s = 1e-5;
    const double begin = std::ceil(moments_per_decade * std::log10(std::max(first_s, min_s)));
    for (double moment = begin; std::pow(10, moment / moments_per_decade) < end_s; ++moment) {
        costs.push_back(costs_at(row, std::pow(10, moment / moments_per_decade)));
    }
    costs.push_back(costs_at(row, end_s));
    return costs;
}

/// The finite ones of some values in their order, each with how many are not greater; of more than max_steps evenly
/// chosen ones, the last one among them.
std::vector<std::pair<double, std::size_t>> counted(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto end = std::find_if_not(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
    std::vector<std::pair<double, std::size_t>> all;
    for (auto value = values.begin(); value != end; ++value) {
        const auto count = static_cast<std::size_t>(value - values.begin()) + 1;
        if (!all.empty() && all.back().first == *value) {
            all.back().second = count;
        } else {
            all.emplace_back(*value, count);
        }
    }
    return evenly_chosen(all, max_steps);
}

std::vector<SolvedAt> solved_over_time(const Row& row) {
    const std::vector<double> times_s = figures_of(row, first_solution_s);
    std::vector<SolvedAt> steps;
    for (const auto& [time_s, count] : counted(times_s)) {
        steps.push_back({time_s, share_of(count, times_s.size())});
    }
    return steps;
}

std::vector<HeldAt> held_over_cost(const Row& row) {
    std::vector<HeldAt> steps;
    for (const auto& [cost, count] : counted(figures_of(row, flown_cost))) {
        steps.push_back({cost, count});
    }
    return steps;
}

std::vector<SeedFigures> seeds_of(const Row& row) {
    std::vector<SeedFigures> seeds;
    for (std::size_t place = 0; place < row.size(); ++place) {
        if (const RunFigures* run = row[place]; run != nullptr) {
            SeedFigures of{run->seed, place, cause_of(*run), first_solution_s(*run), run->wall_s, flown_cost(*run)};
            of.is_certified = run->is_certified;
            of.failures_in_worlds = run->worlds > 0 ? std::optional(run->failures_in_worlds) : std::nullopt;
            seeds.push_back(std::move(of));
        }
    }
    return seeds;
}

CellFigures cell_of(const CampaignPlan& plan, std::size_t experiment, std::size_t planner, const Row& row) {
    CellFigures cell;
    cell.experiment = experiment;
    cell.planner = planner;
    cell.missing = static_cast<std::size_t>(std::count(row.begin(), row.end(), nullptr));
    cell.solved = share_in(row, [](const RunFigures& run) { return run.status == RunStatus::solved; });
    cell.failed_flights = share_in(row, [](const RunFigures& run) { return run.has_failed_flight(); });
    cell.held = share_in(row, [](const RunFigures& run) { return run.holds(); });
    cell.failures_by_cause = failures_by_cause(row);
    cell.first_solution_s = spread_of(figures_of(row, first_solution_s));
    cell.verified_s = spread_of(figures_of(row, verified_s));
    cell.answer_s = spread_of(figures_of(row, [](const RunFigures& run) { return run.wall_s; }));
    cell.flown_cost = spread_of(figures_of(row, flown_cost));
    cell.min_clearance_m = min_clearance_m(row);
    for (const RunFigures* run : row) {
        cell.discarded += run != nullptr ? run->discarded : 0;
    }
    cell.cost_over_time = cost_over_time(plan, row);
    cell.cost_curve = cost_curve(plan, row);
    cell.solved_over_time = solved_over_time(row);
    cell.held_over_cost = held_over_cost(row);
    cell.in_worlds = worlds_of(row);
    cell.seeds = seeds_of(row);
    return cell;
}

void add_up(const std::vector<Row>& rows, CampaignReport& report) {
    const auto sum = [](const Share& a, const Share& b) { return share_of(a.hits + b.hits, a.attempts + b.attempts); };
    for (std::size_t planner = 0; planner < report.plan.planners.size(); ++planner) {
        PlannerTotals totals{planner, share_of(0, 0), share_of(0, 0), share_of(0, 0), 0, {}};
        Row all;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const CellFigures& cell = report.cells[i];
            if (cell.planner == planner) {
                all.insert(all.end(), rows[i].begin(), rows[i].end());
                totals.solved = sum(totals.solved, cell.solved);
                totals.failed_flights = sum(totals.failed_flights, cell.failed_flights);
                totals.held = sum(totals.held, cell.held);
                totals.discarded += cell.discarded;
            }
        }
        totals.in_worlds = worlds_of(all);
        report.totals.push_back(std::move(totals));
    }
}

template <class Figure>
PlannerComparison comparison(std::size_t experiment, std::pair<std::size_t, std::size_t> planners, const char* measure,
                             const Row& first, const Row& second, const Figure& figure) {
    std::vector<double> a, b;
    for (std::size_t i = 0; i < first.size(); ++i) {
        if (first[i] != nullptr && second[i] != nullptr) {
            a.push_back(figure(*first[i]));
            b.push_back(figure(*second[i]));
        }
    }
    return {experiment, planners.first, planners.second, measure, compare_pairs(a, b)};
}

/// Every two planners with the same margin.
void compare_planners(const std::vector<Row>& rows, CampaignReport& report) {
    const std::vector<PlannerSetup>& planners = report.plan.planners;
    for (std::size_t e = 0; e < report.plan.experiments.size(); ++e) {
        for (std::size_t p = 0; p < planners.size(); ++p) {
            for (std::size_t q = p + 1; q < planners.size(); ++q) {
                if (planners[p].margin_m != planners[q].margin_m) {
                    continue;
                }
                const Row& first = rows[e * planners.size() + p];
                const Row& second = rows[e * planners.size() + q];
                report.comparisons.push_back(
                    comparison(e, {p, q}, "first solution [s]", first, second, first_solution_s));
                if (!report.plan.stop_at_first_solution) {
                    report.comparisons.push_back(comparison(e, {p, q}, "executed cost", first, second, flown_cost));
                }
            }
        }
    }
}

void list_failures(const std::vector<Row>& rows, CampaignReport& report) {
    for (std::size_t cell = 0; cell < rows.size(); ++cell) {
        const std::size_t begin = report.failures.size();
        for (const RunFigures* run : rows[cell]) {
            if (run == nullptr || run->holds()) {
                continue;
            }
            const std::string cause = full_cause_of(*run);
            const auto same = std::find_if(report.failures.begin() + static_cast<std::ptrdiff_t>(begin),
                                           report.failures.end(), [&](const auto& f) { return f.cause == cause; });
            FailureGroup& group = same != report.failures.end()
                                      ? *same
                                      : report.failures.emplace_back(FailureGroup{
                                            report.cells[cell].experiment, report.cells[cell].planner, cause, {}, {}});
            group.seeds.push_back(run->seed);
            if (!std::isnan(run->nearest_approach_m)) {
                group.nearest_approach_m.push_back(run->nearest_approach_m);
            }
        }
    }
}

/// The share that some planners solve of an experiment with a margin.
Share solved_with(const CampaignReport& report, const std::vector<std::size_t>& planners, std::size_t experiment,
                  double margin_m) {
    const auto cell = std::find_if(report.cells.begin(), report.cells.end(), [&](const CellFigures& c) {
        return c.experiment == experiment && report.plan.planners[c.planner].margin_m == margin_m &&
               std::count(planners.begin(), planners.end(), c.planner) > 0;
    });
    return cell->solved;
}

/// The minimum margin from which on no flight failed, for one experiment or all.
std::optional<double> safe_margin(const CampaignReport& report, const std::vector<std::size_t>& planners,
                                  std::optional<std::size_t> experiment) {
    std::map<double, bool> is_safe;  // by margin
    for (const CellFigures& cell : report.cells) {
        const bool counts = !experiment || cell.experiment == *experiment;
        if (counts && std::count(planners.begin(), planners.end(), cell.planner) > 0) {
            const auto [safe, is_new] = is_safe.emplace(*report.plan.planners[cell.planner].margin_m, true);
            safe->second = safe->second && cell.failed_flights.hits == 0 && cell.missing == 0;
        }
    }
    std::optional<double> found;
    for (auto margin = is_safe.rbegin(); margin != is_safe.rend() && margin->second; ++margin) {
        found = margin->first;
    }
    return found;
}

void find_margins(CampaignReport& report) {
    const std::vector<PlannerSetup>& planners = report.plan.planners;
    const auto without_margin = [](PlannerSetup planner) {
        planner.margin_m.reset();
        return planner;
    };
    std::vector<PlannerSetup> kinds;
    for (const PlannerSetup& planner : planners) {
        if (planner.margin_m && std::find(kinds.begin(), kinds.end(), without_margin(planner)) == kinds.end()) {
            kinds.push_back(without_margin(planner));
        }
    }
    for (const PlannerSetup& kind : kinds) {
        std::vector<std::size_t> of_kind;
        for (std::size_t p = 0; p < planners.size(); ++p) {
            if (without_margin(planners[p]) == kind) {
                of_kind.push_back(p);
            }
        }
        if (of_kind.size() < 2) {
            continue;
        }
        MarginFinding finding{kind, safe_margin(report, of_kind, {}), {}, {}};
        for (std::size_t e = 0; e < report.plan.experiments.size(); ++e) {
            if (finding.safe_margin_m) {
                finding.solved_when_safe.push_back(solved_with(report, of_kind, e, *finding.safe_margin_m));
            }
            std::optional<SafeMargin>& alone = finding.alone.emplace_back();
            if (const auto margin_m = safe_margin(report, of_kind, e)) {
                alone = {*margin_m, solved_with(report, of_kind, e, *margin_m)};
            }
        }
        report.margins.push_back(std::move(finding));
    }
}

/// The machines of all runs, those with most runs first.
std::vector<MachineFigures> machines_of(const std::vector<RunFigures>& runs) {
    std::map<Machine, std::vector<double>> loads;
    for (const RunFigures& run : runs) {
        if (run.machine != nullptr) {
            loads[*run.machine].push_back(run.load);
        }
    }
    std::vector<MachineFigures> machines;
    for (auto& [machine, of] : loads) {
        const std::size_t count = of.size();
        const double max_load = *std::max_element(of.begin(), of.end());
        machines.push_back({machine, count, quantile(std::move(of), 0.5), max_load});
    }
    std::stable_sort(machines.begin(), machines.end(), [](const auto& a, const auto& b) { return a.runs > b.runs; });
    return machines;
}

}  // namespace

std::size_t CampaignReport::processor_models() const {
    std::set<std::string> models;
    for (const MachineFigures& of : machines) {
        models.insert(of.machine.processor);
    }
    return models.size();
}

bool CampaignReport::has_worlds() const {
    return std::any_of(cells.begin(), cells.end(), [](const CellFigures& cell) { return cell.in_worlds.has_any(); });
}

bool CampaignReport::meets_its_targets() const {
    return std::all_of(targets.begin(), targets.end(), [](const TargetResult& target) { return target.is_met; });
}

CampaignReport report_of(const CampaignPlan& plan, const std::vector<RunFigures>& runs) {
    CampaignReport report;
    report.plan = plan;
    report.done = runs.size();
    const std::size_t planners = report.plan.planners.size();
    std::map<std::uint32_t, std::size_t> place_of_seed;
    for (const std::uint32_t seed : report.plan.seeds) {
        place_of_seed.emplace(seed, place_of_seed.size());
    }
    std::vector<Row> rows(report.plan.experiments.size() * planners, Row(report.plan.seeds.size(), nullptr));
    for (const RunFigures& run : runs) {
        if (const auto place = place_of_seed.find(run.seed); place != place_of_seed.end()) {
            rows.at(run.experiment * planners + run.planner).at(place->second) = &run;
        }
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        report.cells.push_back(cell_of(report.plan, i / planners, i % planners, rows[i]));
    }
    add_up(rows, report);
    compare_planners(rows, report);
    list_failures(rows, report);
    find_margins(report);
    check_targets(rows, report);
    report.machines = machines_of(runs);
    return report;
}

CampaignReport read_report(const std::filesystem::path& folder) {
    FiguresMaker maker;
    std::vector<RunFigures> runs;
    const CampaignPlan plan = read_runs(
        folder, [](const CampaignPlan&) {}, [&](const Run& run) { runs.push_back(maker.figures_of(run)); });
    return report_of(plan, runs);
}

}  // namespace downwash::bench
