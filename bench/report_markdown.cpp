#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "downwash/base/text.hpp"
#include "downwash/bench/campaign_report.hpp"
#include "downwash/bench/campaign_schema.hpp"

namespace downwash::bench {
namespace {

std::string share_text(const Share& share) {
    return fmt::format("{}/{} [{:.1f}, {:.1f} %]", share.hits, share.attempts, 100 * share.low, 100 * share.high);
}

std::string number_text(double value, const char* unit = "") {
    if (!std::isfinite(value)) {
        return "none";
    }
    value += 0.0;  // no "-0"
    return std::abs(value) >= 1000 ? fmt::format("{:.0f}{}", value, unit) : fmt::format("{:.3g}{}", value, unit);
}

std::string seconds_text(double seconds) {
    return seconds < 1 ? number_text(1e3 * seconds, " ms") : number_text(seconds, " s");
}

std::string clearance_text(double clearance_m) {
    return std::isfinite(clearance_m) ? to_fixed_text(clearance_m, 3) + " m" : "none";
}

std::string cost_text(const Spread& cost) {
    if (!std::isfinite(cost.low_quartile)) {
        return "none";
    }
    return fmt::format("{} [{}, {}]", number_text(cost.median), number_text(cost.low_quartile),
                       number_text(cost.high_quartile));
}

std::string p_text(double p) {
    return p < 0.0001 ? "< 0.0001" : fmt::format("{:.2g}", p);
}

/// Text for a cell of a table.
std::string in_cell(std::string text) {
    for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) {
        text.insert(at, "\\");
    }
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

/// The price of a safe margin.
const char* reach_text(const std::optional<SafeMargin>& alone, const std::optional<Share>& when_safe_everywhere) {
    if (alone && alone->solved.hits == 0) {
        return "**out of reach before it is safe**";
    }
    if (!when_safe_everywhere || when_safe_everywhere->hits == when_safe_everywhere->attempts) {
        return "";
    }
    return when_safe_everywhere->hits == 0 ? "**no longer reached**" : "no longer always reached";
}

/// ", 0.12 to 0.4 m from the goal region", if that is known.
std::string distance_text(const std::vector<double>& distances_m) {
    if (distances_m.empty()) {
        return "";
    }
    const auto [min, max] = std::minmax_element(distances_m.begin(), distances_m.end());
    return fmt::format(", {:.3g} to {:.3g} m from the goal region", *min, *max);
}

class Document {
 public:
    explicit Document(const CampaignReport& report) : report_(report), plan_(report.plan) {}

    [[nodiscard]] std::string written() {
        head();
        targets();
        margins();
        flights();
        totals();
        worlds();
        first_solutions();
        costs();
        comparisons();
        failures();
        machines();
        return text_;
    }

 private:
    template <class... Arguments>
    void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        text_ += fmt::format(format, std::forward<Arguments>(arguments)...);
    }

    /// A row of a table: text, numbers, or the name of a problem or planner.
    template <class... Cells>
    void row(const Cells&... cells) {
        ((text_ += fmt::format("| {} ", cells)), ...);
        text_ += "|\n";
    }
    void heads(const std::vector<std::string>& names) {
        std::string line;
        for (const std::string& name : names) {
            text_ += "| " + name + " ";
            line += "|---";
        }
        text_ += "|\n" + line + "|\n";
    }

    [[nodiscard]] std::string setting(std::string_view name) const {
        const std::string value = bench::setting(plan_, name);
        return value.empty() ? "unknown" : value;
    }
    [[nodiscard]] std::string experiment(std::size_t number) const { return in_cell(plan_.experiments[number].name()); }
    [[nodiscard]] std::string planner(std::size_t number) const { return in_cell(plan_.planners[number].name()); }

    /// The settings of merged shards name no processor.
    [[nodiscard]] std::string processors() const {
        const std::size_t models = report_.processor_models();
        const std::string named = bench::setting(plan_, "processor");
        return !named.empty() ? named
               : models == 1  ? report_.machines.front().machine.processor
               : models == 0  ? "unknown processor"
                              : fmt::format("{} models of processors", models);
    }

