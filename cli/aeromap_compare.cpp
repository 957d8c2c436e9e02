#include <fmt/core.h>

#include <cmath>
#include <string>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/measured_data.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/fitting/effect_comparison.hpp"

namespace downwash::cli {
namespace {

constexpr double max_factor = 2;
constexpr char explanation[] =
    "An error is the model's thrust ratio K minus the measured one; K is clamped to [1, 2] as in flight. A positive\n"
    "error overstates the effect, a negative one understates it. Under a ceiling, overstating is careful: the plan\n"
    "expects more suction than there is, and only overrates the energy that suction saves. Over the ground,\n"
    "overstating is optimistic: the plan counts on lift, stiffness and savings that do not exist. Understating has\n"
    "the opposite consequences.\n";

struct CompareArguments {
    MeasuredData data;
    bool as_json = false, as_markdown = false;
};

Json parameters_json(const ModelScore& score) {
    auto parameters = Json::object();
    const auto& known = info(score.effect.model).parameters;
    for (std::size_t i = 0; i < known.size(); ++i) {
        parameters[std::string(known[i].name)] = score.effect.parameters[i];
    }
    return parameters;
}

Json score_json(const ModelScore& score) {
    auto bands = Json::array();
    for (const ErrorBand& band : score.bands) {
        bands.push_back({{"z_over_r_low", band.z_low},
                         {"z_over_r_high", std::isfinite(band.z_high) ? Json(band.z_high) : Json()},
                         {"n", band.points},
                         {"mean_error", band.points > 0 ? Json(band.mean_error) : Json()}});
    }
    return {{"model", info(score.effect.model).name},
            {"refitted", score.is_refitted},
            {"at_bound", score.is_at_bound},
            {"parameters", parameters_json(score)},
            {"rmse", score.rmse},
            {"bands", std::move(bands)}};
}

Json comparison_json(const std::vector<DataSetComparison>& comparisons) {
    auto sets = Json::array();
    for (const DataSetComparison& set : comparisons) {
        auto models = Json::array();
        for (const ModelScore& score : set.scores) {
            models.push_back(score_json(score));
        }
        sets.push_back({{"source", set.source},
                        {"surface", set.surface},
                        {"n", set.points},
                        {"z_over_r", {set.z_low, set.z_high}},
                        {"models", std::move(models)}});
    }
    return {{"data_sets", std::move(sets)}};
}

std::string title_of(const DataSetComparison& set) {
    std::string title = set.source;
    if (!set.surface.empty()) {
        title += (title.empty() ? "" : ", ") + set.surface;
    }
    return fmt::format("{}: {} measurements, z/R {} to {}", title.empty() ? "all" : title, set.points,
                       to_text(set.z_low), to_text(set.z_high));
}

std::string parameters_text(const ModelScore& score) {
    std::string text;
    const auto& known = info(score.effect.model).parameters;
    for (std::size_t i = 0; i < known.size(); ++i) {
        text += (i > 0 ? ", " : "") + std::string(known[i].name) + " " + to_text(score.effect.parameters[i], 4);
    }
    return text + (score.is_at_bound ? " (at a bound)" : score.is_refitted ? " (refitted)" : "");
}

std::string band_name(const ErrorBand& band) {
    if (!std::isfinite(band.z_high)) {
        return "from " + to_text(band.z_low);
    }
    return band.z_low == 0 ? "below " + to_text(band.z_high) : to_text(band.z_low) + " to " + to_text(band.z_high);
}

std::string error_text(const ErrorBand& band) {
    return band.points > 0 ? fmt::format("{:+.3f}", band.mean_error) : "-";
}

void print_text(const DataSetComparison& set) {
    const auto print_row = [](std::string_view model, const std::string& parameters, const std::string& rmse,
                              const ModelScore& score, const auto& text_of) {
        fmt::print("{:<18} {:<42} {:>6}", model, parameters, rmse);
        for (const ErrorBand& band : score.bands) {
            fmt::print(" {:>9}", text_of(band));
        }
        fmt::print("\n");
    };
    fmt::print("\n{}\n", title_of(set));
    print_row("model", "parameters", "RMSE", set.scores.front(), band_name);
    for (const ModelScore& score : set.scores) {
        print_row(info(score.effect.model).name, parameters_text(score), fmt::format("{:.4f}", score.rmse), score,
                  error_text);
    }
}

void print_markdown(const DataSetComparison& set) {
    fmt::print("\n**{}**\n\n| model | parameters | RMSE |", title_of(set));
    for (const ErrorBand& band : set.scores.front().bands) {
        fmt::print(" {} |", band_name(band));
    }
    fmt::print("\n| --- | --- | ---: |");
    for (std::size_t i = 0; i < set.scores.front().bands.size(); ++i) {
        fmt::print(" ---: |");
    }
    for (const ModelScore& score : set.scores) {
        fmt::print("\n| `{}` | {} | {:.4f} |", info(score.effect.model).name, parameters_text(score), score.rmse);
        for (const ErrorBand& band : score.bands) {
            fmt::print(" {} |", error_text(band));
        }
    }
    fmt::print("\n");
}

ExitCode run(const CompareArguments& given) {
    if (given.as_json && given.as_markdown) {
        throw UsageError("--json and --markdown: expected at most one of them");
    }
    const std::vector<DataSetComparison> comparisons =
        compare_effects(given.data.read(), given.data.neighbours(), max_factor);
    if (given.as_json) {
        print_json(comparison_json(comparisons));
        return ExitCode::done;
    }
    fmt::print("{}", explanation);
    for (const DataSetComparison& set : comparisons) {
        given.as_markdown ? print_markdown(set) : print_text(set);
    }
    return ExitCode::done;
}

}  // namespace

void add_aeromap_compare(CLI::App& aeromap, Action& action) {
    auto [command, given] =
        add_command(aeromap, action, "compare",
                    "Compare all models with measurements, each with the parameters of its source and refitted", run);
    given.data.add_options(command);
    add_json(command, given.as_json);
    command.add_flag("--markdown", given.as_markdown, "Markdown instead of text; tables");
}

}  // namespace downwash::cli
