#include "downwash/problems/objective.hpp"

#include "downwash/base/text.hpp"

namespace downwash {
namespace {

struct Entry {
    std::string_view name, unit;
    double (*figure)(const CostFigures& figures);
};

/// In the order of Objective.
constexpr std::array<Entry, all_objectives.size()> entries{{
    {"energy", "J", [](const CostFigures& of) { return of.energy_j; }},
    {"time", "s", [](const CostFigures& of) { return of.time_s; }},
    {"length", "m", [](const CostFigures& of) { return of.length_m; }},
    {"clearance", "s/m", [](const CostFigures& of) { return of.clearance_integral; }},
}};

const Entry& entry(Objective objective) {
    return entries[static_cast<std::size_t>(objective)];
}

}  // namespace

std::string_view name_of(Objective objective) {
    return entry(objective).name;
}

std::string_view unit_of(Objective objective) {
    return entry(objective).unit;
}

std::string_view unit_of(const CostFunction& cost) {
    const std::optional<Objective> single = cost.single();
    return single ? unit_of(*single) : "";
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
    double sum = 0;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        sum += weights_[i] != 0 ? weights_[i] * entries[i].figure(figures) : 0;
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