    void head() {
        add("# Campaign {}\n\n", setting("campaign"));
        if (setting("description") != "none") {
            add("{}\n\n", setting("description"));
        }
        const std::string stop = plan_.stop_at_first_solution ? ", until the first solution" : "";
        const std::string limit = plan_.time_limit_s ? number_text(*plan_.time_limit_s, " s") : "no time limit";
        const std::string iterations = setting("max_iterations");
        add("Downwash {} at commit {}; {}; {} search{} at a time with one thread each; {} per search{}{}; seeds {}.\n",
            setting("version"), setting("commit"), processors(), setting("jobs"), setting("jobs") == "1" ? "" : "es",
            limit, iterations == "none" ? std::string() : ", " + iterations + " iterations", stop, setting("seeds"));
        add("{} of {} runs done{}\n\n", report_.done, plan_.run_count(),
            report_.done < plan_.run_count() ? ": **the campaign is not finished**, the figures are of the runs so far."
                                             : ".");
        add("Shares are of all attempted seeds, with 95 % Wilson intervals (Wilson 1927). Quantiles are over all "
            "attempted seeds too: a seed without a value\ncounts as infinite; `none` is a quantile of that kind.\n\n");
        if (report_.processor_models() > 1) {
            add("**The times below are of {} models of processors together**, listed under Machines. Do not compare "
                "them "
                "with other times; compare planners by\ntheir pairs, which are of equal seeds but not of equal "
                "processors either.\n\n",
                report_.processor_models());
        }
        for (const std::string& what : plan_.left_out) {
            add("Left out, since it does not exist: {}\n\n", what);
        }
    }

    void targets() {
        if (report_.targets.empty()) {
            return;
        }
        add("## Targets\n\n");
        heads({"problem", "planner", "target", "found", ""});
        for (const TargetResult& of : report_.targets) {
            row(experiment(of.experiment), planner(of.planner), of.target, of.found, of.is_met ? "kept" : "**missed**");
        }
        add("\n");
    }

    void flights() {
        add("## Success and flights\n\n`failed flight`: the reported plan, executed with direct aerodynamics, "
            "collided, "
            "left the flyable area, became unstable or missed the goal,\nhovering there included. `discarded`: plans "
            "that failed in the same way, came nearer than the margin, got no certificate or were being\nexecuted when "
            "the time was over, and were not reported. The minimum clearance is over the flights of all solved "
            "seeds.\n\n");
        heads({"problem", "planner", "solved", "failed flight", "solved and held", "failures by cause",
               "minimum clearance", "discarded"});
        for (const CellFigures& cell : report_.cells) {
            std::string causes;
            for (const auto& [cause, count] : cell.failures_by_cause) {
                causes += fmt::format("{}{} {}", causes.empty() ? "" : ", ", cause, count);
            }
            row(experiment(cell.experiment), planner(cell.planner), share_text(cell.solved),
                share_text(cell.failed_flights), share_text(cell.held), causes, clearance_text(cell.min_clearance_m),
                cell.discarded);
        }
        add("\n");
    }

    void totals() {
        if (plan_.experiments.size() < 2) {
            return;
        }
        add("All problems together:\n\n");
        heads({"planner", "solved", "failed flight", "solved and held", "discarded"});
        for (const PlannerTotals& all : report_.totals) {
            row(planner(all.planner), share_text(all.solved), share_text(all.failed_flights), share_text(all.held),
                all.discarded);
        }
        add("\n");
    }

    void worlds() {
        if (!report_.has_worlds()) {
            return;
        }
        add("## In other worlds\n\n`failed`: flights of the reported plans in {} worlds of their problem's "
            "uncertainty, "
            "the same for all plans of a problem, which no search has seen;\npooled over the seeds, with the 95 % "
            "interval of Clopper and Pearson (1934) as if all flights were independent. `certified`: seeds whose plan "
            "passed\nthe test for a certificate. `first certified`: the time to the first such plan of a planner that "
            "asks for certificates while it searches.\n\n",
            plan_.evaluation_worlds);
        heads({"problem", "planner", "plans flown", "failed", "certified", "first certified, median", "95 %"});
        for (const CellFigures& cell : report_.cells) {
            worlds_row(experiment(cell.experiment), cell.planner, cell.in_worlds);
        }
        if (plan_.experiments.size() > 1) {
            for (const PlannerTotals& all : report_.totals) {
                worlds_row("all", all.planner, all.in_worlds);
            }
        }
        add("\n");
        parameters();
    }

