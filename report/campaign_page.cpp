#include "downwash/report/campaign_page.hpp"

#include <nlohmann/json.hpp>

#include "downwash/report/page_template.hpp"

namespace downwash {

std::string campaign_page(const std::string& figures) {
    return filled_page(campaign_page_template(), page_data(nlohmann::ordered_json::parse(figures)));
}

}  // namespace downwash
