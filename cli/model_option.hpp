#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/effects/effect_curve.hpp"

namespace downwash::cli {

/// A surface-effect model with what the command line changes of it.
struct ModelChoice {
    std::string name;
    std::vector<std::string> set;         ///< "NAME=VALUE" for parameters
    std::string table;                    ///< file, of the model `table`
    std::optional<double> d_over_r;       ///< of a table over two distances
    std::optional<double> rotor_spacing;  ///< of a square quadrotor, for the multirotor models [radii]
    std::optional<double> max_factor;
};

/// Spacing of adjacent rotors that the multirotor models take when none is said [radii].
inline constexpr double usual_rotor_spacing = 2.5;

/// Whether a model sees the vehicle's other rotors.
[[nodiscard]] bool is_multirotor(EffectModel model);

/// Makes shells offer the names of models.
void offer_models(CLI::Option& option);

/// Adds the options that go with --model NAME: --set, --table, --d-over-r, --rotor-spacing and --max-factor.
void add_model_options(CLI::App& command, ModelChoice& choice);

/// Whether any of them was used.
[[nodiscard]] bool is_given(const ModelChoice& choice);

/// The model's K as it would be used. @throws UsageError when a part of the choice makes no sense
[[nodiscard]] EffectCurve curve_option(const ModelChoice& choice);

/// The surface-effect model that --model names. @throws UsageError when there is none
[[nodiscard]] const EffectModelInfo& model_named(const std::string& name);

/// "NAME=VALUE" taken apart. @param option that it was given to  @throws UsageError when it is something else
[[nodiscard]] std::pair<std::string, double> named_number(const std::string& option, const std::string& text);

}  // namespace downwash::cli
