#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "downwash/bench/uncertainty_study/uncertainty_figures.hpp"

namespace downwash::bench {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

Json share_json(const Share& share) {
    return {{"hits", share.hits}, {"attempts", share.attempts}, {"low", share.low}, {"high", share.high}};
}

Json setup_json(const SetupFigures& of) {
    Json alone = Json::array();
    for (const ParameterFigures& parameter : of.in_worlds.alone) {
        alone.push_back({{"parameter", parameter.parameter},
                         {"plans", parameter.plans},
                         {"failed_low", parameter.failed_low},
                         {"failed_high", parameter.failed_high}});
    }
    return {{"setting", of.setting},
            {"setup", of.setup},
            {"problem", of.problem.empty() ? Json() : Json(of.problem)},
            {"attempted", of.attempted},
            {"planned", share_json(of.planned)},
            {"certified", of.certifies ? share_json(of.in_worlds.certified) : Json()},
            {"flown", of.in_worlds.flown},
            {"failed", share_json(of.in_worlds.failed)},
            {"reliable", share_json(of.reliable)},
            {"cost_ratio_50", number(of.cost_ratio.median)},
            {"pairs", of.pairs},
            {"duration_s_50", number(of.duration_s.median)},
            {"first_solution_s_50", number(of.first_solution_s.median)},
            {"first_certified_s_50", of.certifies ? number(of.in_worlds.first_certified_s.median) : Json()},
            {"alone", alone}};
}

std::string percent(const Share& share) {
    return fmt::format("{:.1f} [{:.1f}, {:.1f}]",
                       100 * static_cast<double>(share.hits) / static_cast<double>(share.attempts), 100 * share.low,
                       100 * share.high);
}

std::string count(const Share& share) {
    return fmt::format("{}/{}", share.hits, share.attempts);
}

std::string value(double number, const char* unit = "") {
    return std::isfinite(number) ? fmt::format("{:.3g}{}", number, unit) : "none";
}

constexpr const char* heads =
    "planned | certified | failed in worlds % | reliable | cost ratio | duration | first plan | first certified |\n";
constexpr const char* rule = "--: | --: | --: | --: | --: | --: | --: | --: |\n";

std::string cells(const SetupFigures& of) {
    return fmt::format("{} | {} | {} | {} | {} ({}) | {} | {} | {} |\n", count(of.planned),
                       of.certifies ? count(of.in_worlds.certified) : "-",
                       of.in_worlds.failed.attempts > 0 ? percent(of.in_worlds.failed) : "none flown",
                       count(of.reliable), value(of.cost_ratio.median), of.pairs, value(of.duration_s.median, " s"),
                       value(of.first_solution_s.median, " s"),
                       of.certifies ? value(of.in_worlds.first_certified_s.median, " s") : "-");
}

/// Setups whose plans are tried one parameter at a time on the page; study.json has all of them.
bool is_tried_alone(const SetupFigures& of) {
    return of.setup == reference_setup || of.certifies;
}

std::string sensitivity(const std::vector<SetupFigures>& setups) {
    std::string text =
        "| setting | problem | setup | plans | parameter | failed at 2 % | failed at 98 % |\n"
        "| --- | --- | --- | --: | --- | --: | --: |\n";
    for (const SetupFigures& of : setups) {
        for (const ParameterFigures& parameter : of.in_worlds.alone) {
            if (is_tried_alone(of) && parameter.failed_low + parameter.failed_high > 0) {
                text += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", of.setting, of.problem, of.setup,
                                    parameter.plans, parameter.parameter, parameter.failed_low, parameter.failed_high);
            }
        }
    }
    return text;
}

}  // namespace

std::string json_of(const StudyFigures& figures) {
    Json document{{"study", "uncertainty"}};
    document["findings"] = Json::array();
    for (const Finding& finding : figures.findings) {
        document["findings"].push_back({{"name", finding.name},
                                        {"thesis", nullptr},
                                        {"measured", finding.measured ? Json(*finding.measured) : Json()},
                                        {"reproduced", finding.is_reproduced},
                                        {"target", finding.target},
                                        {"basis", finding.basis}});
    }
    for (const auto& [name, value] : figures.settings) {
        document["settings"][name] = value;
    }
    document["runs_planned"] = figures.planned;
    document["runs_done"] = figures.done;
    document["setups"] = Json::array();
    for (const std::vector<SetupFigures>* setups : {&figures.setups, &figures.by_problem}) {
        for (const SetupFigures& of : *setups) {
            document["setups"].push_back(setup_json(of));
        }
    }
    return document.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string markdown_of(const StudyFigures& figures) {
    std::string text = "# Study: uncertainty\n\n";
    for (const auto& [name, value] : figures.settings) {
        text += fmt::format("{}{}: {}", &name == &figures.settings.front().first ? "" : "; ", name, value);
    }
    text += fmt::format(
        ".\n{} of {} runs done.\n\n## Findings\n\n| claim | measured | target | counted | |\n"
        "| --- | --: | --- | --- | --- |\n",
        figures.done, figures.planned);
    for (const Finding& finding : figures.findings) {
        text += fmt::format("| {} | {} | {} | {} | {} |\n", finding.name,
                            finding.measured ? value(*finding.measured) : "none", finding.target, finding.basis,
                            finding.is_reproduced ? "kept" : "**missed**");
    }
    text +=
        "\n## Setups\n\nCounts are of searches. `planned`: the planner's own model accepts a plan. `certified`: the "
        "plan "
        "has a certificate for the worlds in which it is then flown;\nonly such plans are reported by these setups. "
        "`failed in worlds`: flights of reported plans in fresh worlds, pooled, with the 95 % interval of Clopper and "
        "Pearson as\nif flights were independent. `reliable`: searches that report a plan which fails in at most 1 % "
        "of "
        "these worlds. `cost ratio`: cost of the flight in the\nnominal world over that of \"" +
        std::string(reference_setup) +
        "\" on the same seed, median (pairs). Times are medians over all searches.\n\n| setting | setup | ";
    text += std::string(heads) + "| --- | --- | " + rule;
    for (const SetupFigures& of : figures.setups) {
        text += fmt::format("| {} | {} | {}", of.setting, of.setup, cells(of));
    }
    text += "\n## By problem\n\n| problem | setting | setup | " + std::string(heads) + "| --- | --- | --- | " + rule;
    for (const SetupFigures& of : figures.by_problem) {
        text += fmt::format("| {} | {} | {} | {}", of.problem, of.setting, of.setup, cells(of));
    }
    text +=
        "\n## One parameter at a time\n\nPlans that fail when one parameter alone is at its 2 % or 98 % quantile, "
        "without noise and gusts, of those whose flight holds in the nominal world.\nOnly pairs that let a plan "
        "fail "
        "are listed.\n\n";
    return text + sensitivity(figures.by_problem);
}

}  // namespace downwash::bench
