#include <fmt/core.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/cli/commands.hpp"
#include "downwash/cli/json_text.hpp"
#include "downwash/cli/measured_data.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/fitting/effect_comparison.hpp"

namespace downwash::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr double max_factor = 2;
constexpr char explanation[] =
    "Errors are K minus thrust ratio, K clamped to [1, 2] as in flight: above zero a model overstates the effect,\n"
    "below zero it understates it. Under a ceiling overstating is careful: a plan expects more pull than there is,\n"
    "and only the energy that the pull saves is promised too high. Over the ground overstating is optimistic: lift,\n"
    "stiffness and savings are promised that are not there. Understating is the other way round.\n";

struct CompareArguments {
    MeasuredData data;
    bool as_json = false;
    bool as_markdown = false;
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
    fmt::print("\n{}\n{:<18} {:<42} {:>6}", title_of(set), "model", "parameters", "RMSE");
    for (const ErrorBand& band : set.scores.front().bands) {
        fmt::print(" {:>9}", band_name(band));
    }
    for (const ModelScore& score : set.scores) {
        fmt::print("\n{:<18} {:<42} {:>6.4f}", info(score.effect.model).name, parameters_text(score), score.rmse);
        for (const ErrorBand& band : score.bands) {
            fmt::print(" {:>9}", error_text(band));
        }
    }
    fmt::print("\n");
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

ExitCode run(const CompareArguments& arguments) {
    if (arguments.as_json && arguments.as_markdown) {
        throw UsageError("--json and --markdown: expected at most one of them");
    }
    const Measurements measurements = arguments.data.read();
    const std::vector<DataSetComparison> comparisons =
        compare_effects(measurements, arguments.data.neighbours(), max_factor);
    if (arguments.as_json) {
        fmt::print("{}\n", json_text(comparison_json(comparisons)));
        return ExitCode::done;
    }
    fmt::print("{}", explanation);
    for (const DataSetComparison& set : comparisons) {
        arguments.as_markdown ? print_markdown(set) : print_text(set);
    }
    return ExitCode::done;
}

}  // namespace

void add_aeromap_compare(CLI::App& aeromap, Action& action) {
    const auto arguments = std::make_shared<CompareArguments>();
    CLI::App* compare = aeromap.add_subcommand(
        "compare", "How near every model comes to measurements, as its source has it and refitted");
    arguments->data.add_options(*compare);
    compare->add_flag("--json", arguments->as_json, "print JSON");
    compare->add_flag("--markdown", arguments->as_markdown, "print tables in Markdown");
    compare->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace downwash::cli
