#pragma once

// Private: not installed.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace downwash {

/// The pages of a run, of a flight in space, of a robot, of a campaign, of a comparison and of a validation without
/// their data, as apps/viewer/ builds them; empty if it was not built.
[[nodiscard]] std::string_view run_page_template() noexcept;
[[nodiscard]] std::string_view space_page_template() noexcept;
[[nodiscard]] std::string_view robot_page_template() noexcept;
[[nodiscard]] std::string_view campaign_page_template() noexcept;
[[nodiscard]] std::string_view comparison_page_template() noexcept;
[[nodiscard]] std::string_view validation_page_template() noexcept;

/// Data in a form that a page can contain: ASCII without `<`, `>` and `&`.
[[nodiscard]] std::string page_data(const nlohmann::ordered_json& data);

/// A page with its data. @pre the template is not empty
[[nodiscard]] std::string filled_page(std::string_view page, const std::string& data);

}  // namespace downwash
