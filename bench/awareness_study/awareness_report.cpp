#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "downwash/base/text.hpp"
#include "downwash/bench/awareness_study/awareness_figures.hpp"
#include "downwash/bench/awareness_study/awareness_run.hpp"

namespace downwash::bench {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

Json json_of(const Share& share) {
    return {{"hits", share.hits}, {"attempts", share.attempts}, {"low", share.low}, {"high", share.high}};
}

Json json_of(const Estimate& estimate) {
    return {{"value", number(estimate.value)}, {"low", number(estimate.low)}, {"high", number(estimate.high)}};
}

Json json_of(const Quantiles& of) {
    return {{"q25", number(of.low)}, {"q50", number(of.median)}, {"q75", number(of.high)}, {"q95", number(of.most)}};
}

Json json_of(const Condition& condition) {
    return {{"kind", name_of(condition.kind)},   {"level", downwash::name_of(condition.level)},
            {"asked", name_of(condition.asked)}, {"checks", condition.checks},
            {"robot", name_of(condition.robot)}, {"time_limit_s", condition.time_limit_s}};
}

Json json_of(const AwarenessCell& cell) {
    return {{"condition", json_of(cell.condition)},
            {"group", name_of(cell.group)},
            {"problem", cell.problem.empty() ? Json() : Json(cell.problem)},
            {"attempted", cell.attempted},
            {"planned", json_of(cell.planned)},
            {"missed", cell.missed},
            {"fails_in_nominal_world", json_of(cell.fails)},
            {"fresh_failures", json_of(cell.fresh_failures)},
            {"unreliable", json_of(cell.unreliable)},
            {"cost_over_best", json_of(cell.cost_ratio)},
            {"clearance_m", json_of(cell.clearance_m)},
            {"first_candidate_s", json_of(cell.first_candidate_s)},
            {"first_certified_s", json_of(cell.first_certified_s)},
            {"wall_s", json_of(cell.wall_s)},
            {"discarded", cell.discarded}};
}

Json json_of(const Comparison& comparison) {
    return {{"first", json_of(comparison.first)},
            {"second", json_of(comparison.second)},
            {"group", name_of(comparison.group)},
            {"problem", comparison.problem.empty() ? Json() : Json(comparison.problem)},
            {"metric", name_of(comparison.metric)},
            {"claim", comparison.is_claim},
            {"pairs", comparison.pairs},
            {"left_out", comparison.left_out},
            {"fewest_pairs_of_a_problem", comparison.fewest},
            {"both", comparison.counts.both},
            {"first_only", comparison.counts.first_only},
            {"second_only", comparison.counts.second_only},
            {"neither", comparison.counts.neither},
            {"effect", json_of(comparison.effect)},
            {"odds_ratio", json_of(comparison.odds)},
            {"p", comparison.p},
            {"p_adjusted", comparison.p_adjusted},
            {"verdict", verdict_of(comparison)}};
}

std::string text(double value) {
    return std::isnan(value) ? "-" : std::isinf(value) ? "none" : to_text(value, 3);
}

std::string text_of(const Quantiles& of) {
    return std::isnan(of.median) ? "-" : text(of.median) + " [" + text(of.low) + ", " + text(of.high) + "]";
}

std::string percent(const Share& share) {
    return share.attempts == 0
               ? "-"
               : fmt::format("{}/{} [{:.1f}, {:.1f} %]", share.hits, share.attempts, 100 * share.low, 100 * share.high);
}

std::string percent(const Estimate& share) {
    if (std::isnan(share.value)) {
        return "-";
    }
    const std::string mean = fmt::format("{:.2f}", 100 * share.value);
    return std::isnan(share.low) ? mean + " %"
                                 : fmt::format("{} [{:.2f}, {:.2f}] %", mean, 100 * share.low, 100 * share.high);
}

std::string missed_text(const AwarenessCell& cell) {
    return joined(cell.missed, ", ",
                  [](const auto& cause) { return std::to_string(cause.second) + " " + cause.first; });
}

std::string heads_of_first() {
    return "level | planned for | robot | candidates | fail nominally | fail in fresh worlds | unreliable | cost over "
           "best | time [s] |\n";
}

std::string line_of_first(const AwarenessCell& cell) {
    return fmt::format("{} | {} | {} | {} | {} | {} | {} | {} | {} |\n", downwash::name_of(cell.condition.level),
                       name_of(cell.condition.asked), name_of(cell.condition.robot), percent(cell.planned),
                       percent(cell.fails), percent(cell.fresh_failures), percent(cell.unreliable),
                       text_of(cell.cost_ratio), text_of(cell.first_candidate_s));
}

std::string heads_of_reported() {
    return "level | planned for | checked | limit [s] | robot | reported | fail nominally | fail in fresh worlds | "
           "unreliable | cost over best | clearance [m] | first certificate [s] | discarded | not reported |\n";
}

std::string line_of_reported(const AwarenessCell& cell) {
    const Condition& condition = cell.condition;
    return fmt::format(
        "{} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", downwash::name_of(condition.level),
        name_of(condition.asked), condition.checks ? "yes" : "no", to_text(condition.time_limit_s),
        name_of(condition.robot), percent(cell.planned), percent(cell.fails), percent(cell.fresh_failures),
        percent(cell.unreliable), text_of(cell.cost_ratio), text_of(cell.clearance_m),
        condition.asked == Asked::certified ? text_of(cell.first_certified_s) : "-", cell.discarded, missed_text(cell));
}

/// The rule below the heads of a table with so many columns.
std::string rule(const std::string& heads) {
    std::string line = "|";
    for (std::ptrdiff_t i = std::count(heads.begin(), heads.end(), '|'); i > 0; --i) {
        line += " --- |";
    }
    return line + "\n";
}

/// @param place heads the column of the group or problem
std::string cell_table(const std::vector<AwarenessCell>& cells, PlanKind kind, const std::string& place) {
    const std::string heads = "| " + place + " | " + (kind == PlanKind::first ? heads_of_first() : heads_of_reported());
    std::string table = heads + rule(heads.substr(1));
    for (const AwarenessCell& cell : cells) {
        if (cell.condition.kind == kind && cell.attempted > 0) {
            table += "| " + (cell.problem.empty() ? std::string(name_of(cell.group)) : cell.problem) + " | " +
                     (kind == PlanKind::first ? line_of_first(cell) : line_of_reported(cell));
        }
    }
    return table;
}

/// What two conditions share, and in what they differ: "mp-arm-ada against mp-arm-da", "first, worlds, own robot".
std::string pair_text(const Comparison& comparison) {
    const Condition &a = comparison.first, &b = comparison.second;
    const auto differing = [](auto first, auto second, const auto& name) {
        return std::string(name(first)) + (first == second ? "" : " against " + std::string(name(second)));
    };
    return differing(a.level, b.level, [](Variant level) { return downwash::name_of(level); }) + ", " +
           std::string(name_of(a.kind)) + ", " +
           differing(a.asked, b.asked, [](Asked asked) { return name_of(asked); }) + ", " +
           differing(a.checks, b.checks, [](bool checks) { return checks ? "checked" : "unchecked"; }) + ", " +
           to_text(a.time_limit_s) + " s, " + std::string(name_of(a.robot));
}

std::string p_text(double p) {
    return p < 0.0001 ? "< 0.0001" : to_text(p, 2);
}

std::string comparison_table(const std::vector<Comparison>& comparisons, bool claims) {
    const std::string heads =
        "| first against second | problems | metric | pairs (left out) | first only / second only | effect [95 %] | "
        "odds "
        "ratio [95 %] | p | adjusted | |\n";
    std::string table = heads + rule(heads.substr(1));
    for (const Comparison& each : comparisons) {
        if (each.is_claim != claims || (claims ? each.pairs + each.left_out : each.pairs) == 0) {
            continue;
        }
        const bool is_event = each.counts.pairs() > 0;
        const auto end = [](double value) { return std::isinf(value) ? (value < 0 ? "-inf" : "inf") : text(value); };
        const auto interval = [&end](const Estimate& of) {
            return fmt::format("{} [{}, {}]", end(of.value), end(of.low), end(of.high));
        };
        table += fmt::format(
            "| {} | {} | {} | {} ({}) | {} | {} | {} | {} | {} | {}{} |\n", pair_text(each),
            each.problem.empty() ? std::string(name_of(each.group)) : each.problem, name_of(each.metric), each.pairs,
            each.left_out, is_event ? fmt::format("{} / {}", each.counts.first_only, each.counts.second_only) : "-",
            interval(each.effect), is_event ? interval(each.odds) : "-", p_text(each.p), p_text(each.p_adjusted),
            verdict_of(each), claims && each.fewest < seeds_of_claims ? "; preliminary" : "");
    }
    return table;
}

std::string best_table(const AwarenessFigures& figures) {
    std::string table = "| problem | robot | cost | found by |\n| --- | --- | --: | --- |\n";
    for (const auto& [place, best] : figures.best) {
        table += fmt::format("| {} | {} | {} | {} |\n", place.first, name_of(place.second), to_text(best.cost, 5),
                             name_of(best.condition));
    }
    return table;
}

struct LinePlan {
    const CellLine& line;
    std::size_t runs = 0, missing = 0;
    double s = 0;
};

std::vector<LinePlan> plans_of(const AwarenessSettings& settings, const std::vector<AwarenessRow>& rows,
                               std::uint64_t jobs) {
    const std::vector<AwarenessTask> all = tasks_of(settings), missing = missing_tasks(settings, {}, rows);
    std::vector<LinePlan> plans;
    for (std::size_t l = 0; l < settings.lines.size(); ++l) {
        const auto of_line = [l](const AwarenessTask& task) { return task.line == l; };
        std::vector<AwarenessTask> left;
        std::copy_if(missing.begin(), missing.end(), std::back_inserter(left), of_line);
        plans.push_back({settings.lines[l], static_cast<std::size_t>(std::count_if(all.begin(), all.end(), of_line)),
                         left.size(), estimated_s(settings, left, rows, jobs)});
    }
    return plans;
}

template <class Values>
std::string names(const Values& values) {
    return joined(values, ", ", [](auto value) { return std::string(name_of(value)); });
}

std::string checks_text(const std::vector<bool>& checks) {
    return checks.size() == 2 ? "no, yes" : checks.at(0) ? "yes" : "no";
}

}  // namespace

