#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <string>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/fit_commands.hpp"
#include "downwash/cli/measured_data.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/fitting/effect_comparison.hpp"
#include "downwash/fitting/effect_scatter.hpp"

namespace downwash::cli {
namespace {

constexpr double max_factor = 2;
constexpr char explanation[] =
    "An error is the model's thrust ratio K minus the measured one; K is clamped to [1, 2], as formulas are in\n"
    "flight (a table may be below 1). A positive error overstates the effect, a negative one understates it. Under\n"
    "a ceiling, overstating is careful: the plan expects more suction than there is, and only overrates the energy\n"
    "that suction saves. Over the ground, overstating is optimistic: the plan counts on lift, stiffness and savings\n"
    "that do not exist. Understating has the opposite consequences. `others`: the RMSE over all level measurements\n"
    "of other sources at that surface. `level`: the RMSE if a tilted rotor counted as level.\n";

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
            {"level_rmse", score.level_rmse},
            {"others_rmse", json_of(score.others_rmse)},
            {"bands", std::move(bands)}};
}

Json scatter_json(const std::vector<EffectScatter>& scatters) {
    const auto band_json = [](const RelativeScatter& band) {
        return Json{{"z_over_r_low", band.z_low},
                    {"z_over_r_high", std::isfinite(band.z_high) ? Json(band.z_high) : Json()},
                    {"n", band.points},
                    {"bias", band.points > 0 ? Json(band.bias) : Json()},
                    {"scatter", band.points > 0 ? Json(band.scatter) : Json()}};
    };
    auto all = Json::array();
    for (const EffectScatter& scatter : scatters) {
        auto bands = Json::array();
        for (const RelativeScatter& band : scatter.bands) {
            bands.push_back(band_json(band));
        }
        all.push_back({{"model", info(scatter.model).name},
                       {"surface", scatter.surface},
                       {"bands", std::move(bands)},
                       {"from_half_a_radius", band_json(scatter.all)}});
    }
    return all;
}

Json comparison_json(const std::vector<DataSetComparison>& comparisons, const std::vector<EffectScatter>& scatters) {
    auto sets = Json::array();
    for (const DataSetComparison& set : comparisons) {
        auto models = Json::array();
        for (const ModelScore& score : set.scores) {
            models.push_back(score_json(score));
        }
        sets.push_back({{"source", set.source},
                        {"surface", set.surface},
                        {"tilt_deg", set.tilt_deg},
                        {"n", set.points},
                        {"z_over_r", {set.z_low, set.z_high}},
                        {"models", std::move(models)}});
    }
    return {{"data_sets", std::move(sets)}, {"scatter", scatter_json(scatters)}};
}

