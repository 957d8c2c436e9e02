#pragma once

// Private: not installed.

#include <string_view>

namespace downwash {

/// The page of a run without its data, as viewer/ builds it; empty where the viewer was not built.
[[nodiscard]] std::string_view run_page_template() noexcept;

}  // namespace downwash
