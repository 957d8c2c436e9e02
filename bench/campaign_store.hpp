#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <utility>

#include "downwash/bench/campaign_data.hpp"
#include "downwash/bench/campaign_runs.hpp"
#include "downwash/bench/campaign_schema.hpp"
#include "downwash/bench/database.hpp"

namespace downwash::bench {

/// Device and inode.
using FileIdentity = std::pair<std::uint64_t, std::uint64_t>;

/// Locks a folder for this process, and makes it if need be.
class CampaignLock {
 public:
    /// @throws CampaignError when another process holds it, or there can be no such folder
    explicit CampaignLock(const std::filesystem::path& folder);
    ~CampaignLock();
    CampaignLock(const CampaignLock&) = delete;
    CampaignLock& operator=(const CampaignLock&) = delete;

 private:
    int descriptor_;
};

/// The results of a campaign on disk: one SQLite file with the tables of OMPL's Planner Arena (experiments,
/// plannerConfigs, enums, runs, progress) and our own. A run that was added stays, whatever happens next.
class CampaignStore {
 public:
    /// Begins the results of a campaign in a folder, or continues those that are there.
    /// @param resumes whether existing results may be continued; they are an error otherwise. Runs in them that are
    /// damaged are removed and missing then
    /// @param shard its number, if the results are those of a shard
    /// @throws CampaignError when they were begun with other settings, or another program is running the campaign
    CampaignStore(const std::filesystem::path& folder, const CampaignPlan& plan, bool resumes,
                  std::optional<std::uint64_t> shard = std::nullopt);
    ~CampaignStore();
    CampaignStore(const CampaignStore&) = delete;
    CampaignStore& operator=(const CampaignStore&) = delete;

    /// Whether the results contain that run.
    [[nodiscard]] bool has(std::size_t experiment, std::size_t planner, std::uint32_t seed) const {
        return done_.contains({experiment, planner, seed});
    }
    [[nodiscard]] std::size_t size() const noexcept { return done_.size(); }

    /// Adds a run and commits it.
    /// @throws DatabaseError when it cannot be written   @throws CampaignError when the file was taken away
    void add(const Run& finished);

 private:
    CampaignLock lock_;
    std::filesystem::path file_;
    Database database_;
    FileIdentity identity_;
    RunWriter writer_;
    std::set<RunKey> done_;
};

/// Reads what a campaign has left in a folder, finished or not, one run after the other.
/// @param begin gets the plan first   @param take gets every run, in the order in which they were added
/// @return the plan
/// @throws CampaignError, DatabaseError after the last run that is whole: no such file, another layout, a file that was
/// changed or damaged; the message names every run that is not what was written, and says what to do
CampaignPlan read_runs(const std::filesystem::path& folder, const std::function<void(const CampaignPlan&)>& begin,
                       const std::function<void(Run&&)>& take);

/// Reads the runs of one of many files of one plan. The plan in the file is read only if its checksum differs.
/// @param checksum stored_plan_checksum() of a file that has the plan
void read_runs_of(const CampaignPlan& plan, const std::string& checksum, const std::filesystem::path& folder,
                  const std::function<void(Run&&)>& take);

}  // namespace downwash::bench
