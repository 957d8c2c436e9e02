#include "downwash/cli/usage_error.hpp"

#include <fmt/core.h>

#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"

namespace downwash::cli {

void reject_unknown(const std::string& what, std::string_view word, const std::vector<std::string_view>& known) {
    throw UsageError("{} '{}': expected {}{}", what, excerpt(word), joined_names(known), did_you_mean(word, known));
}

}  // namespace downwash::cli
