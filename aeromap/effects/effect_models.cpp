#include "downwash/effects/effect_models.hpp"

#include <array>
#include <cstddef>

#include "downwash/base/infinity.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/base/text.hpp"
#include "downwash/effects/effect_table.hpp"

namespace downwash {
namespace {

using Parameters = std::array<double, max_model_parameters>;

/// 1 / (1 - loss), where `loss` of the induced velocity is the surface's doing; infinite from the pole on, where the
/// formula has lost its meaning.
double over_one_less(double loss) {
    return loss < 1 ? 1 / (1 - loss) : infinity;
}

double no_effect(const Parameters&, double, const RotorNeighbours&) {
    return 1;
}

double cheeseman_bennett(const Parameters&, double zeta, const RotorNeighbours&) {
    return over_one_less(1 / (16 * zeta * zeta));
}

double images_loss(double zeta, const RotorNeighbours& neighbours) {
    double loss = 1 / (16 * zeta * zeta);
    for (const double d : neighbours.distances_radii) {
        loss += image_loss(zeta, d);
    }
    return loss;
}

double multirotor_images(const Parameters&, double zeta, const RotorNeighbours& neighbours) {
    return over_one_less(images_loss(zeta, neighbours));
}

double multirotor_body(const Parameters& p, double zeta, const RotorNeighbours& neighbours) {
    const auto& [k_b, b_over_radius] = p;
    const double b = b_over_radius > 0 ? b_over_radius : neighbours.center_radii;
    const double fountain = static_cast<double>(neighbours.rotors()) * k_b * image_loss(zeta, b);
    return over_one_less(images_loss(zeta, neighbours) + fountain);
}

double hayden(const Parameters&, double zeta, const RotorNeighbours&) {
    const double diameters = 2 / zeta;
    const double root = lane::cube_root(0.9926 + 0.03794 * diameters * diameters);
    return root * root;
}

double li(const Parameters& p, double zeta, const RotorNeighbours&) {
    return over_one_less(p[0] / (16 * zeta * zeta));
}

double he(const Parameters& p, double zeta, const RotorNeighbours&) {
    return 1 + p[0] * lane::exp(-p[1] * zeta);
}

/// (2.18) and (4.8): 1 / (1 - (1 / k1) (R / (z + k2))^2).
double shifted_image(const Parameters& p, double zeta, const RotorNeighbours&) {
    const double reach = zeta + p[1];
    return over_one_less(1 / (p[0] * reach * reach));
}

double momentum_theory(const Parameters&, double zeta, const RotorNeighbours&) {
    return 0.5 + 0.5 * lane::sqrt(1 + 1 / (8 * zeta * zeta));
}

constexpr std::array body_parameters{
    ModelParameter{"k_b", 2, 0, 100, false, "strength of the fountain on the body"},
    ModelParameter{"b_over_radius", 0, 0, 100, false,
                   "distance from a rotor axis to the body's centre; 0: as the rotors stand"},
};
constexpr std::array li_parameters{
    ModelParameter{"rho", 1, 0, 100, false, "strength of the image, measured for the vehicle"}};
constexpr std::array he_parameters{
    ModelParameter{"a", 0.4, 0, 100, false, "increment at contact"},
    ModelParameter{"b", 2.2, 0, 100, true, "decay per radius"},
};
constexpr std::array ceiling_parameters{
    ModelParameter{"k1", 6.924, 0, 1e6, true, "divisor of the fit"},
    ModelParameter{"k2_over_radius", 0.3168, 0, 100, false, "offset of the fit"},
};
constexpr std::array fairing_parameters{
    ModelParameter{"a1", 0.081, 0, 1e6, true, "divisor of the fit"},
    ModelParameter{"a2_over_radius", 1.026 / 0.1194, 0, 100, false, "offset of the fit"},
};

/// An entry of this list is all that the rest of the library needs to know of a model.
struct Model {
    EffectModelInfo info;
    double (*factor)(const Parameters& parameters, double zeta, const RotorNeighbours& neighbours);
};

constexpr std::array models{
    Model{{EffectModel::none, "none", "any",
           "no surface effect; walls: thesis 2.5.3, figure 2.17 (no clear effect on thrust)", "1", "everywhere", 0,
           infinity},
          no_effect},
    Model{{EffectModel::cheeseman_bennett, "cheeseman-bennett", "ground",
           "Cheeseman and Bennett 1955, ARC R&M 3021; thesis (2.9): one rotor, potential flow with an image",
           "1 / (1 - (R/4z)^2)", "z/R from 0.64 to 4 (thesis table 2.1); capped below, pole at 0.25", 0.64, 4},
          cheeseman_bennett},
    Model{{EffectModel::multirotor_images, "multirotor-images", "ground",
           "thesis (2.14), (2.15): N rotors and their images, each rotor by its own neighbours",
           "1 / (1 - (R/4z)^2 - (R^2/2) sum_i z / (d_i^2 + 4 z^2)^1.5)",
           "z/R from 0.64; alone it does not describe a whole multirotor (thesis figure 2.10)", 0.64, infinity},
          multirotor_images},
    Model{{EffectModel::multirotor_body, "multirotor-body", "ground",
           "thesis (2.17): N rotors and the fountain between them on the vehicle's body",
           "1 / (1 - (R/4z)^2 - (R^2/2) sum_i z / (d_i^2 + 4 z^2)^1.5 - (N/2) R^2 k_b z / (b^2 + 4 z^2)^1.5)",
           "z/R from 0.64. In a scene the rotors take multirotor-images and the body the rest", 0.64, infinity,
           body_parameters},
          multirotor_body},
    Model{{EffectModel::hayden, "hayden", "ground",
           "Hayden 1976, AHS Forum 32: flight-test fit of helicopters, power taken to 2/3",
           "(0.9926 + 0.03794 (2R/z)^2)^(2/3)", "z/R from 0.6 to 5", 0.6, 5},
          hayden},
    Model{{EffectModel::li, "li", "ground", "Li et al. 2015: Cheeseman and Bennett with a measured strength",
           "1 / (1 - rho (R/4z)^2)", "the range it was fitted in", 0, infinity, li_parameters},
          li},
    Model{{EffectModel::he, "he", "ground", "He et al. 2019: exponential fit for small rotors", "1 + a exp(-b z/R)",
           "z/R from 0.3 to 4; no pole", 0.3, 4, he_parameters},
          he},
    Model{{EffectModel::sanchez_cuevas, "sanchez-cuevas", "ceiling",
           "thesis (2.18): fit for one 9.4 inch rotor under a ceiling, K2 scaled with the radius",
           "1 / (1 - (1/k1) (R / (z + k2))^2)",
           "z/R from 0.2 to 2.4 (thesis table 2.2); a max_factor of 2 cuts it below 0.221, its pole is at 0.063", 0.2,
           2.4, ceiling_parameters},
          shifted_image},
    Model{{EffectModel::fairing_cfd, "fairing-cfd", "ceiling",
           "thesis (4.8) as printed: fairings around the rotors, CFD; does not reproduce the thesis' own percentages",
           "1 / (1 - (1/a1) (R / (z + a2))^2)", "z/R from 0.34 to 4.2 (flow simulations at 4 to 50 cm)", 0.34, 4.2,
           fairing_parameters},
          shifted_image},
    Model{{EffectModel::momentum_theory, "momentum-theory", "ceiling",
           "momentum theory of a rotor that draws its air sideways", "1/2 + 1/2 sqrt(1 + 1 / (8 (z/R)^2))",
           "z/R >= 0.3", 0.3, infinity},
          momentum_theory},
    Model{{EffectModel::table, "table", "any", "a file of measured or computed values, interpolated monotonically",
           "the table", "the table's range; held below it, fading like (R/z)^2 above", 0, infinity},
          nullptr},
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

constexpr std::array<EffectModelInfo, models.size()> only_infos() {
    std::array<EffectModelInfo, models.size()> infos{};
    for (std::size_t i = 0; i < models.size(); ++i) {
        infos[i] = models[i].info;
    }
    return infos;
}
constexpr auto infos = only_infos();

}  // namespace

std::string ModelParameter::range_text() const {
    return (is_open ? "above " : "of at least ") + to_text(low) + " and at most " + to_text(high);
}

SurfaceEffect::SurfaceEffect(EffectModel which) : model(which) {
    const auto& known = info(which).parameters;
    for (std::size_t i = 0; i < known.size(); ++i) {
        parameters[i] = known[i].source_value;
    }
}

std::span<const EffectModelInfo> effect_models() {
    return infos;
}

const EffectModelInfo& info(EffectModel model) {
    return infos[static_cast<std::size_t>(model)];
}

const EffectModelInfo* find_effect_model(std::string_view name) {
    for (const EffectModelInfo& model : infos) {
        if (model.name == name) {
            return &model;
        }
    }
    return nullptr;
}

double image_loss(double z_over_r, double distance_radii) {
    if (distance_radii == 0) {
        return 1 / (16 * z_over_r * z_over_r);
    }
    return 0.5 * z_over_r / lane::power_three_halves(distance_radii * distance_radii + 4 * z_over_r * z_over_r);
}

double formula_factor(const SurfaceEffect& effect, double z_over_r, const RotorNeighbours& neighbours) {
    if (z_over_r == infinity) {
        return 1;
    }
    if (effect.model == EffectModel::table) {
        return effect.table->at(effect.d_over_r.value_or(infinity))(z_over_r);
    }
    return models[static_cast<std::size_t>(effect.model)].factor(effect.parameters, z_over_r, neighbours);
}

}  // namespace downwash
