#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "downwash/bench/campaign_report.hpp"
#include "downwash/bench/results_layout.hpp"

namespace downwash::bench {
namespace {

std::string share_text(const Share& share) {
    return fmt::format("{}/{} [{:.1f}, {:.1f} %]", share.hits, share.attempts, 100 * share.low, 100 * share.high);
}

std::string number_text(double value, const char* unit = "") {
    if (!std::isfinite(value)) {
        return "none";
    }
    return std::abs(value) >= 1000 ? fmt::format("{:.0f}{}", value, unit) : fmt::format("{:.3g}{}", value, unit);
}

std::string seconds_text(double seconds) {
    return seconds < 1 ? number_text(1e3 * seconds, " ms") : number_text(seconds, " s");
}

std::string clearance_text(double clearance_m) {
    return std::isfinite(clearance_m) ? fmt::format("{:.3f} m", clearance_m) : "none";
}

std::string p_text(double p) {
    return p < 0.0001 ? "< 0.0001" : fmt::format("{:.2g}", p);
}

/// What stands within a cell of a table.
std::string in_cell(std::string text) {
    for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) {
        text.insert(at, "\\");
    }
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

/// What a margin costs that is safe.
const char* reach_text(const std::optional<SafeMargin>& alone, const std::optional<Share>& when_safe_everywhere) {
    if (alone && alone->solved.hits == 0) {
        return "**out of reach before it is safe**";
    }
    if (!when_safe_everywhere || when_safe_everywhere->hits == when_safe_everywhere->attempts) {
        return "";
    }
    return when_safe_everywhere->hits == 0 ? "**no longer reached**" : "no longer always reached";
}

/// ", 0.12 to 0.4 m from the goal region", where that is known.
std::string distance_text(const std::vector<double>& distances_m) {
    if (distances_m.empty()) {
        return "";
    }
    const auto [least, most] = std::minmax_element(distances_m.begin(), distances_m.end());
    return fmt::format(", {:.3g} to {:.3g} m from the goal region", *least, *most);
}

class Document {
 public:
    explicit Document(const CampaignReport& report) : report_(report), plan_(report.plan) {}

    [[nodiscard]] std::string written() {
        head();
        bars();
        margins();
        flights();
        first_solutions();
        costs();
        comparisons();
        failures();
        return text_;
    }

 private:
    template <class... Arguments>
    void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        text_ += fmt::format(format, std::forward<Arguments>(arguments)...);
    }

    [[nodiscard]] std::string setting(std::string_view name) const {
        const std::string value = bench::setting(plan_, name);
        return value.empty() ? "unknown" : value;
    }

    /// "| problem | planner |" of a row.
    template <class Row>
    [[nodiscard]] std::string place(const Row& row) const {
        return fmt::format("| {} | {} |", in_cell(plan_.experiments[row.experiment].name()),
                           in_cell(plan_.planners[row.planner].name()));
    }

    void head() {
        add("# Campaign {}\n\n", setting("campaign"));
        if (setting("description") != "none") {
            add("{}\n\n", setting("description"));
        }
        const std::string stop = plan_.stop_at_first_solution ? ", stopping at the first solution" : "";
        const std::string limit = plan_.time_limit_s ? number_text(*plan_.time_limit_s, " s") : "no time limit";
        const std::string iterations = setting("max_iterations");
        add("Downwash {} at commit {}; {}; {} search{} at a time, one thread each; {} a search{}{}; seeds {}.\n",
            setting("version"), setting("commit"), setting("processor"), setting("jobs"),
            setting("jobs") == "1" ? "" : "es", limit,
            iterations == "none" ? std::string() : ", " + iterations + " iterations", stop, setting("seeds"));
        add("{} of {} runs done{}\n\n", report_.done, plan_.run_count(),
            report_.done < plan_.run_count() ? ": **the campaign is not finished**, figures are of the runs so far."
                                             : ".");
        add("Shares are of all attempted seeds, with 95 % Wilson intervals (Wilson 1927). Quantiles too are over all "
            "attempted seeds: those without a value\ncount as infinite, `none` where a quantile falls on them.\n\n");
        for (const std::string& what : plan_.left_out) {
            add("Left out, since it does not exist: {}\n\n", what);
        }
    }

