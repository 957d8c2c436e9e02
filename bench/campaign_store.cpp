#include "downwash/bench/campaign_store.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/core.h>

#include <cerrno>
#include <chrono>
#include <string>
#include <system_error>
#include <utility>

namespace downwash::bench {
namespace {

/// Checks that results were begun with the settings of a plan. @throws CampaignError that lists every difference
void require_equal_settings(const CampaignPlan& begun, const CampaignPlan& now, const std::filesystem::path& file) {
    std::string differences;
    const auto compare = [&](const std::string& name, const std::string& then, const std::string& value) {
        if (then != value) {
            differences += fmt::format("{} was begun with {} {}, not {}\n", file.string(), name,
                                       then.empty() ? "none" : then, value.empty() ? "without" : value);
        }
    };
    for (const auto& [name, value] : now.settings) {
        compare(name, setting(begun, name), value);
    }
    for (const auto& [name, value] : begun.settings) {
        if (setting(now, name).empty()) {
            compare(name, value, "");
        }
    }
    if (!differences.empty()) {
        throw CampaignError(differences +
                            "runs of different settings are not mixed: choose another folder with --out, or move this "
                            "one away");
    }
}

/// Where a shard's results are a shard's, and the same one's.
void require_same_shard(const Database& database, std::optional<std::uint64_t> shard,
                        const std::filesystem::path& file) {
    const std::optional<std::uint64_t> begun = shard_number(database);
    if (begun != shard) {
        const auto text = [](const std::optional<std::uint64_t>& number) {
            return number ? fmt::format("shard {}", *number) : "all shards together";
        };
        throw CampaignError(fmt::format("{} holds {} of the campaign, not {}: choose another folder with --out",
                                        file.string(), text(begun), text(shard)));
    }
}

/// Collects what is wrong with a file of results, to name it all at once.
class DamageReport {
 public:
    DamageReport(const CampaignPlan& plan, std::filesystem::path folder) : plan_(plan), folder_(std::move(folder)) {}

    /// Takes note of a run. @return whether it is what was written
    bool is_whole(const StoredRun& run) {
        constexpr int max_lines = 20;
        ++runs_;
        const bool is_damaged = run.is_damaged(plan_);
        if (is_damaged && ++damaged_ <= max_lines) {
            errors_ += file() + ": " + run.name(plan_) + ": is not what was written\n";
        }
        more_ = damaged_ - max_lines;
        return !is_damaged;
    }

    /// @throws CampaignError that names every damaged run
    void require_none(const Database& database) {
        if (more_ > 0) {
            errors_ += fmt::format("{}: {} more runs are not what was written\n", file(), more_);
        }
        if (const std::uint64_t written = database.number("SELECT finished_runs FROM campaign_checksum");
            written != runs_) {
            errors_ += fmt::format("{}: {} runs were written, {} are there\n", file(), written, runs_);
        }
        if (!errors_.empty()) {
            throw CampaignError(errors_ +
                                "the file is damaged: restore it from a copy, or repeat these runs with `downwash "
                                "bench run CAMPAIGN --resume --out " +
                                folder_.string() + "`");
        }
    }

 private:
    [[nodiscard]] std::string file() const { return (folder_ / results_file).string(); }

    const CampaignPlan& plan_;
    std::filesystem::path folder_;
    std::string errors_;
    std::uint64_t runs_ = 0;
    int damaged_ = 0, more_ = 0;
};

/// The runs that are what was written, then what is wrong with the others. @throws CampaignError
void take_all(const Database& database, const CampaignPlan& plan, const std::filesystem::path& folder,
              const std::function<void(Run&&)>& take) {
    DamageReport damage(plan, folder);
    for_each_run(database, [&](StoredRun&& each) {
        if (damage.is_whole(each)) {
            take(std::move(each.run));
        }
    });
    damage.require_none(database);
}

/// The identity of a file; of none if there is none.
FileIdentity identity_of(const std::filesystem::path& file) {
    struct stat found {};
    return stat(file.c_str(), &found) == 0 ? FileIdentity(found.st_dev, found.st_ino) : FileIdentity();
}

}  // namespace

CampaignLock::CampaignLock(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    descriptor_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor_ < 0) {
        throw CampaignError(folder.string() + " cannot be made a folder: " +
                            (error ? error.message() : std::generic_category().message(errno)));
    }
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
        const int reason = errno;
        close(descriptor_);
        throw CampaignError(reason == EWOULDBLOCK
                                ? "another program is running the campaign in " + folder.string()
                                : folder.string() + " cannot be locked: " + std::generic_category().message(reason) +
                                      ": choose a folder on another disk");
    }
}

CampaignLock::~CampaignLock() {
    close(descriptor_);
}

CampaignStore::CampaignStore(const std::filesystem::path& folder, const CampaignPlan& plan, bool resumes,
                             std::optional<std::uint64_t> shard)
    : lock_(folder),
      file_(folder / results_file),
      database_(file_, true),
      identity_(identity_of(file_)),
      writer_(database_) {
    database_.wait_for_others(std::chrono::hours(1));  // a report of a large campaign takes its time
    if (is_new(database_)) {
        Transaction all(database_);
        write_plan(database_, plan, shard);
        all.commit();
        return;
    }
    require_layout(database_, file_);
    if (!resumes) {
        throw CampaignError(file_.string() + " holds runs already; --resume continues with them");
    }
    const CampaignPlan begun = read_plan(database_, file_);
    require_equal_settings(begun, plan, file_);
    require_same_shard(database_, shard, file_);
    done_ = remove_damaged_runs(database_, begun);
}

CampaignStore::~CampaignStore() = default;

void CampaignStore::add(const Run& finished) {
    // SQLite would go on writing into a file that has no name any more.
    if (identity_of(file_) != identity_) {
        throw CampaignError(file_.string() +
                            " was removed or replaced while the campaign ran: the run that has ended is not stored. "
                            "Run the campaign again with --resume, and leave its folder alone meanwhile");
    }
    Transaction all(database_);
    try {
        writer_.add(finished);
        writer_.count();
        all.commit();
    } catch (...) {
        writer_.forget();
        throw;
    }
    done_.emplace(finished.experiment, finished.planner, finished.seed);
}

CampaignPlan read_runs(const std::filesystem::path& folder, const std::function<void(const CampaignPlan&)>& begin,
                       const std::function<void(Run&&)>& take) {
    const std::filesystem::path file = folder / results_file;
    std::error_code unknown;
    if (!std::filesystem::exists(file, unknown)) {
        throw CampaignError(file.string() +
                            " does not exist: expected the folder of a campaign that `downwash bench run` made");
    }
    const Database database(file);
    const Transaction all(database, Transaction::Kind::reading);
    require_layout(database, file);
    CampaignPlan plan = read_plan(database, file);
    begin(plan);
    take_all(database, plan, folder, take);
    return plan;
}

void read_runs_of(const CampaignPlan& plan, const std::string& checksum, const std::filesystem::path& folder,
                  const std::function<void(Run&&)>& take) {
    const std::filesystem::path file = folder / results_file;
    const Database database(file);
    const Transaction all(database, Transaction::Kind::reading);
    require_layout(database, file);
    const bool is_known = stored_plan_checksum(database) == checksum;
    take_all(database, is_known ? plan : read_plan(database, file), folder, take);
}

}  // namespace downwash::bench
