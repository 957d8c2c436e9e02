#include "downwash/bench/campaign_merge.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "downwash/bench/campaign_shards.hpp"
#include "downwash/bench/campaign_store.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/bench/saved_copy.hpp"

namespace downwash::bench {
namespace {

namespace fs = std::filesystem;

constexpr int max_lines = 20;  ///< of one kind in a message

/// A folder with results of a shard, or of several that were merged.
struct Shard {
    std::uint64_t number = 0;  ///< 0: merged
    fs::path folder;

    [[nodiscard]] std::string file() const { return (folder / results_file).string(); }
};

/// Shards in the order of their numbers, and the plan that all of them have.
struct Shards {
    CampaignPlan plan;
    std::string checksum;  ///< of the plan in the first file
    std::vector<Shard> all;
};

/// What says what a file is of.
struct ShardHead {
    std::uint64_t number = 0;
    std::string checksum;              ///< of its plan
    std::optional<CampaignPlan> plan;  ///< empty where it is the known one
};

/// Nothing of a file in which nothing is yet.
std::optional<ShardHead> read_head(const fs::path& folder, const Shards& known) {
    const fs::path file = folder / results_file;
    std::error_code unknown;
    if (!fs::exists(file, unknown)) {
        throw CampaignError(file.string() +
                            " does not exist: expected the folder of a shard that `downwash bench run "
                            "CAMPAIGN --shard I/N --out " +
                            folder.string() + "` made");
    }
    const Database database(file);
    if (is_new(database)) {
        return std::nullopt;
    }
    require_layout(database, file);
    ShardHead head{shard_number(database).value_or(0), stored_plan_checksum(database), {}};
    if (!known.all.empty() && head.checksum == known.checksum) {
        return head;
    }
    head.plan = read_plan(database, file);
    if (!head.plan->shards) {
        throw CampaignError(file.string() +
                            " holds no shard but a whole campaign: expected results of `downwash bench run CAMPAIGN "
                            "--shard I/N`");
    }
    return head;
}

/// The lines in which the settings of a shard differ from those of the first one.
std::string differences(const CampaignPlan& first, const Shard& of_first, const CampaignPlan& other,
                        const Shard& of_other) {
    std::string lines;
    const auto add = [&](const std::string& name) {
        const std::string here = setting(other, name), there = setting(first, name);
        if (here != there) {
            lines += fmt::format("{} was begun with {} {}, {} with {}\n", of_other.file(), name,
                                 here.empty() ? "none" : here, of_first.file(), there.empty() ? "none" : there);
        }
    };
    std::set<std::string> names;
    for (const CampaignPlan* plan : {&first, &other}) {
        for (const auto& [name, value] : plan->settings) {
            if (names.insert(name).second) {
                add(name);
            }
        }
    }
    return lines;
}

Shards read_shards(const std::vector<fs::path>& folders) {
    Shards shards;
    std::string errors;
    int wrong = 0;
    for (const fs::path& folder : folders) {
        std::optional<ShardHead> head = read_head(folder, shards);
        if (!head) {
            continue;
        }
        shards.all.push_back({head->number, folder});
        if (!head->plan) {
            continue;
        }
        if (shards.all.size() == 1) {
            shards.plan = std::move(*head->plan);
            shards.checksum = head->checksum;
            continue;
        }
        if (const std::string lines = differences(shards.plan, shards.all.front(), *head->plan, shards.all.back());
            !lines.empty() && ++wrong <= max_lines) {
            errors += lines;
        }
    }
    if (shards.all.empty()) {
        throw CampaignError("none of the folders has results yet: run the shards first");
    }
    if (wrong > 0) {
        throw CampaignError(errors +
                            (wrong > max_lines ? fmt::format("{} more files differ\n", wrong - max_lines) : "") +
                            "shards of different settings are not merged: leave these out, or run them again with the "
                            "program and the campaign of the others");
    }
    std::stable_sort(shards.all.begin(), shards.all.end(), [](const Shard& a, const Shard& b) {
        return std::tie(a.number, a.folder) < std::tie(b.number, b.folder);
    });
    return shards;
}

/// Which shard has made which run.
class Origins {
 public:
    explicit Origins(const CampaignPlan& plan) : plan_(plan), shard_(plan.run_count(), none) {
        for (std::size_t i = 0; i < plan.seeds.size(); ++i) {
            place_of_seed_.emplace(plan.seeds[i], i);
        }
    }

    /// Takes note of a run. @return the shard that has made it already; none without one
    std::uint32_t add(const Run& run, std::uint32_t shard) {
        const auto seed = place_of_seed_.find(run.seed);
        if (seed == place_of_seed_.end()) {
            return none;  // the report leaves it out, too
        }
        std::uint32_t& maker = shard_[place(run.experiment, run.planner, seed->second)];
        return std::exchange(maker, maker == none ? shard : maker);
    }

    [[nodiscard]] bool has(std::size_t experiment, std::size_t planner, std::size_t seed) const {
        return shard_[place(experiment, planner, seed)] != none;
    }

    static constexpr std::uint32_t none = UINT32_MAX;

 private:
    [[nodiscard]] std::size_t place(std::size_t experiment, std::size_t planner, std::size_t seed) const {
        return (experiment * plan_.planners.size() + planner) * plan_.seeds.size() + seed;
    }

