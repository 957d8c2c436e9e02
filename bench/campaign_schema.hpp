#pragma once

#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>

#include "downwash/bench/campaign_data.hpp"
#include "downwash/bench/database.hpp"

namespace downwash::bench {

/// A folder's results cannot be begun, continued or read; what() says why and what to do.
struct CampaignError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The name of the file that holds a campaign's results within its folder.
inline constexpr const char* results_file = "campaign.db";

/// Whether nothing was written yet: SQLite makes an empty file, and a kill may leave one.
[[nodiscard]] bool is_new(const Database& database);

/// @throws CampaignError unless the file has exactly the tables of this version
void require_layout(const Database& database, const std::filesystem::path& file);

/// Makes the tables and writes what is going to run. @pre is_new(database)
void write_plan(const Database& database, const CampaignPlan& plan);

/// @throws CampaignError when what is read is not what was written
[[nodiscard]] CampaignPlan read_plan(const Database& database, const std::filesystem::path& file);

/// The value of a setting; empty when the plan has none of that name.
[[nodiscard]] std::string setting(const CampaignPlan& plan, std::string_view name);

/// The value whose name that is; empty when none has it.
template <class Enumeration>
std::optional<Enumeration> named(const std::string& name, std::initializer_list<Enumeration> values) {
    for (const Enumeration value : values) {
        if (name_of(value) == name) {
            return value;
        }
    }
    return std::nullopt;
}

}  // namespace downwash::bench