std::string title_of(const DataSetComparison& set) {
    std::string title = set.source;
    if (!set.surface.empty()) {
        title += (title.empty() ? "" : ", ") + set.surface;
    }
    if (set.tilt_deg > 0) {
        title += (title.empty() ? "" : ", ") + fmt::format("tilted by {} degrees", to_text(set.tilt_deg));
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

/// The name of the RMSE beside the one proper: as if level, or of the other sources.
const char* second_name(const DataSetComparison& set) {
    return set.tilt_deg > 0 ? "level" : "others";
}

std::string second_text(const DataSetComparison& set, const ModelScore& score) {
    if (set.tilt_deg > 0) {
        return fmt::format("{:.4f}", score.level_rmse);
    }
    return score.others_rmse ? fmt::format("{:.4f}", *score.others_rmse) : "-";
}

void print_text(const DataSetComparison& set) {
    const auto print_row = [](std::string_view model, const std::string& parameters, const std::string& rmse,
                              const std::string& second, const ModelScore& score, const auto& text_of) {
        fmt::print("{:<18} {:<42} {:>6} {:>6}", model, parameters, rmse, second);
        for (const ErrorBand& band : score.bands) {
            fmt::print(" {:>9}", text_of(band));
        }
        fmt::print("\n");
    };
    fmt::print("\n{}\n", title_of(set));
    print_row("model", "parameters", "RMSE", second_name(set), set.scores.front(), band_name);
    for (const ModelScore& score : set.scores) {
        print_row(info(score.effect.model).name, parameters_text(score), fmt::format("{:.4f}", score.rmse),
                  second_text(set, score), score, error_text);
    }
}

void print_markdown(const DataSetComparison& set) {
    fmt::print("\n**{}**\n\n| model | parameters | RMSE | {} |", title_of(set), second_name(set));
    for (const ErrorBand& band : set.scores.front().bands) {
        fmt::print(" {} |", band_name(band));
    }
    fmt::print("\n| --- | --- | ---: | ---: |");
    for (std::size_t i = 0; i < set.scores.front().bands.size(); ++i) {
        fmt::print(" ---: |");
    }
    for (const ModelScore& score : set.scores) {
        fmt::print("\n| `{}` | {} | {:.4f} | {} |", info(score.effect.model).name, parameters_text(score), score.rmse,
                   second_text(set, score));
        for (const ErrorBand& band : score.bands) {
            fmt::print(" {} |", error_text(band));
        }
    }
    fmt::print("\n");
}

std::string scatter_text(const RelativeScatter& band) {
    return band.points > 0 ? fmt::format("{:+.2f} +- {:.2f}", band.bias, band.scatter) : "-";
}

void print_scatter(const std::vector<EffectScatter>& scatters, bool as_markdown) {
    if (scatters.empty()) {
        return;
    }
    fmt::print("\n{}\n", as_markdown ? "**Scatter of K - 1 over all level measurements, relative to the model's**"
                                     : "Scatter of K - 1 over all level measurements, relative to the model's");
    const auto cell = [&](std::string_view text, std::size_t width) {
        return as_markdown ? fmt::format(" {} |", text) : fmt::format("{:<{}}", text, width);
    };
    const auto row = [&](std::string_view surface, std::string_view model, const EffectScatter& scatter,
                         const auto& text_of) {
        fmt::print("\n{}{}{}", as_markdown ? "|" : "", cell(surface, 9), cell(model, 19));
        for (const RelativeScatter& band : scatter.bands) {
            fmt::print("{}", cell(text_of(band), 16));
        }
        fmt::print("{}", cell(text_of(scatter.all), 16));
    };
    row("surface", "model", scatters.front(), [](const RelativeScatter& band) {
        return band_name({band.z_low, band.z_high, 0, 0});
    });
    if (as_markdown) {
        fmt::print("\n| --- | --- |");
        for (std::size_t i = 0; i <= scatters.front().bands.size(); ++i) {
            fmt::print(" ---: |");
        }
    }
    for (const EffectScatter& scatter : scatters) {
        row(scatter.surface, info(scatter.model).name, scatter, scatter_text);
    }
    fmt::print("\n");
}

}  // namespace

ExitCode compare_models(const CompareArguments& given) {
    if (given.as_json && given.as_markdown) {
        throw UsageError("--json and --markdown: expected at most one of them");
    }
    std::vector<Measurements> data;
    for (const std::string& file : given.files) {
        MeasuredData of_file = given.data;
        of_file.file = file;
        data.push_back(of_file.read());
        static_cast<void>(of_file.warn_of(data.back()));
    }
    const RotorNeighbours neighbours = given.data.neighbours();
    const std::vector<DataSetComparison> comparisons = compare_effects(data, neighbours, max_factor);
    const std::vector<EffectScatter> scatters = effect_scatter(data, neighbours, max_factor);
    if (given.as_json) {
        print_json(comparison_json(comparisons, scatters));
        return ExitCode::done;
    }
    fmt::print("{}", explanation);
    for (const DataSetComparison& set : comparisons) {
        given.as_markdown ? print_markdown(set) : print_text(set);
    }
    print_scatter(scatters, given.as_markdown);
    return ExitCode::done;
}

}  // namespace downwash::cli
