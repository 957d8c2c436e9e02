#include "downwash/aeromap/effect_models.hpp"

#include <array>
#include <cstddef>
#include <limits>

#include "downwash/base/lane_math.hpp"

namespace downwash {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// 1 / (1 - 1 / q); infinite from the pole downwards, where the formula has lost its meaning.
double over_one_less(double q) {
    return q > 1 ? 1 / (1 - 1 / q) : infinity;
}

double no_effect(const SurfaceEffect&, double) {
    return 1;
}

double cheeseman_bennett(const SurfaceEffect&, double zeta) {
    return over_one_less(16 * zeta * zeta);
}

double sanchez_cuevas(const SurfaceEffect& effect, double zeta) {
    const double reach = zeta + effect.k2_over_radius;
    return over_one_less(effect.k1 * reach * reach);
}

/// A model of this list is all that the rest of the library needs to know it.
struct Model {
    EffectModelInfo info;
    double (*factor)(const SurfaceEffect& effect, double zeta);  ///< of zeta = z / R, not yet clamped
};

constexpr std::array models{
    Model{{EffectModel::none, "none", "no surface effect", "everywhere"}, no_effect},
    Model{
        {EffectModel::cheeseman_bennett, "cheeseman-bennett",
         "Cheeseman and Bennett 1955, ARC R&M 3021; thesis (2.9): one rotor over ground, potential flow with an image",
         "z/R >= 0.5; capped below"},
        cheeseman_bennett},
    Model{{EffectModel::sanchez_cuevas, "sanchez-cuevas",
           "thesis (2.18): fit for one 9.4 inch rotor under a ceiling, K2 scaled with the radius",
           "the fit's tests; its formula has a pole at z/R = 0.063 and is capped well before"},
          sanchez_cuevas},
};

constexpr bool listed_in_order() {
    for (std::size_t i = 0; i < models.size(); ++i) {
        if (models[i].info.model != static_cast<EffectModel>(i)) {
            return false;
        }
    }
    return true;
}
static_assert(listed_in_order(), "models must follow the order of EffectModel");

}  // namespace

double surface_factor(const SurfaceEffect& effect, double z_over_r, double max_factor) {
    const double factor = models[static_cast<std::size_t>(effect.model)].factor(effect, z_over_r);
    return lane::clamp(factor, 1.0, max_factor);
}

const EffectModelInfo& info(EffectModel model) {
    return models[static_cast<std::size_t>(model)].info;
}

const EffectModelInfo* find_effect_model(std::string_view name) {
    for (const Model& model : models) {
        if (model.info.name == name) {
            return &model.info;
        }
    }
    return nullptr;
}

}  // namespace downwash
