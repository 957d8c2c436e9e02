#include "downwash/base/version.hpp"

namespace downwash {

std::string_view version() {
    return DOWNWASH_VERSION;
}

}  // namespace downwash
