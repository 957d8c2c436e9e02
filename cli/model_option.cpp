#include "downwash/cli/model_option.hpp"

#include <string_view>
#include <vector>

#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/usage_error.hpp"

namespace downwash::cli {

const EffectModelInfo& model_named(const std::string& name) {
    if (const EffectModelInfo* model = find_effect_model(name)) {
        return *model;
    }
    std::vector<std::string_view> names;
    for (const EffectModelInfo& known : effect_models()) {
        names.push_back(known.name);
    }
    throw UsageError("--model '" + excerpt(name) + "' is not known: expected one of " + joined_names(names) +
                     did_you_mean(name, names));
}

}  // namespace downwash::cli
