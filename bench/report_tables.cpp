#include <fmt/core.h>

#include <cmath>
#include <string_view>

#include "downwash/base/csv_cell.hpp"
#include "downwash/bench/campaign_report.hpp"
#include "downwash/bench/campaign_schema.hpp"

namespace downwash::bench {
namespace {

/// Text with every character that LaTeX would interpret escaped.
std::string in_latex(std::string_view text) {
    std::string escaped;
    for (const char letter : text) {
        if (letter == '\\') {
            escaped += "\\textbackslash{}";
        } else if (letter == '~') {
            escaped += "\\textasciitilde{}";
        } else if (letter == '^') {
            escaped += "\\textasciicircum{}";
        } else if (letter == '\n' || letter == '\r') {
            escaped += ' ';
        } else {
            escaped += std::string_view("{}$&#_%").find(letter) != std::string_view::npos ? "\\" : "";
            escaped += letter;
        }
    }
    return escaped;
}

std::string latex_share(const Share& share) {
    return fmt::format("{}/{} [{:.1f}, {:.1f}]", share.hits, share.attempts, 100 * share.low, 100 * share.high);
}

std::string latex_number(double value) {
    if (!std::isfinite(value)) {
        return "--";
    }
    value += 0.0;  // no "-0"
    return std::abs(value) >= 100 ? fmt::format("{:.0f}", value) : fmt::format("{:#.3g}", value);
}

std::string latex_spread(const Spread& spread) {
    if (!std::isfinite(spread.median)) {
        return "--";
    }
    return fmt::format("{} [{}, {}]", latex_number(spread.median), latex_number(spread.low_quartile),
                       latex_number(spread.high_quartile));
}

/// The cells of what becomes of plans in worlds.
std::string latex_worlds(const WorldsFigures& figures) {
    return fmt::format(" & {} & {} & {}", figures.flown > 0 ? latex_share(figures.failed) : "--",
                       figures.tested > 0 ? latex_share(figures.certified) : "--",
                       latex_spread(figures.first_certified_s));
}

std::string csv_number(double value) {
    return std::isfinite(value) ? fmt::format("{}", value + 0.0) : "";
}

std::string csv_share(const Share& share) {
    return fmt::format("{},{},{}", share.hits, share.low, share.high);
}

std::string csv_spread(const Spread& spread) {
    return fmt::format("{},{},{},{},{}", csv_number(spread.min), csv_number(spread.low_quartile),
                       csv_number(spread.median), csv_number(spread.high_quartile), csv_number(spread.quantile_95));
}

/// The cells of what becomes of plans in worlds, empty for what nobody has tried.
std::string csv_worlds(const WorldsFigures& figures) {
    return (figures.tested > 0 ? csv_share(figures.certified) : ",,") + "," +
           csv_number(figures.first_certified_s.median) + "," +
           (figures.flown > 0 ? fmt::format("{},{}", figures.failed.attempts, csv_share(figures.failed)) : ",,,");
}

}  // namespace

std::string latex_of(const CampaignReport& report) {
    const CampaignPlan& plan = report.plan;
    const bool has_worlds = report.has_worlds();
    std::string text = fmt::format(
        "% Campaign {}, Downwash {} at commit {}, {} of {} runs; needs \\usepackage{{booktabs}}.\n"
        "% Shares with 95 % Wilson intervals, of flights in worlds with those of Clopper and Pearson; medians with "
        "quartiles over all attempted seeds.\n"
        "{}\\begin{{tabular}}{{llrrrr{}}}\n\\toprule\n"
        "Problem & Planner & Solved and held [\\%] & Failed flights [\\%] & First solution [s] & Executed cost{} "
        "\\\\\n",
        in_latex(setting(plan, "campaign")), in_latex(setting(plan, "version")), in_latex(setting(plan, "commit")),
        report.done, plan.run_count(),
        report.processor_models() > 1
            ? fmt::format("% Times are of {} models of processors together: do not compare them.\n",
                          report.processor_models())
            : "",
        has_worlds ? "rrr" : "", has_worlds ? " & Failed in worlds [\\%] & Certified [\\%] & First certified [s]" : "");
    std::size_t experiment = plan.experiments.size();
    for (const CellFigures& cell : report.cells) {
        const bool is_first = cell.experiment != experiment;
        if (is_first) {
            text += experiment == plan.experiments.size() ? "\\midrule\n" : "\\addlinespace\n";
            experiment = cell.experiment;
        }
        text += fmt::format("{} & {} & {} & {} & {} & {}{} \\\\\n",
                            is_first ? in_latex(plan.experiments[experiment].name()) : "",
                            in_latex(plan.planners[cell.planner].name()), latex_share(cell.held),
                            latex_share(cell.failed_flights), latex_spread(cell.first_solution_s),
                            latex_spread(cell.flown_cost), has_worlds ? latex_worlds(cell.in_worlds) : "");
    }
    return text + "\\bottomrule\n\\end{tabular}\n";
}

std::string csv_of(const CampaignReport& report) {
    const CampaignPlan& plan = report.plan;
    std::string text =
        "problem,objective,variant,algorithm,parameters,margin_m,attempted,missing,solved,solved_low,solved_high,"
        "failed_flights,"
        "failed_flights_low,failed_flights_high,held,held_low,held_high,discarded,least_clearance_m";
    for (const char* spread : {"first_solution_s", "verified_s", "whole_run_s", "flown_cost"}) {
        for (const char* quantile : {"0", "25", "50", "75", "95"}) {
            text += fmt::format(",{}_{}", spread, quantile);
        }
    }
    text +=
        ",certified,certified_low,certified_high,first_certified_s_50,flights_in_worlds,failed_in_worlds,"
        "failed_in_worlds_low,failed_in_worlds_high,processor_models\r\n";
    for (const CellFigures& cell : report.cells) {
        const Experiment& experiment = plan.experiments[cell.experiment];
        const PlannerSetup& planner = plan.planners[cell.planner];
        text += fmt::format(
            "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\r\n", csv_cell(experiment.problem),
            csv_cell(experiment.objective), downwash::name_of(planner.variant), csv_cell(planner.algorithm),
            csv_cell(text_of(planner.parameters)), planner.margin_m ? csv_number(*planner.margin_m) : "",
            cell.solved.attempts, cell.missing, csv_share(cell.solved), csv_share(cell.failed_flights),
            csv_share(cell.held), cell.discarded, csv_number(cell.min_clearance_m), csv_spread(cell.first_solution_s),
            csv_spread(cell.verified_s), csv_spread(cell.answer_s), csv_spread(cell.flown_cost),
            csv_worlds(cell.in_worlds), report.processor_models() > 0 ? std::to_string(report.processor_models()) : "");
    }
    return text;
}

}  // namespace downwash::bench