    const CampaignPlan& plan_;
    std::vector<std::uint32_t> shard_;
    std::map<std::uint32_t, std::size_t> place_of_seed_;
};

/// Runs that are in two files, for a message.
class Duplicates {
 public:
    void add(const CampaignPlan& plan, const Run& run, const Shard& first, const Shard& second) {
        if (++count_ <= max_lines) {
            lines_ += fmt::format("{} and {} both have the run of {}, {}, seed {}\n", first.file(), second.file(),
                                  plan.experiments[run.experiment].name(), plan.planners[run.planner].name(), run.seed);
        }
    }
    void require_none() const {
        if (count_ > 0) {
            throw CampaignError(
                lines_ +
                (count_ > max_lines ? fmt::format("{} more runs are in two files\n", count_ - max_lines) : "") +
                "a run counts once: leave one of the files out");
        }
    }

 private:
    std::size_t count_ = 0;
    std::string lines_;
};

/// The runs of all shards, written into a new file.
class Merge {
 public:
    Merge(const Shards& shards, const fs::path& file)
        : shards_(shards), database_(file, true), writer_(database_), origins_(shards.plan) {
        // The file appears when it is whole, so that it need not be so before. Foreign keys need no check: the writer
        // adds the rows of a run after the run itself.
        database_.execute(
            "PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF; PRAGMA cache_size = -64000; "
            "PRAGMA foreign_keys = OFF");
    }

    void write() {
        Transaction all(database_);
        write_plan(database_, shards_.plan, std::nullopt);
        Duplicates duplicates;
        for (std::uint32_t i = 0; i < shards_.all.size(); ++i) {
            read_runs_of(shards_.plan, shards_.checksum, shards_.all[i].folder, [&](Run&& run) {
                if (const std::uint32_t other = origins_.add(run, i); other != Origins::none) {
                    duplicates.add(shards_.plan, run, shards_.all[other], shards_.all[i]);
                    return;
                }
                writer_.add(std::move(run));
                ++done_;
            });
        }
        duplicates.require_none();
        writer_.count();
        all.commit();
    }

    [[nodiscard]] std::size_t done() const noexcept { return done_; }
    [[nodiscard]] const Origins& origins() const noexcept { return origins_; }
    [[nodiscard]] std::size_t processors() const {
        return database_.number("SELECT count(DISTINCT processor) FROM machines");
    }

 private:
    const Shards& shards_;
    Database database_;
    RunWriter writer_;
    Origins origins_;
    std::size_t done_ = 0;
};

/// What shards have not done.
std::vector<MissingRuns> missing_runs(const Shards& shards, const Origins& origins) {
    const CampaignPlan& plan = shards.plan;
    const ShardAssignment assignment(plan);
    std::map<std::uint64_t, MissingRuns> missing;
    for (std::size_t e = 0; e < plan.experiments.size(); ++e) {
        for (std::size_t p = 0; p < plan.planners.size(); ++p) {
            std::map<std::uint64_t, std::vector<std::uint32_t>> seeds;  // by shard
            for (std::size_t s = 0; s < plan.seeds.size(); ++s) {
                if (!origins.has(e, p, s)) {
                    seeds[assignment.shard_of(e, p, s)].push_back(plan.seeds[s]);
                }
            }
            for (const auto& [shard, of_cell] : seeds) {
                MissingRuns& runs = missing[shard];
                runs.count += of_cell.size();
                runs.runs +=
                    fmt::format("{}{}, {}: seed{} {}", runs.runs.empty() ? "" : "; ", plan.experiments[e].name(),
                                plan.planners[p].name(), of_cell.size() == 1 ? "" : "s", seeds_text(of_cell));
            }
        }
    }
    std::vector<MissingRuns> all;
    for (auto& [shard, runs] : missing) {
        runs.shard = shard;
        const auto known = std::find_if(shards.all.begin(), shards.all.end(),
                                        [number = shard](const Shard& each) { return each.number == number; });
        runs.folder = known != shards.all.end()
                          ? known->folder
                          : shards.all.front().folder.parent_path() / shard_folder_name(shard, plan.shards->count);
        all.push_back(std::move(runs));
    }
    return all;
}

/// A file that is removed unless it was moved to its place.
class PartFile {
 public:
    explicit PartFile(fs::path path) : path_(std::move(path)) { remove(); }
    ~PartFile() { remove(); }
    PartFile(const PartFile&) = delete;
    PartFile& operator=(const PartFile&) = delete;

    [[nodiscard]] const fs::path& path() const noexcept { return path_; }

 private:
    void remove() const {
        std::error_code ignored;
        fs::remove(path_, ignored);
    }

    fs::path path_;
};

}  // namespace

MergedCampaign merge_shards(const fs::path& out, const std::vector<fs::path>& folders, bool replaces) {
    const fs::path file = out / results_file;
    std::error_code unknown;
    if (!replaces && fs::exists(file, unknown)) {
        throw CampaignError(file.string() + " exists: choose another folder, or replace it with --force");
    }
    for (const fs::path& folder : folders) {
        if (fs::equivalent(folder, out, unknown)) {
            throw CampaignError(out.string() + " is one of the shards: choose another folder");
        }
    }
    const Shards shards = read_shards(folders);
    const CampaignLock lock(out);
    // The lock may hold on this machine only.
    const PartFile part(file.string() + "." + host_name() + ".part");
    MergedCampaign merged;
    {
        Merge merge(shards, part.path());
        merge.write();
        merged.done = merge.done();
        merged.processors = merge.processors();
        merged.missing = missing_runs(shards, merge.origins());
    }
    move_into_place(part.path(), file);
    merged.plan = shards.plan;
    return merged;
}

}  // namespace downwash::bench
