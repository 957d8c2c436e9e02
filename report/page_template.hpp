#pragma once

// Private: not installed.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace downwash {

/// The page of a run and that of a campaign without their data, as viewer/ builds them; empty where it was not built.
[[nodiscard]] std::string_view run_page_template() noexcept;
[[nodiscard]] std::string_view campaign_page_template() noexcept;

/// The data as it may stand within a page: ASCII, no `<`, `>` or `&`.
[[nodiscard]] std::string page_data(const nlohmann::ordered_json& data);

/// A page with its data in it. @pre the template is not empty
[[nodiscard]] std::string filled_page(std::string_view page, const std::string& data);

}  // namespace downwash
