#include "downwash/search/search_record.hpp"

#include <array>

namespace downwash {

std::string_view name_of(Status status) {
    static constexpr std::array<std::string_view, 3> names{"none", "approximate", "solved"};
    return names[static_cast<std::size_t>(status)];
}

}  // namespace downwash
