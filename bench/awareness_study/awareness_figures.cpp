#include "downwash/bench/awareness_study/awareness_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "downwash/base/infinity.hpp"
#include "downwash/base/quantile.hpp"
#include "downwash/base/text.hpp"
#include "downwash/base/version.hpp"
#include "downwash/bench/awareness_study/awareness_run.hpp"
#include "downwash/bench/machine.hpp"

namespace downwash::bench {
namespace {

/// The runs of one condition on one problem, by seed.
using Runs = std::map<std::uint32_t, const AwarenessRow*>;

/// Where the runs of a condition on a problem are found.
using Place = std::pair<std::string, std::string>;

/// All rows by condition and problem.
class RowIndex {
 public:
    explicit RowIndex(const std::vector<AwarenessRow>& rows) {
        for (const AwarenessRow& row : rows) {
            runs_[{name_of(row.condition), row.problem}][row.seed] = &row;
        }
    }

    [[nodiscard]] const Runs& of(const Condition& condition, const std::string& problem) const {
        static const Runs none;
        const auto found = runs_.find({name_of(condition), problem});
        return found == runs_.end() ? none : found->second;
    }

 private:
    std::map<Place, Runs> runs_;
};

/// Names of a group's problems.
std::vector<std::string> names_of(const AwarenessSettings& settings, ProblemGroup group) {
    std::vector<std::string> names;
    for (const StudyProblem& each : settings.problems) {
        if (each.group == group) {
            names.push_back(each.problem.name);
        }
    }
    return names;
}

Quantiles quantiles_of(const std::vector<double>& values) {
    return {quantile(values, 0.25), quantile(values, 0.5), quantile(values, 0.75), quantile(values, 0.95)};
}

double fresh_share(const AwarenessRow& row) {
    return static_cast<double>(row.fresh->failures) / static_cast<double>(row.fresh->worlds);
}

/// @param problems whose runs are joined; more than one share a cell
AwarenessCell cell_of(const RowIndex& index, const AwarenessFigures& figures, const Condition& condition,
                      ProblemGroup group, const std::vector<std::string>& problems) {
    AwarenessCell cell;
    cell.condition = condition;
    cell.group = group;
    std::size_t planned = 0, executed = 0, fails = 0, flown = 0, unreliable = 0;
    std::vector<double> ratios, clearances_m, candidates_s, certificates_s, walls_s;
    std::vector<std::vector<double>> shares;
    for (const std::string& problem : problems) {
        std::vector<double>& of_problem = shares.emplace_back();
        const auto best = figures.best.find({problem, condition.robot});
        for (const auto& [seed, row] : index.of(condition, problem)) {
            ++cell.attempted;
            candidates_s.push_back(row->first_candidate_s.value_or(infinity));
            certificates_s.push_back(row->first_certified_s.value_or(infinity));
            walls_s.push_back(row->wall_s);
            cell.discarded += row->discarded;
            if (!row->has_plan()) {
                ++cell.missed[row->missed.empty() ? std::string(name_of(row->status)) : row->missed];
                continue;
            }
            ++planned;
            if (row->executed) {
                ++executed;
                fails += row->holds() ? 0 : 1;
            }
            if (row->fresh) {
                ++flown;
                of_problem.push_back(fresh_share(*row));
                unreliable += fresh_share(*row) > max_fresh_failures ? 1 : 0;
            }
            if (row->holds()) {
                ratios.push_back(row->executed->cost / best->second.cost);
                clearances_m.push_back(row->executed->min_clearance_m);
            }
        }
    }
    cell.planned = exact_share(planned, cell.attempted);
    cell.fails = exact_share(fails, executed);
    cell.fresh_failures = bootstrap_mean(shares);
    cell.unreliable = exact_share(unreliable, flown);
    cell.cost_ratio = quantiles_of(ratios);
    cell.clearance_m = quantiles_of(clearances_m);
    cell.first_candidate_s = quantiles_of(candidates_s);
    cell.first_certified_s = quantiles_of(certificates_s);
    cell.wall_s = quantiles_of(walls_s);
    return cell;
}

bool is_event(Metric metric) {
    return metric == Metric::reach || metric == Metric::fails || metric == Metric::unreliable;
}

bool is_ratio(Metric metric) {
    return metric == Metric::cost || metric == Metric::candidate_time || metric == Metric::certificate_time;
}

bool is_time(Metric metric) {
    return metric == Metric::candidate_time || metric == Metric::certificate_time;
}

/// Whether something happened in a run; empty where the run cannot tell.
std::optional<bool> event_of(Metric metric, const AwarenessRow& row) {
    switch (metric) {
        case Metric::reach:
            return row.has_plan();
        case Metric::fails:
            return row.has_plan() && row.executed ? std::optional(!row.holds()) : std::nullopt;
        default:
            return row.has_plan() && row.fresh ? std::optional(fresh_share(row) > max_fresh_failures) : std::nullopt;
    }
}

/// A figure of a run; empty where there is none. Times are infinite where what they wait for did not come.
std::optional<double> figure_of(Metric metric, const AwarenessRow& row) {
    switch (metric) {
        case Metric::cost:
            return row.holds() ? std::optional(row.executed->cost) : std::nullopt;
        case Metric::clearance:
            return row.holds() && std::isfinite(row.executed->min_clearance_m)
                       ? std::optional(row.executed->min_clearance_m)
                       : std::nullopt;
        case Metric::candidate_time:
            return row.first_candidate_s.value_or(infinity);
        case Metric::certificate_time:
            return row.first_certified_s.value_or(infinity);
        default:
            return row.has_plan() && row.fresh ? std::optional(fresh_share(row)) : std::nullopt;
    }
}

/// The pairs of a comparison. @param visit called with the runs of one seed
template <class Visit>
void for_each_pair(const RowIndex& index, const Comparison& comparison, const std::string& problem,
                   const Visit& visit) {
    const Runs& second = index.of(comparison.second, problem);
    for (const auto& [seed, row] : index.of(comparison.first, problem)) {
        if (const auto other = second.find(seed); other != second.end()) {
            visit(*row, *other->second);
        }
    }
}

void compare_events(const RowIndex& index, const std::vector<std::string>& problems, Comparison& comparison) {
    PairCounts& counts = comparison.counts;
    for (const std::string& problem : problems) {
        for_each_pair(index, comparison, problem, [&](const AwarenessRow& a, const AwarenessRow& b) {
            const std::optional<bool> first = event_of(comparison.metric, a), second = event_of(comparison.metric, b);
            if (!first || !second) {
                ++comparison.left_out;
                return;
            }
            std::size_t& count =
                *first ? (*second ? counts.both : counts.first_only) : (*second ? counts.second_only : counts.neither);
            ++count;
        });
    }
    comparison.pairs = counts.pairs();
    comparison.effect = risk_difference(counts);
    comparison.odds = matched_odds_ratio(counts);
    comparison.p = mcnemar_p(counts);
}

void compare_figures(const RowIndex& index, const std::vector<std::string>& problems, Comparison& comparison) {
    std::vector<double> first_values, second_values, changes;
    for (const std::string& problem : problems) {
        for_each_pair(index, comparison, problem, [&](const AwarenessRow& a, const AwarenessRow& b) {
            const std::optional<double> first = figure_of(comparison.metric, a);
            const std::optional<double> second = figure_of(comparison.metric, b);
            if (!first || !second || (std::isinf(*first) && std::isinf(*second))) {
                ++comparison.left_out;
                return;
            }
            first_values.push_back(*first);
            second_values.push_back(*second);
            if (std::isfinite(*first) && std::isfinite(*second)) {
                changes.push_back(is_ratio(comparison.metric) ? *first / *second : *first - *second);
            }
        });
    }
    comparison.pairs = first_values.size();
    if (is_ratio(comparison.metric)) {
        comparison.effect = ratio_of(changes);
        for (double& change : changes) {
            change = std::log(change);
        }
    } else {
        comparison.effect = shift_of(changes);
    }
    // What never comes is later than anything that comes: such pairs have a sign and no size.
    const Pairing pairing = compare_pairs(first_values, second_values);
    comparison.p = is_time(comparison.metric) ? pairing.sign_test_p : signed_rank_p(changes);
}

void compare(const RowIndex& index, const AwarenessSettings& settings, Comparison& comparison) {
    const std::vector<std::string> problems =
        comparison.problem.empty() ? names_of(settings, comparison.group) : std::vector{comparison.problem};
    comparison.fewest = problems.empty() ? 0 : std::numeric_limits<std::size_t>::max();
    for (const std::string& problem : problems) {
        std::size_t pairs = 0;
        for_each_pair(index, comparison, problem, [&](const AwarenessRow&, const AwarenessRow&) { ++pairs; });
        comparison.fewest = std::min(comparison.fewest, pairs);
    }
    if (is_event(comparison.metric)) {
        compare_events(index, problems, comparison);
    } else {
        compare_figures(index, problems, comparison);
    }
}

/// Adjusts the p values of the claims that have data, and of all other comparisons that have some.
void adjust(std::vector<Comparison>& comparisons, bool claims) {
    std::vector<double> p_values;
    std::vector<Comparison*> adjusted;
    for (Comparison& comparison : comparisons) {
        if (comparison.is_claim == claims && comparison.pairs > 0) {
            p_values.push_back(comparison.p);
            adjusted.push_back(&comparison);
        }
    }
    const std::vector<double> together = holm_adjusted(p_values);
    for (std::size_t i = 0; i < adjusted.size(); ++i) {
        adjusted[i]->p_adjusted = together[i];
    }
}

/// Declares comparisons one after the other.
class Declaration {
 public:
    explicit Declaration(const AwarenessSettings& settings) : settings_(settings) {}