    void bars() {
        if (report_.bars.empty()) {
            return;
        }
        add("## Bars\n\n| problem | planner | bar | found | |\n|---|---|---|---|---|\n");
        for (const BarResult& bar : report_.bars) {
            add("{} {} | {} | {} |\n", place(bar), bar.bar, bar.found, bar.is_kept ? "kept" : "**missed**");
        }
        add("\n");
    }

    void flights() {
        add("## Success and flights\n\n`failed flight`: the reported plan, flown with direct aerodynamics and held at "
            "the goal, collided, left the flyable area, became unstable or\nmissed the goal. `discarded`: plans of the "
            "aware planner that failed so, or came nearer than the margin, and were not reported. Least clearance over "
            "the\nflights of all solved seeds.\n\n"
            "| problem | planner | solved | failed flight | solved and held | failures by cause | least clearance | "
            "discarded |\n|---|---|---|---|---|---|---|---|\n");
        for (const CellFigures& cell : report_.cells) {
            std::string causes;
            for (const auto& [cause, count] : cell.failures_by_cause) {
                causes += fmt::format("{}{} {}", causes.empty() ? "" : ", ", cause, count);
            }
            add("{} {} | {} | {} | {} | {} | {} |\n", place(cell), share_text(cell.solved),
                share_text(cell.failed_flights), share_text(cell.held), causes, clearance_text(cell.least_clearance_m),
                cell.discarded);
        }
        add("\n");
        totals();
    }

    void totals() {
        if (plan_.experiments.size() < 2) {
            return;
        }
        add("All problems together:\n\n| planner | solved | failed flight | solved and held | discarded |\n"
            "|---|---|---|---|---|\n");
        for (const PlannerTotals& all : report_.totals) {
            add("| {} | {} | {} | {} | {} |\n", in_cell(plan_.planners[all.planner].name()), share_text(all.solved),
                share_text(all.failed_flights), share_text(all.held), all.discarded);
        }
        add("\n");
    }

    void first_solutions() {
        add("## Time to the first solution\n\nFrom the parsed problem, its checks and the map from the cache included, "
            "to the first plan that the planner accepted; `verified`: to the first plan\nthat may be reported, which "
            "the "
            "aware planner has flown with direct aerodynamics by then; `whole run`: to the end, the reported plan's "
            "flight included.\n\n| problem | planner | 25 % | median | 75 % | 95 % | verified, median | 95 % | "
            "whole run, median | 95 % |\n|---|---|---|---|---|---|---|---|---|---|\n");
        for (const CellFigures& cell : report_.cells) {
            const Spread& first = cell.first_solution_s;
            add("{} {} | {} | {} | {} | {} | {} | {} | {} |\n", place(cell), seconds_text(first.low_quartile),
                seconds_text(first.median), seconds_text(first.high_quartile), seconds_text(first.most),
                seconds_text(cell.verified_s.median), seconds_text(cell.verified_s.most),
                seconds_text(cell.answer_s.median), seconds_text(cell.answer_s.most));
        }
        add("\n");
    }

    static std::string cost_text(const Spread& cost) {
        if (!std::isfinite(cost.low_quartile)) {
            return "none";
        }
        return fmt::format("{} [{}, {}]", number_text(cost.median), number_text(cost.low_quartile),
                           number_text(cost.high_quartile));
    }

    void costs() {
        add("## Cost\n\nMedian [quartiles]. `flown`: of the reported plan's flight, where it held, and the "
            "`least` of them; before it the best plan so far: of the aware planner its flight, of the others "
            "their own figure, which\ndoes not know the same physics.\n\n| problem | planner |");
        const std::vector<CostAt> none;
        const auto& moments = report_.cells.empty() ? none : report_.cells.front().cost_over_time;
        std::string line = "|---|---|";
        for (const CostAt& at : moments) {
            add(" {} |", seconds_text(at.time_s));
            line += "---|";
        }
        add(" flown | least |\n{}---|---|\n", line);
        for (const CellFigures& cell : report_.cells) {
            add("{}", place(cell));
            for (const CostAt& at : cell.cost_over_time) {
                add(" {} |", cost_text(at.cost));
            }
            add(" {} | {} |\n", cost_text(cell.flown_cost),
                std::isfinite(cell.flown_cost.least) ? number_text(cell.flown_cost.least) : "none");
        }
        add("\n");
    }

