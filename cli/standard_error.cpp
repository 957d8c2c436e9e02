#include "downwash/cli/standard_error.hpp"

#include <cstdio>

namespace downwash::cli {

void print_error(std::string_view text) noexcept {
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
    static_cast<void>(std::fflush(stderr));
}

}  // namespace downwash::cli
