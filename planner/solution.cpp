#include "downwash/planner/solution.hpp"

#include <array>

namespace downwash {
namespace {

constexpr std::array<std::string_view, 3> variant_names{"mp-arm", "mp-arm-da", "mp-arm-ada"};
constexpr std::array<std::string_view, 4> objective_names{"energy", "time", "length", "clearance"};
constexpr std::array<std::string_view, 3> status_names{"none", "approximate", "solved"};

}  // namespace

std::string_view name_of(Variant variant) {
    return variant_names[static_cast<std::size_t>(variant)];
}

std::string_view name_of(Objective objective) {
    return objective_names[static_cast<std::size_t>(objective)];
}

std::string_view name_of(Status status) {
    return status_names[static_cast<std::size_t>(status)];
}

double cost_of(const Execution& execution, Objective objective) {
    switch (objective) {
        case Objective::energy:
            break;
        case Objective::time:
            return execution.duration_s;
        case Objective::length:
            return execution.length_m;
        case Objective::clearance:
            return execution.clearance_integral;
    }
    return execution.energy_j;
}

}  // namespace downwash
