#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "downwash/bench/campaign_data.hpp"
#include "downwash/bench/database.hpp"

namespace downwash::bench {

/// A run as it stands in a file of results, damaged or not.
struct StoredRun {
    std::uint64_t key = 0;
    Run run;
    std::uint64_t is_solved = 0, is_approximate = 0, is_correct = 0;  ///< columns that follow from the others
    std::string checksum;                                             ///< checksum that the run should have

    /// Whether it is not what was written.
    [[nodiscard]] bool is_damaged(const CampaignPlan& plan) const;
    /// As much as can be said of it.
    [[nodiscard]] std::string name(const CampaignPlan& plan) const;
};

/// Calls take for every run of a file, damaged ones too, in the order of their keys. Needs memory for a few thousand
/// runs only. @pre require_layout()
void for_each_run(const Database& database, const std::function<void(StoredRun&&)>& take);

/// Experiment, planner and seed of a run.
using RunKey = std::tuple<std::size_t, std::size_t, std::uint32_t>;

/// Removes what is damaged, so that it is run again. @return what is left
std::set<RunKey> remove_damaged_runs(const Database& database, const CampaignPlan& plan);

/// Adds runs to a file of results. Within a transaction: a run has rows in many tables.
class RunWriter {
 public:
    /// @param database outlives the writer and has tables of the present layout
    explicit RunWriter(const Database& database) : database_(database) {}

    void add(Run finished);
    /// Adds what was added since the last call to the file's sums. Before the end of the transaction.
    void count();
    /// Forgets what it knows of the file, after a transaction that was rolled back.
    void forget();

 private:
    [[nodiscard]] std::uint64_t key_of(const Machine& machine);

    const Database& database_;
    std::map<Machine, std::uint64_t> machines_;
    std::uint64_t added_ = 0;                ///< since count()
    std::map<std::size_t, double> added_s_;  ///< wall time of these, by experiment
};

}  // namespace downwash::bench
