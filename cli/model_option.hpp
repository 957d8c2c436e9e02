#pragma once

#include <string>

#include "downwash/aeromap/effect_models.hpp"

namespace downwash::cli {

/// The surface-effect model that --model names. @throws UsageError when there is none
[[nodiscard]] const EffectModelInfo& model_named(const std::string& name);

}  // namespace downwash::cli
