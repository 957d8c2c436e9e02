#pragma once

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

/// @throws CampaignError unless the file has exactly the tables that this version makes
void require_layout(const Database& database, const std::filesystem::path& file);

/// Makes the tables and writes what is going to run. @pre is_new(database)
/// @param shard its number, if the file is going to hold a shard alone
void write_plan(const Database& database, const CampaignPlan& plan, std::optional<std::uint64_t> shard);

/// The number of the shard that a file holds; empty where it holds none, or several that were merged.
/// @pre require_layout()
[[nodiscard]] std::optional<std::uint64_t> shard_number(const Database& database);

/// The checksum that a file has of its plan, which tells equal plans sooner than reading them. @pre require_layout()
[[nodiscard]] std::string stored_plan_checksum(const Database& database);

/// @throws CampaignError when what is read is not what was written
[[nodiscard]] CampaignPlan read_plan(const Database& database, const std::filesystem::path& file);

/// The value of a setting; empty when the plan has none of that name.
[[nodiscard]] std::string setting(const CampaignPlan& plan, std::string_view name);

/// The value whose name that is; empty when none has it.
template <class Values>
std::optional<typename Values::value_type> named(const std::string& name, const Values& values) {
    for (const auto value : values) {
        if (name_of(value) == name) {
            return value;
        }
    }
    return std::nullopt;
}

}  // namespace downwash::bench