std::string json_of(const AwarenessFigures& figures) {
    Json document{{"study", "awareness"}};
    document["version"] = figures.version;
    document["commit"] = figures.commit;
    document["processor"] = figures.processor;
    document["other_commits"] = figures.other_commits;
    document["runs_planned"] = figures.planned;
    document["runs_done"] = figures.done;
    document["comparisons"] = Json::array();
    for (const Comparison& comparison : figures.comparisons) {
        document["comparisons"].push_back(json_of(comparison));
    }
    document["cells"] = Json::array();
    for (const std::vector<AwarenessCell>* cells : {&figures.cells, &figures.by_problem}) {
        for (const AwarenessCell& cell : *cells) {
            document["cells"].push_back(json_of(cell));
        }
    }
    document["best_known"] = Json::array();
    for (const auto& [place, best] : figures.best) {
        document["best_known"].push_back({{"problem", place.first},
                                          {"robot", name_of(place.second)},
                                          {"cost", best.cost},
                                          {"condition", json_of(best.condition)}});
    }
    return document.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string markdown_of(const AwarenessFigures& figures) {
    std::string page = "# Study: awareness\n\n";
    page += fmt::format("Downwash {} at commit {}; {}; {}.\n{} of {} runs done.\n", figures.version, figures.commit,
                        figures.processor,
                        figures.other_commits.empty() ? "all runs of this commit"
                                                      : "also runs of " + joined(figures.other_commits, ", "),
                        figures.done, figures.planned);
    page +=
        "\n[docs/awareness.md](../../docs/awareness.md) says what the cells are, how plans are flown and how they are "
        "compared.\n\n## Claims\n\nThe comparisons were declared before the runs. `effect`: of an event, its "
        "probability "
        "under the first condition less that under the second; of cost and times, the median ratio\nof first to "
        "second; of "
        "others the median difference. `adjusted`: p after Holm, over all claims with data. `preliminary`: a problem "
        "has "
        "fewer than " +
        std::to_string(seeds_of_claims) + " pairs.\n\n" + comparison_table(figures.comparisons, true);
    page +=
        "\n## First candidates\n\nShares have 95 % Clopper-Pearson intervals, the mean share of failures in fresh "
        "worlds "
        "a bootstrap interval over plans. `unreliable`: fails in more than 1 % of the fresh worlds.\nCosts and "
        "clearances "
        "are of plans that hold in the nominal world: median [quartiles]. Times count a run without a plan as "
        "infinite.\n\n" +
        cell_table(figures.cells, PlanKind::first, "problems");
    page += "\n## Reported plans\n\n" + cell_table(figures.cells, PlanKind::reported, "problems");
    page += "\n## Other comparisons\n\nNo claims: their p values are adjusted among themselves.\n\n" +
            comparison_table(figures.comparisons, false);
    page += "\n## First candidates by problem\n\n" + cell_table(figures.by_problem, PlanKind::first, "problem");
    page += "\n## Reported plans by problem\n\n" + cell_table(figures.by_problem, PlanKind::reported, "problem");
    page +=
        "\n## Best known plans\n\nThe least executed cost of a plan that holds in the nominal world, over all "
        "runs.\n\n" +
        best_table(figures);
    return page;
}

std::string plan_markdown(const AwarenessSettings& settings, const std::vector<AwarenessRow>& rows,
                          std::uint64_t jobs) {
    const std::string heads =
        "| line | plans | planned for | checked | robots | problems | limit [s] | seeds | worlds | runs | missing | "
        "hours "
        "left |\n";
    std::string page = heads + rule(heads.substr(1));
    double sum_s = 0;
    for (const LinePlan& plan : plans_of(settings, rows, jobs)) {
        const CellLine& line = plan.line;
        sum_s += plan.s;
        page += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.2f} |\n", line.name,
                            name_of(line.kind), names(line.asked), checks_text(line.checks), names(line.robots),
                            names(line.groups), to_text(line.time_limit_s), line.seeds, line.worlds, plan.runs,
                            plan.missing, plan.s / 3600);
    }
    return page + fmt::format("\n{:.1f} hours left with {} searches at a time.\n", sum_s / 3600, jobs);
}

std::string plan_json(const AwarenessSettings& settings, const std::vector<AwarenessRow>& rows, std::uint64_t jobs) {
    Json document{{"study", "awareness"}, {"jobs", jobs}};
    double sum_s = 0;
    document["lines"] = Json::array();
    for (const LinePlan& plan : plans_of(settings, rows, jobs)) {
        sum_s += plan.s;
        document["lines"].push_back({{"name", plan.line.name},
                                     {"seeds", plan.line.seeds},
                                     {"worlds", plan.line.worlds},
                                     {"runs", plan.runs},
                                     {"missing", plan.missing},
                                     {"estimated_s", plan.s}});
    }
    document["estimated_s"] = sum_s;
    return document.dump(2);
}

}  // namespace downwash::bench
