#pragma once

#include <string>

#include "downwash/base/export.hpp"

namespace downwash {

/// The figures of a campaign as one self-contained HTML file: verdict, success and cost over time, spreads, paired
/// differences, tables.
/// @param figures JSON of the schema `downwash/campaign-report/v1`
/// @pre has_pages()
[[nodiscard]] DOWNWASH_EXPORT std::string campaign_page(const std::string& figures);

}  // namespace downwash
