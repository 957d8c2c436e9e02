#include "downwash/report/page_template.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "downwash/report/campaign_page.hpp"
#include "downwash/report/comparison_page.hpp"

#ifdef DOWNWASH_PAGES
#include "downwash/base/embedded_file.hpp"

DOWNWASH_EMBED_FILE(downwash_run_page, DOWNWASH_PAGES "/run.html");
DOWNWASH_EMBED_FILE(downwash_space_page, DOWNWASH_PAGES "/space.html");
DOWNWASH_EMBED_FILE(downwash_robot_page, DOWNWASH_PAGES "/robot.html");
DOWNWASH_EMBED_FILE(downwash_campaign_page, DOWNWASH_PAGES "/campaign.html");
DOWNWASH_EMBED_FILE(downwash_comparison_page, DOWNWASH_PAGES "/comparison.html");
DOWNWASH_EMBED_FILE(downwash_validation_page, DOWNWASH_PAGES "/validation.html");
#else
#define DOWNWASH_EMBEDDED_FILE(NAME) std::string_view()
#endif

namespace downwash {

std::string_view run_page_template() noexcept {
    return DOWNWASH_EMBEDDED_FILE(downwash_run_page);
}

std::string_view space_page_template() noexcept {
    return DOWNWASH_EMBEDDED_FILE(downwash_space_page);
}

std::string_view robot_page_template() noexcept {
    return DOWNWASH_EMBEDDED_FILE(downwash_robot_page);
}

std::string_view campaign_page_template() noexcept {
    return DOWNWASH_EMBEDDED_FILE(downwash_campaign_page);
}

std::string_view comparison_page_template() noexcept {
    return DOWNWASH_EMBEDDED_FILE(downwash_comparison_page);
}

std::string_view validation_page_template() noexcept {
    return DOWNWASH_EMBEDDED_FILE(downwash_validation_page);
}

std::string page_data(const nlohmann::ordered_json& data) {
    constexpr int on_one_line = -1;
    constexpr bool as_ascii = true;
    const std::string json = data.dump(on_one_line, ' ', as_ascii, nlohmann::ordered_json::error_handler_t::replace);
    std::string text;
    text.reserve(json.size());
    // Only strings of JSON hold these characters.
    for (const char letter : json) {
        text += letter == '<'   ? "\\u003c"
                : letter == '>' ? "\\u003e"
                : letter == '&' ? "\\u0026"
                                : std::string_view(&letter, 1);
    }
    return text;
}

std::string filled_page(std::string_view page, const std::string& data) {
    constexpr std::string_view gap = R"({"downwash":"nothing"})";
    std::string filled(page);
    const std::size_t place = filled.find(gap);
    if (place == std::string::npos) {
        throw std::logic_error("the page has no place for its data");
    }
    return filled.replace(place, gap.size(), data);
}

std::string comparison_page(const std::string& comparison) {
    return filled_page(comparison_page_template(), page_data(nlohmann::ordered_json::parse(comparison)));
}

std::string campaign_page(const std::string& figures) {
    return filled_page(campaign_page_template(), page_data(nlohmann::ordered_json::parse(figures)));
}

}  // namespace downwash
