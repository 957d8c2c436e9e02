#include "downwash/bench/uncertainty_study/uncertainty_figures.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "downwash/bench/campaign_rows.hpp"
#include "downwash/bench/campaign_store.hpp"

namespace downwash::bench {
namespace {

/// What a part of the study has left, and the runs of each of its planners on each problem.
struct PartResults {
    CampaignPlan plan;
    std::vector<RunFigures> runs;
    std::vector<Row> rows;  ///< problems outermost
};

PartResults results_of(const StudyPart& part, const std::filesystem::path& folder) {
    PartResults of{plan_of(part.read), {}, {}};
    if (std::filesystem::exists(folder / part.name / results_file)) {
        FiguresMaker maker;
        of.plan = read_runs(
            folder / part.name, [](const CampaignPlan&) {},
            [&](const Run& run) { of.runs.push_back(maker.figures_of(run)); });
    }
    const std::size_t planners = of.plan.planners.size();
    of.rows.resize(of.plan.experiments.size() * planners);
    for (const RunFigures& run : of.runs) {
        of.rows.at(run.experiment * planners + run.planner).push_back(&run);
    }
    return of;
}

std::string setup_name(const PlannerSetup& planner, const StudyPart& part) {
    PlannerSetup without_margin = planner;
    without_margin.margin_m.reset();
    std::string name = std::string(downwash::name_of(planner.variant)) + ", " + part.assumed;
    return planner.margin_m ? name + planner.name().substr(without_margin.name().size()) : name;
}

/// Costs of flights in the nominal world, by problem and seed.
using Costs = std::map<std::pair<std::string, std::uint32_t>, double>;

/// A row and the problems of its runs.
struct Runs {
    Row row;
    std::vector<std::string> problems;

    void add(const Row& more, const std::string& problem) {
        row.insert(row.end(), more.begin(), more.end());
        problems.resize(row.size(), problem);
    }
};

bool is_reliable(const RunFigures& run) {
    return run.worlds > 0 &&
           static_cast<double>(run.failures_in_worlds) <= max_failure_share * static_cast<double>(run.worlds);
}

SetupFigures setup_figures(const Runs& runs, const Costs& reference) {
    const auto share_in = [&](const auto& test) {
        const auto hits =
            std::count_if(runs.row.begin(), runs.row.end(), [&](const RunFigures* run) { return test(*run); });
        return share_of(static_cast<std::size_t>(hits), runs.row.size());
    };
    SetupFigures figures;
    figures.attempted = runs.row.size();
    figures.planned = share_in([](const RunFigures& run) { return run.first_solution_s.has_value(); });
    figures.reliable = share_in(is_reliable);
    figures.in_worlds = worlds_of(runs.row);
    figures.first_solution_s =
        spread_of(figures_of(runs.row, [](const RunFigures& run) { return run.first_solution_s.value_or(infinite); }));
    std::vector<double> durations_s, ratios;
    for (std::size_t i = 0; i < runs.row.size(); ++i) {
        const RunFigures& run = *runs.row[i];
        if (!run.holds()) {
            continue;
        }
        durations_s.push_back(run.duration_s);
        if (const auto cost = reference.find({runs.problems[i], run.seed}); cost != reference.end()) {
            ratios.push_back(run.flight_cost / cost->second);
        }
    }
    figures.duration_s = spread_of(durations_s);
    figures.cost_ratio = spread_of(ratios);
    figures.pairs = ratios.size();
    return figures;
}

/// Adds the figures of every planner of a part.
void add_part(const StudyPart& part, const PartResults& of, const Costs& reference, StudyFigures& all) {
    const CampaignPlan& plan = of.plan;
    for (std::size_t p = 0; p < plan.planners.size(); ++p) {
        const auto add = [&](const Runs& runs, const std::string& problem, std::vector<SetupFigures>& into) {
            SetupFigures figures = setup_figures(runs, reference);
            figures.setting = part.setting;
            figures.setup = setup_name(plan.planners[p], part);
            figures.problem = problem;
            figures.certifies = part.certifies;
            into.push_back(std::move(figures));
        };
        Runs together;
        for (std::size_t e = 0; e < plan.experiments.size(); ++e) {
            const std::string& problem = plan.experiments[e].problem;
            Runs alone;
            alone.add(of.rows[e * plan.planners.size() + p], problem);
            add(alone, problem, all.by_problem);
            together.add(of.rows[e * plan.planners.size() + p], problem);
        }
        add(together, "", all.setups);
    }
}

/// What the reference setup flies for.
Costs reference_costs(const std::vector<StudyPart>& parts, const std::vector<PartResults>& results) {
    Costs costs;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const CampaignPlan& plan = results[i].plan;
        for (const RunFigures& run : results[i].runs) {
            if (run.holds() && setup_name(plan.planners[run.planner], parts[i]) == reference_setup) {
                costs[{plan.experiments[run.experiment].problem, run.seed}] = run.flight_cost;
            }
        }
    }
    return costs;
}

}  // namespace

StudyFigures figures_of(const std::vector<StudyPart>& parts, const std::filesystem::path& folder) {
    StudyFigures figures;
    std::vector<PartResults> results;
    for (const StudyPart& part : parts) {
        results.push_back(results_of(part, folder));
        figures.planned += results.back().plan.run_count();
        figures.done += results.back().runs.size();
    }
    const CampaignPlan& first = results.at(0).plan;
    for (const char* name : {"version", "commit", "processor", "jobs", "time_limit_s", "seeds", "evaluation_worlds"}) {
        figures.settings.emplace_back(name, setting(first, name));
    }
    const Costs reference = reference_costs(parts, results);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        add_part(parts[i], results[i], reference, figures);
    }
    figures.findings = findings_of(figures.setups);
    return figures;
}

}  // namespace downwash::bench
