#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "downwash/bench/campaign_data.hpp"

namespace downwash::bench {

/// Moves a file to its place on the same file system once its content is on the disk: a loss of power leaves the old
/// file or the whole new one. @throws CampaignError that names the place
void move_into_place(const std::filesystem::path& part, const std::filesystem::path& place);

/// Copies a file; a reader of the copy finds the one of before or the whole new one. @throws CampaignError
void copy_whole(const std::filesystem::path& from, const std::filesystem::path& to);

/// A copy of the results of a campaign in another folder, for results on the disk of a node that may go away.
class SavedCopy {
 public:
    /// @param results folder of the results   @param saved folder of the copy; made if need be; empty: no copy
    /// @throws CampaignError when there can be no such folder
    SavedCopy(std::filesystem::path results, std::filesystem::path saved);

    /// Begins the results with the copy if they have fewer runs or are not there. To be called before anything opens
    /// them. @param plan,shard what is going to run   @param resumes whether runs may be there already
    /// @throws CampaignError, DatabaseError: a copy that cannot be read, that is of another campaign or shard, or that
    /// has runs although nothing is resumed
    void restore(const CampaignPlan& plan, std::optional<std::uint64_t> shard, bool resumes) const;

    /// Saves the results, unless the copy has more runs. Nobody may be writing them.
    /// @throws CampaignError, DatabaseError, also where the copy has become that of another campaign or shard
    void save();

    /// Saves the copy, at most every few minutes. If that fails, it tries again later.
    void save_now_and_then();

    /// Saves the copy where the error that ends the campaign is another one.
    void save_if_possible();

 private:
    using Clock = std::chrono::steady_clock;

    std::filesystem::path results_, saved_;
    Clock::time_point last_ = Clock::now();
};

}  // namespace downwash::bench
