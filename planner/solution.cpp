#include "downwash/planner/solution.hpp"

#include <array>

namespace downwash {
namespace {

constexpr std::array<std::string_view, 3> variant_names{"mp-arm", "mp-arm-da", "mp-arm-ada"};
constexpr std::array<std::string_view, 3> status_names{"none", "approximate", "solved"};

}  // namespace

std::string_view name_of(Variant variant) {
    return variant_names[static_cast<std::size_t>(variant)];
}

std::string_view name_of(Status status) {
    return status_names[static_cast<std::size_t>(status)];
}

double cost_of(const Execution& execution, const CostFunction& objective) {
    return objective({execution.energy_j, execution.duration_s, execution.length_m, execution.clearance_integral});
}

}  // namespace downwash