    void add(const Condition& first, const Condition& second, ProblemGroup group, const std::vector<Metric>& metrics,
             bool is_claim, const std::string& problem = {}) {
        if (!flies(first.robot, group) || names_of(settings_, group).empty()) {
            return;
        }
        for (const Metric metric : metrics) {
            Comparison comparison;
            comparison.first = first;
            comparison.second = second;
            comparison.group = group;
            comparison.problem = problem;
            comparison.metric = metric;
            comparison.is_claim = is_claim;
            all_.push_back(comparison);
        }
    }

    /// mp-arm-ada against both others, and mp-arm-da against mp-arm. Only the former are claims.
    void add_levels(Condition condition, ProblemGroup group, const std::vector<Metric>& metrics, bool are_claims,
                    const std::string& problem = {}) {
        using enum Variant;
        for (const auto& [first, second] :
             {std::pair{mp_arm_ada, mp_arm_da}, {mp_arm_ada, mp_arm}, {mp_arm_da, mp_arm}}) {
            Condition other = condition;
            condition.level = first;
            other.level = second;
            add(condition, other, group, metrics, are_claims && first == mp_arm_ada, problem);
        }
    }

    [[nodiscard]] std::vector<Comparison> take() { return std::move(all_); }

 private:
    const AwarenessSettings& settings_;
    std::vector<Comparison> all_;
};

const std::vector<Metric> metrics_of_first{Metric::reach, Metric::fails, Metric::unreliable, Metric::cost,
                                           Metric::candidate_time};
const std::vector<Metric> metrics_of_certified{Metric::reach, Metric::certificate_time, Metric::cost, Metric::clearance,
                                               Metric::fresh_failures};

Condition certified_plans(double time_limit_s, RobotChoice robot = RobotChoice::own) {
    return {PlanKind::reported, Variant::mp_arm_ada, Asked::certified, true, robot, time_limit_s};
}

std::map<std::pair<std::string, RobotChoice>, BestKnown> best_known(const std::vector<AwarenessRow>& rows) {
    std::map<std::pair<std::string, RobotChoice>, BestKnown> best;
    for (const AwarenessRow& row : rows) {
        if (!row.holds()) {
            continue;
        }
        const auto [place, is_new] = best.try_emplace({row.problem, row.condition.robot});
        if (is_new || row.executed->cost < place->second.cost) {
            place->second = {row.executed->cost, row.condition};
        }
    }
    return best;
}

}  // namespace

std::string_view name_of(Metric metric) {
    static constexpr std::array<std::string_view, 8> names{"has a plan",
                                                           "fails in the nominal world",
                                                           "fails in more than 1 % of fresh worlds",
                                                           "share of fresh worlds in which it fails",
                                                           "executed cost",
                                                           "clearance [m]",
                                                           "time to the first candidate",
                                                           "time to the first certificate"};
    return names.at(static_cast<std::size_t>(metric));
}

std::string_view verdict_of(const Comparison& comparison) {
    constexpr double level = 0.05;
    if (comparison.pairs == 0) {
        return "no data";
    }
    if (!(comparison.p_adjusted < level)) {
        return "no difference shown";
    }
    double sign = is_ratio(comparison.metric) ? comparison.effect.value - 1 : comparison.effect.value;
    if (is_time(comparison.metric) && !std::isfinite(sign)) {
        sign = 0;  // where one of both never comes, the shares of runs that come say which
    }
    if (sign == 0 || std::isnan(sign)) {
        return "a difference, see its pairs";
    }
    const bool is_more_better = comparison.metric == Metric::reach || comparison.metric == Metric::clearance;
    return (sign > 0) == is_more_better ? "first better" : "second better";
}

std::vector<Comparison> declared_comparisons(const AwarenessSettings& settings) {
    using enum Asked;
    Declaration declared(settings);
    for (const ProblemGroup group : all_problem_groups) {
        for (const RobotChoice robot : all_robot_choices) {
            for (const Asked asked : {nominal, worlds}) {
                declared.add_levels({PlanKind::first, {}, asked, false, robot, 10}, group, metrics_of_first, true);
            }
            declared.add_levels(certified_plans(1, robot), group, metrics_of_certified, robot == RobotChoice::own);
        }
        declared.add_levels(certified_plans(10), group, metrics_of_certified, false);
        // What checking, worlds and certificates change for each level.
        for (const Variant level : all_variants) {
            for (const Asked asked : all_asked) {
                Condition with{PlanKind::reported, level, asked, true, RobotChoice::own, 1}, without = with;
                without.checks = false;
                declared.add(with, without, group, {Metric::reach, Metric::fails, Metric::unreliable, Metric::cost},
                             false);
            }
            for (const auto& [more, less] : {std::pair{worlds, nominal}, {Asked::certified, worlds}}) {
                declared.add({PlanKind::reported, level, more, true, RobotChoice::own, 1},
                             {PlanKind::reported, level, less, true, RobotChoice::own, 1}, group,
                             {Metric::reach, Metric::unreliable, Metric::cost}, false);
            }
        }
    }
    for (const StudyProblem& each : settings.problems) {
        declared.add_levels(certified_plans(1), each.group, {Metric::reach, Metric::certificate_time, Metric::cost},
                            false, each.problem.name);
    }
    return declared.take();
}

AwarenessFigures awareness_figures(const AwarenessSettings& settings, const std::vector<AwarenessRow>& rows) {
    AwarenessFigures figures;
    figures.version = version();
    figures.commit = source_commit();
    figures.processor = processor();
    for (const AwarenessRow& row : rows) {
        if (row.commit != figures.commit) {
            figures.other_commits.insert(row.commit);
        }
    }
    figures.planned = tasks_of(settings).size();
    figures.done = figures.planned - missing_tasks(settings, {}, rows).size();
    figures.best = best_known(rows);
    const RowIndex index(rows);
    for (const CellLine& line : settings.lines) {
        for (const Condition& condition : conditions_of(line)) {
            for (const ProblemGroup group : line.groups) {
                const std::vector<std::string> problems = names_of(settings, group);
                if (problems.empty() || !flies(condition.robot, group)) {
                    continue;
                }
                figures.cells.push_back(cell_of(index, figures, condition, group, problems));
                for (const std::string& problem : problems) {
                    figures.by_problem.push_back(cell_of(index, figures, condition, group, {problem}));
                    figures.by_problem.back().problem = problem;
                }
            }
        }
    }
    figures.comparisons = declared_comparisons(settings);
    for (Comparison& comparison : figures.comparisons) {
        compare(index, settings, comparison);
    }
    adjust(figures.comparisons, true);
    adjust(figures.comparisons, false);
    return figures;
}

}  // namespace downwash::bench
