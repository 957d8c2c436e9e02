#include "downwash/report/page_template.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

#ifdef DOWNWASH_PAGES
#include "downwash/base/embedded_file.hpp"

DOWNWASH_EMBED_FILE(downwash_run_page, DOWNWASH_PAGES "/run.html");
DOWNWASH_EMBED_FILE(downwash_campaign_page, DOWNWASH_PAGES "/campaign.html");
#endif

namespace downwash {

std::string_view run_page_template() noexcept {
#ifdef DOWNWASH_PAGES
    return DOWNWASH_EMBEDDED_FILE(downwash_run_page);
#else
    return {};
#endif
}

std::string_view campaign_page_template() noexcept {
#ifdef DOWNWASH_PAGES
    return DOWNWASH_EMBEDDED_FILE(downwash_campaign_page);
#else
    return {};
#endif
}

std::string page_data(const nlohmann::ordered_json& data) {
    constexpr int on_one_line = -1;
    constexpr bool as_ascii = true;
    const std::string json = data.dump(on_one_line, ' ', as_ascii, nlohmann::ordered_json::error_handler_t::replace);
    std::string text;
    text.reserve(json.size());
    // Outside of strings JSON has none of these letters.
    for (const char letter : json) {
        switch (letter) {
            case '<':
                text += "\\u003c";
                break;
            case '>':
                text += "\\u003e";
                break;
            case '&':
                text += "\\u0026";
                break;
            default:
                text += letter;
        }
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

}  // namespace downwash
