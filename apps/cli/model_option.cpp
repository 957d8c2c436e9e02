#include "downwash/cli/model_option.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "downwash/aeromap/aero_settings.hpp"
#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/effects/effect_table.hpp"

namespace downwash::cli {
namespace {

/// A number of the command line within its range.
double checked(const char* option, const std::optional<double>& given, double otherwise, double low, double high) {
    const double value = given.value_or(otherwise);
    if (!(value >= low && value <= high)) {
        throw UsageError("{} {}: expected a number from {} to {}", option, value, low, high);
    }
    return value;
}

void set_parameter(SurfaceEffect& effect, const std::string& text) {
    const auto [name, value] = named_number("--set", text);
    const EffectModelInfo& model = info(effect.model);
    std::vector<std::string_view> names;
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
        const ModelParameter& parameter = model.parameters[i];
        names.push_back(parameter.name);
        if (parameter.name == name) {
            if (!parameter.allows(value)) {
                throw UsageError("--set {}: expected a number {}", text, parameter.range_text());
            }
            effect.parameters[i] = value;
            return;
        }
    }
    throw UsageError(
        "--set {}: {} has {}", excerpt(text), model.name,
        names.empty() ? "no parameters" : "the parameters " + joined_names(names) + did_you_mean(name, names));
}

SurfaceEffect effect_of(const ModelChoice& choice) {
    SurfaceEffect effect = model_named(choice.name).model;
    for (const std::string& text : choice.set) {
        set_parameter(effect, text);
    }
    const bool is_table = effect.model == EffectModel::table;
    if (is_table == choice.table.empty()) {
        throw UsageError(is_table ? "--model table needs --table FILE" : "--table FILE goes with --model table only");
    }
    if (is_table) {
        effect.table = read_effect_table(choice.table);
        if (effect.table->depends_on_d() && !choice.d_over_r) {
            throw UsageError("--table " + choice.table + " is over two distances: expected --d-over-r D");
        }
        checked("--d-over-r", choice.d_over_r, 0, 0, 10000);
        effect.d_over_r = choice.d_over_r;
    }
    if (choice.d_over_r && !(is_table && effect.table->depends_on_d())) {
        throw UsageError("--d-over-r goes with a table over two distances only");
    }
    return effect;
}

}  // namespace

void offer_models(Option option) {
    option.offers(names_of(effect_models()));
}

void add_model_options(Command command, ModelChoice& choice) {
    command.add_option("--set NAME=VALUE", choice.set,
                       "a parameter of the model, named as in a problem file; may be repeated");
    command.add_option("--table FILE", choice.table, "CSV file of the model `table`");
    command.add_option("--d-over-r D", choice.d_over_r, "second distance of a table over two, in radii");
    command.add_option("--rotor-spacing D", choice.rotor_spacing,
                       "spacing of adjacent axes of a square quadrotor in radii; for multirotor models, default 2.5");
    command.add_option("--max-factor K", choice.max_factor, "cap of K; default 2");
}

bool is_given(const ModelChoice& choice) {
    return !choice.set.empty() || !choice.table.empty() || choice.d_over_r || choice.rotor_spacing || choice.max_factor;
}

EffectCurve curve_option(const ModelChoice& choice) {
    const SurfaceEffect effect = effect_of(choice);
    if (choice.rotor_spacing && !is_multirotor(effect.model)) {
        throw UsageError("--rotor-spacing goes with the multirotor models only");
    }
    return {effect, checked("--max-factor", choice.max_factor, AeroSettings{}.max_factor, 1, 10),
            square_quadrotor(checked("--rotor-spacing", choice.rotor_spacing, usual_rotor_spacing, 0.1, 100))};
}

const EffectModelInfo& model_named(const std::string& name) {
    return entry_named(effect_models(), name, "--model");
}

std::pair<std::string, double> named_number(const std::string& option, const std::string& text) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const auto number = parse_number<double>(std::string_view(text).substr(std::min(equals + 1, text.size())));
    if (equals == text.size() || !number) {
        throw UsageError(option + " '" + excerpt(text) + "': expected NAME=NUMBER");
    }
    return {text.substr(0, equals), *number};
}

}  // namespace downwash::cli
