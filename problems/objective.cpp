#include "downwash/problems/objective.hpp"

#include "downwash/base/text.hpp"

namespace downwash {
namespace {

constexpr std::array<std::string_view, all_objectives.size()> names{"energy", "time", "length", "clearance"};

}  // namespace

std::string_view name_of(Objective objective) {
    return names[static_cast<std::size_t>(objective)];
}

CostFunction CostFunction::of_nothing() noexcept {
    CostFunction cost;
    cost.weights_ = {};
    return cost;
}

std::optional<Objective> CostFunction::single() const noexcept {
    for (const Objective objective : all_objectives) {
        if (*this == CostFunction(objective)) {
            return objective;
        }
    }
    return std::nullopt;
}

double CostFunction::operator()(const CostFigures& figures) const noexcept {
    const std::array<double, all_objectives.size()> values{figures.energy_j, figures.time_s, figures.length_m,
                                                           figures.clearance_integral};
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        sum += weights_[i] != 0 ? weights_[i] * values[i] : 0;
    }
    return sum;
}

std::string text_of(const CostFunction& cost) {
    std::string text;
    for (const Objective objective : all_objectives) {
        const double weight = cost.weight(objective);
        if (weight != 0) {
            text += (text.empty() ? "" : " + ") + (weight != 1 ? to_text(weight) + " " : "") +
                    std::string(name_of(objective));
        }
    }
    return text;
}

}  // namespace downwash