    void worlds_row(const std::string& problem, std::size_t planner_number, const WorldsFigures& figures) {
        row(problem, planner(planner_number), figures.flown, figures.flown > 0 ? share_text(figures.failed) : "none",
            figures.tested > 0 ? share_text(figures.certified) : "not tested",
            seconds_text(figures.first_certified_s.median), seconds_text(figures.first_certified_s.quantile_95));
    }

    /// The parameters that make plans fail alone.
    void parameters() {
        if (plan_.evaluation_worlds == 0) {
            return;
        }
        add("One parameter alone at its 2 % or 98 % quantile, all else nominal, without noise and gusts: plans "
            "that "
            "fail, of those whose flight held\nin the nominal world. Parameters that let no plan fail are left "
            "out.\n\n");
        bool is_first = true;
        for (const CellFigures& cell : report_.cells) {
            for (const ParameterFigures& of : cell.in_worlds.alone) {
                if (of.failed_low + of.failed_high > 0) {
                    if (std::exchange(is_first, false)) {
                        heads({"problem", "planner", "parameter", "at 2 %", "at 98 %"});
                    }
                    row(experiment(cell.experiment), planner(cell.planner), of.parameter,
                        fmt::format("{}/{}", of.failed_low, of.plans), fmt::format("{}/{}", of.failed_high, of.plans));
                }
            }
        }
        if (is_first) {
            add("None lets a plan fail.\n");
        }
        add("\n");
    }

    void first_solutions() {
        add("## Time to the first solution\n\nThe time starts with the parsed problem and includes its checks and the "
            "map "
            "from the cache. It ends with the first plan that the planner\naccepts; `verified`: with the first plan "
            "that has passed all checks; `whole run`: with "
            "the\nend "
            "of the run, the flight of the reported plan included.\n\n");
        heads({"problem", "planner", "25 %", "median", "75 %", "95 %", "verified, median", "95 %", "whole run, median",
               "95 %"});
        for (const CellFigures& cell : report_.cells) {
            const Spread& first = cell.first_solution_s;
            row(experiment(cell.experiment), planner(cell.planner), seconds_text(first.low_quartile),
                seconds_text(first.median), seconds_text(first.high_quartile), seconds_text(first.quantile_95),
                seconds_text(cell.verified_s.median), seconds_text(cell.verified_s.quantile_95),
                seconds_text(cell.answer_s.median), seconds_text(cell.answer_s.quantile_95));
        }
        add("\n");
    }

    void costs() {
        add("## Cost\n\nMedian [quartiles]. `executed`: cost of the reported plan's flight, if it hovers at the goal, "
            "and "
            "the `minimum` of these; before that, the cost of the\nbest plan so far: executed or, without "
            "check_execution, planned by what the variant knows.\n\n");
        std::vector<std::string> names{"problem", "planner"};
        for (const CostAt& at : report_.cells.empty() ? std::vector<CostAt>() : report_.cells.front().cost_over_time) {
            names.push_back(seconds_text(at.time_s));
        }
        names.insert(names.end(), {"executed", "minimum"});
        heads(names);
        for (const CellFigures& cell : report_.cells) {
            std::string over_time;
            for (const CostAt& at : cell.cost_over_time) {
                over_time += cost_text(at.cost) + " | ";
            }
            row(experiment(cell.experiment), planner(cell.planner), over_time + cost_text(cell.flown_cost),
                number_text(cell.flown_cost.min));
        }
        add("\n");
    }

