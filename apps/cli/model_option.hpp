#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/cli/command_line.hpp"
#include "downwash/effects/effect_curve.hpp"

namespace downwash::cli {

/// A surface-effect model with the changes that the command line makes to it.
struct ModelChoice {
    std::string name;
    std::vector<std::string> set;         ///< "NAME=VALUE" for parameters
    std::string table;                    ///< file, of the model `table`
    std::optional<double> d_over_r;       ///< second distance of a table over two
    std::optional<double> rotor_spacing;  ///< spacing of a square quadrotor, for the multirotor models [radii]
    std::optional<double> max_factor;
};

/// The default spacing of adjacent rotors for the multirotor models [radii].
inline constexpr double usual_rotor_spacing = 2.5;

/// Makes shells offer the names of models.
void offer_models(Option option);

/// Adds the options that go with --model NAME: --set, --table, --d-over-r, --rotor-spacing and --max-factor.
void add_model_options(Command command, ModelChoice& choice);

/// Whether any of them was used.
[[nodiscard]] bool is_given(const ModelChoice& choice);

/// K of the model over z/R. @throws UsageError when parts of the choice contradict each other
[[nodiscard]] EffectCurve curve_option(const ModelChoice& choice);

/// The surface-effect model that --model names. @throws UsageError when there is none
[[nodiscard]] const EffectModelInfo& model_named(const std::string& name);

/// The parts of "NAME=VALUE". @param option that it was given to  @throws UsageError for any other text
[[nodiscard]] std::pair<std::string, double> named_number(const std::string& option, const std::string& text);

}  // namespace downwash::cli