    void margins() {
        if (report_.margins.empty()) {
            return;
        }
        add("## Inflated obstacles\n\nThe least safety margin from which on no flight failed, and what is reached with "
            "it.\n\n");
        for (const MarginFinding& finding : report_.margins) {
            const std::string who = fmt::format("{} {}", downwash::name_of(finding.variant), finding.algorithm);
            if (!finding.safe_margin_m) {
                add("**{}**: no margin that was tried is safe on all problems.\n\n", who);
            } else {
                add("**{}**: safe on all problems from a margin of {} on, with which it solves:\n\n", who,
                    number_text(*finding.safe_margin_m, " m"));
            }
            add("| problem | safe there from | with which it solves | solved with the margin that is safe everywhere | "
                "|\n|---|---|---|---|---|\n");
            for (std::size_t e = 0; e < plan_.experiments.size(); ++e) {
                const auto& alone = finding.alone[e];
                const bool is_known = e < finding.solved_when_safe.size();
                const Share solved = is_known ? finding.solved_when_safe[e] : Share{};
                add("| {} | {} | {} | {} | {} |\n", in_cell(plan_.experiments[e].name()),
                    alone ? number_text(alone->margin_m, " m") : "no margin tried",
                    alone ? share_text(alone->solved) : "none", is_known ? share_text(solved) : "none",
                    reach_text(alone, is_known ? std::optional(solved) : std::nullopt));
            }
            add("\n");
        }
    }

    void comparisons() {
        if (report_.comparisons.empty()) {
            return;
        }
        add("## Paired comparisons\n\nOn equal seeds. `smaller`: seeds on which the first, or the second, has the "
            "smaller "
            "value, one that has none losing to one that has; p of the two-sided\nsign test over them (Dixon and Mood "
            "1946). Median difference (first - second) over the seeds on which both have a value, with the two-sided p "
            "of Wilcoxon's\nsigned rank test (Wilcoxon 1945; counted out up to 200 pairs, beyond normal with tie "
            "correction: Hollander, Wolfe and Chicken 2013, 3.1).\n\n"
            "| problem | first | second | measure | smaller | equal | sign test p | pairs | median difference | signed "
            "rank p |\n|---|---|---|---|---|---|---|---|---|---|\n");
        for (const PlannerComparison& c : report_.comparisons) {
            const Pairing& pairs = c.pairing;
            add("| {} | {} | {} | {} | {} : {} | {} | {} | {} | {} | {} |\n",
                in_cell(plan_.experiments[c.experiment].name()), in_cell(plan_.planners[c.first].name()),
                in_cell(plan_.planners[c.second].name()), c.measure, pairs.first_smaller, pairs.second_smaller,
                pairs.equal, p_text(pairs.sign_test_p), pairs.finite, number_text(pairs.median_difference),
                pairs.finite == 0 ? "none" : p_text(pairs.signed_rank_p));
        }
        add("\n");
    }

    void failures() {
        std::size_t count = 0;
        for (const FailureGroup& failure : report_.failures) {
            count += failure.seeds.size();
        }
        add("## Failures\n\n{} of {} runs have no flight that held.\n", count, report_.done);
        for (const FailureGroup& failure : report_.failures) {
            add("{}- {}, {}: {}{}: seeds {}\n", &failure == report_.failures.data() ? "\n" : "",
                plan_.experiments[failure.experiment].name(), plan_.planners[failure.planner].name(),
                in_cell(failure.cause), distance_text(failure.nearest_approach_m), seeds_text(failure.seeds));
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