    void margins() {
        if (report_.margins.empty()) {
            return;
        }
        add("## Inflated obstacles\n\nThe minimum safety margin from which on no flight failed, and the goals that are "
            "reached with it.\n\n");
        for (const MarginFinding& finding : report_.margins) {
            add("**{}**: ", finding.planner.name());
            if (finding.safe_margin_m) {
                add("safe on all problems from a margin of {} on, with which it solves:\n\n",
                    number_text(*finding.safe_margin_m, " m"));
            } else {
                add("no margin that was tried is safe on all problems.\n\n");
            }
            heads({"problem", "safe there from", "solved with that margin",
                   "solved with the margin that is safe everywhere", ""});
            for (std::size_t e = 0; e < plan_.experiments.size(); ++e) {
                const auto& alone = finding.alone[e];
                const auto everywhere =
                    e < finding.solved_when_safe.size() ? std::optional(finding.solved_when_safe[e]) : std::nullopt;
                row(experiment(e), alone ? number_text(alone->margin_m, " m") : "no margin tried",
                    alone ? share_text(alone->solved) : "none", everywhere ? share_text(*everywhere) : "none",
                    reach_text(alone, everywhere));
            }
            add("\n");
        }
    }

    void comparisons() {
        if (report_.comparisons.empty()) {
            return;
        }
        add("## Paired comparisons\n\nOn equal seeds. `smaller`: the number of seeds on which the first or the second "
            "planner has the smaller value; a missing value loses\nto any other. p of the two-sided sign test over "
            "them "
            "(Dixon and Mood 1946). Median difference (first - second) over the seeds on which both\nhave a value, "
            "with "
            "the two-sided p of Wilcoxon's signed rank test (Wilcoxon 1945; exact up to 200 pairs, beyond that normal "
            "with tie correction:\nHollander, Wolfe and Chicken 2013, 3.1).\n\n");
        heads({"problem", "first", "second", "measure", "smaller", "equal", "sign test p", "pairs", "median difference",
               "signed rank p"});
        for (const PlannerComparison& c : report_.comparisons) {
            const Pairing& pairs = c.pairing;
            row(experiment(c.experiment), planner(c.first), planner(c.second), c.measure,
                fmt::format("{} : {}", pairs.first_smaller, pairs.second_smaller), pairs.equal,
                p_text(pairs.sign_test_p), pairs.finite, number_text(pairs.median_difference),
                pairs.finite == 0 ? "none" : p_text(pairs.signed_rank_p));
        }
        add("\n");
    }

    void failures() {
        std::size_t count = 0;
        for (const FailureGroup& failure : report_.failures) {
            count += failure.seeds.size();
        }
        add("## Failures\n\n{} of {} runs have no flight that hovers at the goal.\n", count, report_.done);
        for (const FailureGroup& failure : report_.failures) {
            add("{}- {}, {}: {}{}: seeds {}\n", &failure == report_.failures.data() ? "\n" : "",
                plan_.experiments[failure.experiment].name(), plan_.planners[failure.planner].name(),
                in_cell(failure.cause), distance_text(failure.nearest_approach_m), seeds_text(failure.seeds));
        }
    }

    void machines() {
        if (report_.machines.empty()) {
            return;
        }
        constexpr std::size_t max_rows = 50;
        add("\n## Machines\n\nWhere the runs were made. `load`: processes that ran or waited to run when a run ended, "
            "mean "
            "of the last minute.\n\n");
        heads({"host", "processor", "instruction set", "runs", "median load", "maximum load"});
        for (std::size_t i = 0; i < std::min(report_.machines.size(), max_rows); ++i) {
            const MachineFigures& of = report_.machines[i];
            row(in_cell(of.machine.host), in_cell(of.machine.processor), of.machine.instruction_set, of.runs,
                number_text(of.median_load), number_text(of.max_load));
        }
        if (report_.machines.size() > max_rows) {
            add("\nAnd {} more hosts.\n", report_.machines.size() - max_rows);
        }
    }

    const CampaignReport& report_;
    const CampaignPlan& plan_;
    std::string text_;
};

}  // namespace

std::string markdown_of(const CampaignReport& report) {
    return Document(report).written();
}

}  // namespace downwash::bench
