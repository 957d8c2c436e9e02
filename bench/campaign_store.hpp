#pragma once

#include <filesystem>
#include <set>
#include <tuple>

#include "downwash/bench/campaign_data.hpp"
#include "downwash/bench/campaign_schema.hpp"
#include "downwash/bench/database.hpp"

namespace downwash::bench {

/// The results of a campaign on disk: one SQLite file with the tables of OMPL's Planner Arena (experiments,
/// plannerConfigs, enums, runs, progress) and our own. A run that was added stays, whatever happens next.
class CampaignStore {
 public:
    /// Begins the results of a campaign in a folder, or continues those that are there.
    /// @param resumes whether existing results may be continued; they are an error otherwise. Runs in them that are
    /// damaged are removed and missing then
    /// @throws CampaignError when they were begun with other settings, or another program is running the campaign
    CampaignStore(const std::filesystem::path& folder, const CampaignPlan& plan, bool resumes);
    ~CampaignStore();
    CampaignStore(const CampaignStore&) = delete;
    CampaignStore& operator=(const CampaignStore&) = delete;

    /// Whether the results contain that run.
    [[nodiscard]] bool has(std::size_t experiment, std::size_t planner, std::uint32_t seed) const {
        return done_.contains({experiment, planner, seed});
    }
    [[nodiscard]] std::size_t size() const noexcept { return done_.size(); }

    /// Adds a run and commits it. @throws DatabaseError when it cannot be written
    void add(const Run& finished);

 private:
    /// Locks a folder for this process.
    class FolderLock {
     public:
        explicit FolderLock(const std::filesystem::path& folder);
        ~FolderLock();
        FolderLock(const FolderLock&) = delete;
        FolderLock& operator=(const FolderLock&) = delete;

     private:
        int descriptor_;
    };

    FolderLock lock_;
    Database database_;
    std::set<std::tuple<std::size_t, std::size_t, std::uint32_t>> done_;
};

/// Reads what a campaign has left in a folder, finished or not.
/// @throws CampaignError, DatabaseError: no such file, another layout, a file that was changed or damaged; the message
/// names every run that is not what was written, and says what to do
[[nodiscard]] CampaignResults read_results(const std::filesystem::path& folder);

}  // namespace downwash::bench
