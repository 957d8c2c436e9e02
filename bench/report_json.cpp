#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "downwash/base/text.hpp"
#include "downwash/bench/campaign_report.hpp"
#include "downwash/bench/campaign_rows.hpp"

namespace downwash::bench {
namespace {

using Json = nlohmann::ordered_json;

/// How much of a report is written.
struct Detail {
    std::size_t seed_step = 1;  ///< one of so many seeds
    std::size_t max_steps = SIZE_MAX;
    std::size_t max_failed_seeds = SIZE_MAX;  ///< most seeds listed for one cause
};

Json number(double value) {
    return std::isfinite(value) ? Json(value + 0.0) : Json();  // no "-0.0"
}

template <class T>
Json optional_json(const std::optional<T>& value) {
    return value ? Json(*value) : Json();
}

Json share_json(const Share& share) {
    return {{"hits", share.hits}, {"attempts", share.attempts}, {"low", share.low}, {"high", share.high}};
}

Json spread_json(const Spread& spread) {
    return {{"0", number(spread.min)},
            {"25", number(spread.low_quartile)},
            {"50", number(spread.median)},
            {"75", number(spread.high_quartile)},
            {"95", number(spread.quantile_95)}};
}

/// The JSON of every element.
template <class Element, class Write>
Json list_json(const std::vector<Element>& elements, const Write& write) {
    Json list = Json::array();
    for (const Element& element : elements) {
        list.push_back(write(element));
    }
    return list;
}

Json costs_json(const std::vector<CostAt>& costs) {
    return list_json(costs, [](const CostAt& at) -> Json {
        return {{"time_s", at.time_s}, {"cost", spread_json(at.cost)}};
    });
}

Json steps_json(const std::vector<SolvedAt>& steps) {
    return list_json(steps, [](const SolvedAt& at) -> Json {
        return {{"time_s", at.time_s}, {"solved", share_json(at.solved)}};
    });
}

Json held_json(const std::vector<HeldAt>& steps) {
    return list_json(steps, [](const HeldAt& at) -> Json { return {{"cost", at.cost}, {"held", at.held}}; });
}

/// Null where no plan was tested or flown in worlds.
Json worlds_json(const WorldsFigures& figures) {
    if (!figures.has_any()) {
        return nullptr;
    }
    return {{"tested", figures.tested},
            {"certified", share_json(figures.certified)},
            {"first_certified_s", spread_json(figures.first_certified_s)},
            {"flown", figures.flown},
            {"failed", share_json(figures.failed)},
            {"alone", list_json(figures.alone, [](const ParameterFigures& of) -> Json {
                 return {{"parameter", of.parameter},
                         {"plans", of.plans},
                         {"failed_low", of.failed_low},
                         {"failed_high", of.failed_high}};
             })}};
}

/// By column. Chosen by seed, so that all planners have the same ones.
Json seeds_json(const std::vector<SeedFigures>& seeds, std::size_t step) {
    Json columns;
    for (const char* name :
         {"seed", "cause", "first_solution_s", "whole_run_s", "flown_cost", "certified", "failures_in_worlds"}) {
        columns[name] = Json::array();
    }
    for (const SeedFigures& of : seeds) {
        if (of.place % step != 0) {
            continue;
        }
        columns["seed"].push_back(of.seed);
        columns["cause"].push_back(of.cause.empty() ? Json() : Json(of.cause));
        columns["first_solution_s"].push_back(number(of.first_solution_s));
        columns["whole_run_s"].push_back(number(of.answer_s));
        columns["flown_cost"].push_back(number(of.flown_cost));
        columns["certified"].push_back(optional_json(of.is_certified));
        columns["failures_in_worlds"].push_back(optional_json(of.failures_in_worlds));
    }
    return columns;
}

Json cell_json(const CampaignPlan& plan, const CellFigures& cell, const Detail& detail) {
    Json causes = Json::object();
    for (const auto& [cause, count] : cell.failures_by_cause) {
        causes[cause] = count;
    }
    const PlannerSetup& planner = plan.planners[cell.planner];
    return {{"problem", plan.experiments[cell.experiment].problem},
            {"objective", plan.experiments[cell.experiment].objective},
            {"cost_unit", plan.experiments[cell.experiment].cost_unit()},
            {"planner", planner.name()},
            {"variant", downwash::name_of(planner.variant)},
            {"algorithm", planner.algorithm},
            {"parameters", planner.parameters},
            {"margin_m", optional_json(planner.margin_m)},
            {"missing", cell.missing},
            {"solved", share_json(cell.solved)},
            {"failed_flights", share_json(cell.failed_flights)},
            {"held", share_json(cell.held)},
            {"failures_by_cause", causes},
            {"first_solution_s", spread_json(cell.first_solution_s)},
            {"verified_s", spread_json(cell.verified_s)},
            {"whole_run_s", spread_json(cell.answer_s)},
            {"flown_cost", spread_json(cell.flown_cost)},
            {"least_clearance_m", number(cell.min_clearance_m)},
            {"discarded", cell.discarded},
            {"cost_over_time", costs_json(cell.cost_over_time)},
            {"cost_curve", costs_json(cell.cost_curve)},
            {"solved_over_time", steps_json(evenly_chosen(cell.solved_over_time, detail.max_steps))},
            {"held_over_cost", held_json(evenly_chosen(cell.held_over_cost, detail.max_steps))},
            {"in_worlds", worlds_json(cell.in_worlds)},
            {"seeds", seeds_json(cell.seeds, detail.seed_step)}};
}

Json totals_json(const CampaignPlan& plan, const PlannerTotals& totals) {
    const PlannerSetup& planner = plan.planners[totals.planner];
    return {{"planner", planner.name()},
            {"variant", downwash::name_of(planner.variant)},
            {"algorithm", planner.algorithm},
            {"parameters", planner.parameters},
            {"margin_m", optional_json(planner.margin_m)},
            {"solved", share_json(totals.solved)},
            {"failed_flights", share_json(totals.failed_flights)},
            {"held", share_json(totals.held)},
            {"discarded", totals.discarded},
            {"in_worlds", worlds_json(totals.in_worlds)}};
}

Json comparison_json(const CampaignPlan& plan, const PlannerComparison& comparison) {
    const Pairing& pairs = comparison.pairing;
    return {{"experiment", plan.experiments[comparison.experiment].name()},
            {"first", plan.planners[comparison.first].name()},
            {"second", plan.planners[comparison.second].name()},
            {"measure", comparison.measure},
            {"first_smaller", pairs.first_smaller},
            {"second_smaller", pairs.second_smaller},
            {"equal", pairs.equal},
            {"sign_test_p", pairs.sign_test_p},
            {"pairs", pairs.finite},
            {"median_difference", number(pairs.median_difference)},
            {"signed_rank_p", pairs.finite == 0 ? Json() : Json(pairs.signed_rank_p)}};
}

Json margin_json(const CampaignPlan& plan, const MarginFinding& finding) {
    Json problems = Json::array();
    for (std::size_t e = 0; e < plan.experiments.size(); ++e) {
        const std::optional<SafeMargin>& alone = finding.alone[e];
        problems.push_back({{"experiment", plan.experiments[e].name()},
                            {"safe_margin_m", alone ? Json(alone->margin_m) : Json()},
                            {"solved_when_safe", alone ? share_json(alone->solved) : Json()},
                            {"solved_when_safe_everywhere",
                             e < finding.solved_when_safe.size() ? share_json(finding.solved_when_safe[e]) : Json()}});
    }
    return {{"variant", downwash::name_of(finding.planner.variant)},
            {"algorithm", finding.planner.algorithm},
            {"parameters", finding.planner.parameters},
            {"safe_margin_m", optional_json(finding.safe_margin_m)},
            {"experiments", problems}};
}

/// A setting as what it is: a number, true or false, text; null for a limit that there is not.
Json setting_json(std::string_view name, const std::string& value) {
    constexpr std::string_view numbers[] = {"jobs", "shards", "time_limit_s", "max_iterations", "evaluation_worlds"};
    constexpr std::string_view flags[] = {"stop_at_first_solution", "as_believed", "check_execution", "certify"};
    if (std::ranges::find(flags, name) != std::end(flags)) {
        return value == "true";
    }
    if (std::ranges::find(numbers, name) == std::end(numbers)) {
        return value;
    }
    if (const auto whole = parse_number<std::uint64_t>(value)) {
        return *whole;
    }
    return optional_json(parse_number<double>(value));
}

Json failure_json(const CampaignPlan& plan, const FailureGroup& failure, const Detail& detail) {
    const bool is_whole = failure.seeds.size() <= detail.max_failed_seeds;
    std::vector<double> distances_m = failure.nearest_approach_m;
    if (!is_whole && !distances_m.empty()) {  // the page shows their range
        const auto [min, max] = std::minmax_element(distances_m.begin(), distances_m.end());
        distances_m = {*min, *max};
    }
    return {{"experiment", plan.experiments[failure.experiment].name()},
            {"planner", plan.planners[failure.planner].name()},
            {"cause", failure.cause},
            {"count", failure.seeds.size()},
            {"seeds", is_whole ? failure.seeds
                               : std::vector<std::uint32_t>(
                                     failure.seeds.begin(),
                                     failure.seeds.begin() + static_cast<std::ptrdiff_t>(detail.max_failed_seeds))},
            {"nearest_approach_m", distances_m}};
}

Json document_of(const CampaignReport& report, const Detail& detail) {
    const CampaignPlan& plan = report.plan;
    Json document{{"schema", "downwash/campaign-report/v1"}};
    for (const auto& [name, value] : plan.settings) {
        document["settings"][name] = setting_json(name, value);
    }
    document["runs_planned"] = plan.run_count();
    document["runs_done"] = report.done;
    document["time_limit_s"] = optional_json(plan.time_limit_s);
    document["stop_at_first_solution"] = plan.stop_at_first_solution;
    document["evaluation_worlds"] = plan.evaluation_worlds;
    document["left_out"] = plan.left_out;
    document["processor_models"] = report.processor_models();
    document["machines"] = list_json(report.machines, [](const MachineFigures& of) -> Json {
        return {{"host", of.machine.host},
                {"processor", of.machine.processor},
                {"instruction_set", of.machine.instruction_set},
                {"runs", of.runs},
                {"median_load", of.median_load},
                {"max_load", of.max_load}};
    });
    document["totals"] = list_json(report.totals, [&](const auto& totals) { return totals_json(plan, totals); });
    document["cells"] = list_json(report.cells, [&](const auto& cell) { return cell_json(plan, cell, detail); });
    document["comparisons"] =
        list_json(report.comparisons, [&](const auto& comparison) { return comparison_json(plan, comparison); });
    document["margins"] = list_json(report.margins, [&](const auto& finding) { return margin_json(plan, finding); });
    document["failures"] =
        list_json(report.failures, [&](const auto& failure) { return failure_json(plan, failure, detail); });
    document["bars"] = list_json(report.targets, [&](const TargetResult& target) -> Json {
        return {{"experiment", plan.experiments[target.experiment].name()},
                {"planner", plan.planners[target.planner].name()},
                {"bar", target.target},
                {"found", target.found},
                {"kept", target.is_met}};
    });
    document["seed_step"] = detail.seed_step;
    return document;
}

}  // namespace

std::string json_of(const CampaignReport& report) {
    return document_of(report, {}).dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string page_json_of(const CampaignReport& report) {
    // All that is drawn has to be laid out by a browser within a second or two.
    constexpr std::size_t max_seeds = 5000, page_steps = 10000, min_steps = 20, max_failed_seeds = 200;
    Detail detail;
    if (report.done > max_seeds) {
        detail.seed_step = (report.done + max_seeds - 1) / max_seeds;
        detail.max_steps = std::max(min_steps, page_steps / report.cells.size());
        detail.max_failed_seeds = max_failed_seeds;
    }
    return document_of(report, detail).dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace downwash::bench
