#include <array>

#include "downwash/problems/problem.hpp"

namespace downwash {

std::string_view name_of(Variant variant) {
    static constexpr std::array<std::string_view, 3> names{"mp-arm", "mp-arm-da", "mp-arm-ada"};
    return names[static_cast<std::size_t>(variant)];
}

}  // namespace downwash
