#pragma once

// What the programs that replan say of many answers.

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "downwash/base/text.hpp"

namespace downwash::bench {

/// How often each came: "3 stop, 1 none".
inline std::string listed(const std::map<std::string, int>& counts) {
    return joined(counts, ", ", [](const auto& each) { return fmt::format("{} {}", each.second, each.first); });
}

/// The share of values up to a limit; 0 without any.
inline double share(const std::vector<double>& values, double limit) {
    return static_cast<double>(std::count_if(values.begin(), values.end(), [&](double v) { return v <= limit; })) /
           static_cast<double>(std::max<std::size_t>(1, values.size()));
}

}  // namespace downwash::bench
