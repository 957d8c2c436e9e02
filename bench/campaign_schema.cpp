#include "downwash/bench/campaign_schema.hpp"

#include <array>

#include "downwash/base/version.hpp"
#include "downwash/bench/campaign_checksums.hpp"
#include "downwash/bench/machine.hpp"

namespace downwash::bench {
namespace {

/// "Down" in ASCII: identifies the SQLite file, also for file(1).
constexpr std::uint64_t application_id = 0x446f776e;
constexpr std::uint64_t layout_version = 8;

// OMPL's ompl_benchmark_statistics.py makes the first five tables, with the columns that it lets a log add to
// experiments, runs and progress. Planner Arena reads them.
constexpr const char* layout = R"(
CREATE TABLE experiments (
  id INTEGER PRIMARY KEY AUTOINCREMENT, name VARCHAR(512),
  totaltime REAL, timelimit REAL, memorylimit REAL, runcount INTEGER,
  version VARCHAR(128), hostname VARCHAR(1024), cpuinfo TEXT,
  date DATETIME, seed VARCHAR(24), setup TEXT,
  problem TEXT NOT NULL, objective TEXT NOT NULL);
CREATE TABLE plannerConfigs (
  id INTEGER PRIMARY KEY AUTOINCREMENT, name VARCHAR(512) NOT NULL, settings TEXT,
  variant TEXT NOT NULL, algorithm TEXT NOT NULL, margin_m REAL);
CREATE TABLE planner_parameters (
  plannerid INTEGER, name TEXT, value REAL NOT NULL, PRIMARY KEY (plannerid, name),
  FOREIGN KEY (plannerid) REFERENCES plannerConfigs(id) ON DELETE CASCADE);
CREATE TABLE enums (name VARCHAR(512), value INTEGER, description TEXT, PRIMARY KEY (name, value));
CREATE TABLE runs (
  id INTEGER PRIMARY KEY AUTOINCREMENT, experimentid INTEGER, plannerid INTEGER,
  seed INTEGER NOT NULL, time REAL, memory REAL, status ENUM, solved BOOLEAN, approximate_solution BOOLEAN,
  solution_difference REAL, correct_solution BOOLEAN, time_to_first_solution REAL, best_cost REAL, iterations INTEGER,
  edges_simulated INTEGER, states_checked INTEGER, simulated_time REAL, discarded_plans INTEGER,
  UNIQUE (experimentid, plannerid, seed),
  FOREIGN KEY (experimentid) REFERENCES experiments(id) ON DELETE CASCADE,
  FOREIGN KEY (plannerid) REFERENCES plannerConfigs(id) ON DELETE CASCADE);
CREATE TABLE progress (
  runid INTEGER, time REAL, iterations INTEGER, best_cost REAL, flown_cost REAL, PRIMARY KEY (runid, time),
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE);
CREATE TABLE flights (
  runid INTEGER PRIMARY KEY, outcome TEXT NOT NULL, cost REAL, energy_j REAL, duration_s REAL, length_m REAL,
  min_clearance_m REAL, goal_error_m REAL,
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE);
CREATE TABLE certificates (
  runid INTEGER PRIMARY KEY, given BOOLEAN NOT NULL, worlds INTEGER NOT NULL, failures INTEGER NOT NULL,
  attempts INTEGER NOT NULL, first_certified_s REAL,
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE);
CREATE TABLE world_flights (
  runid INTEGER PRIMARY KEY, worlds INTEGER NOT NULL, failures INTEGER NOT NULL,
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE);
CREATE TABLE parameter_flights (
  runid INTEGER, parameter TEXT, fails_low BOOLEAN NOT NULL, fails_high BOOLEAN NOT NULL, PRIMARY KEY (runid, parameter),
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE);
CREATE TABLE rejections (
  runid INTEGER, cause TEXT, edges INTEGER NOT NULL, PRIMARY KEY (runid, cause),
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE);
CREATE TABLE errors (
  runid INTEGER PRIMARY KEY, message TEXT NOT NULL,
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE);
CREATE TABLE checksums (
  runid INTEGER PRIMARY KEY, checksum TEXT NOT NULL,
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE);
CREATE TABLE campaign_checksum (checksum TEXT NOT NULL, finished_runs INTEGER NOT NULL);
CREATE TABLE campaign (place INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, value TEXT NOT NULL);
CREATE TABLE campaign_limits (
  time_limit_s REAL, stop_at_first_solution INTEGER NOT NULL, evaluation_worlds INTEGER NOT NULL);
CREATE TABLE left_out (place INTEGER PRIMARY KEY, what TEXT NOT NULL);
CREATE TABLE expectations (
  place INTEGER PRIMARY KEY, variant TEXT NOT NULL, algorithm TEXT, solved_ratio REAL, failed_flights INTEGER,
  first_solution_median_s REAL, first_solution_95_s REAL, verified_median_s REAL, cost_after_s REAL, cost_to_best REAL,
  cheaper_than TEXT, cheaper_than_after_s REAL, max_failure_share REAL, certified_ratio REAL,
  first_certified_median_s REAL);
CREATE TABLE campaign_seeds (place INTEGER PRIMARY KEY, first INTEGER NOT NULL, last INTEGER NOT NULL);
CREATE TABLE machines (
  id INTEGER PRIMARY KEY, host TEXT NOT NULL, processor TEXT NOT NULL, instruction_set TEXT NOT NULL,
  UNIQUE (host, processor, instruction_set));
CREATE TABLE run_machines (
  runid INTEGER PRIMARY KEY, machineid INTEGER NOT NULL, load REAL NOT NULL,
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE,
  FOREIGN KEY (machineid) REFERENCES machines(id));
CREATE TABLE shard (count INTEGER NOT NULL, number INTEGER);
CREATE TABLE shard_costs (place INTEGER PRIMARY KEY, microseconds INTEGER NOT NULL);
)";

/// In the order of CampaignExpectation.
constexpr const char* expectation_columns =
    "variant, algorithm, solved_ratio, failed_flights, first_solution_median_s, first_solution_95_s, "
    "verified_median_s, cost_after_s, cost_to_best, cheaper_than, cheaper_than_after_s, "
    "max_failure_share, certified_ratio, first_certified_median_s";

/// The first variant where none has that name: the checksum tells.
Variant variant_of(const std::string& name) {
    return named(name, all_variants).value_or(Variant::mp_arm);
}

std::string all_settings(const CampaignPlan& plan) {
    std::string text;
    for (const auto& [name, value] : plan.settings) {
        text.append(name).append(": ").append(value).append("\n");
    }
    return text;
}

void write_what_runs(const Database& database, const CampaignPlan& plan) {
    for (std::uint64_t i = 0; i < run_status_count; ++i) {
        database.insert("enums", "status", i, name_of(static_cast<RunStatus>(i)));
    }
    for (const Experiment& experiment : plan.experiments) {
        database.run(
            "INSERT INTO experiments (name, totaltime, timelimit, runcount, version, hostname, cpuinfo, date, seed, "
            "setup, problem, objective) VALUES (?, 0, ?, ?, ?, ?, ?, datetime('now'), ?, ?, ?, ?)",
            experiment.name(), plan.time_limit_s, std::uint64_t{plan.seeds.size()},
            "Downwash " + std::string(version()), host_name(), processor(), std::to_string(plan.seeds.at(0)),
            all_settings(plan), experiment.problem, experiment.objective);
    }
    for (std::size_t i = 0; i < plan.planners.size(); ++i) {
        const PlannerSetup& planner = plan.planners[i];
        database.insert("plannerConfigs (name, settings, variant, algorithm, margin_m)", planner.name(),
                        text_of(planner.parameters), downwash::name_of(planner.variant), planner.algorithm,
                        planner.margin_m);
        for (const auto& [name, value] : planner.parameters) {
            database.insert("planner_parameters", std::uint64_t{i + 1}, name, value);
        }
    }
}

using Schema = std::vector<std::array<std::string, 4>>;

/// Every table, index, view and trigger as it was made.
Schema schema_of(const Database& database) {
    Schema schema;
    database.for_each<std::string, std::string, std::string, std::string>(
        "SELECT type, name, tbl_name, sql FROM sqlite_master ORDER BY name",
        [&](const auto&... columns) { schema.push_back({columns...}); });
    return schema;
}

/// What schema_of() says of a file of ours.
const Schema& our_schema() {
    static const Schema schema = [] {
        const Database ours(":memory:", true);
        ours.execute(layout);
        return schema_of(ours);
    }();
    return schema;
}

std::vector<std::uint32_t> read_seeds(const Database& database) {
    std::vector<std::uint32_t> seeds;
    database.for_each<std::uint64_t, std::uint64_t>(
        "SELECT first, last FROM campaign_seeds ORDER BY place", [&](std::uint64_t first, std::uint64_t last) {
            // A damaged range may be endless: more seeds than any campaign has are enough for the checksum to differ.
            for (std::uint64_t seed = first; seed <= last && seeds.size() <= max_campaign_runs; ++seed) {
                seeds.push_back(static_cast<std::uint32_t>(seed));
            }
        });
    return seeds;
}

void write_shards(const Database& database, const ShardPlan& shards, std::optional<std::uint64_t> number) {
    database.insert("shard", shards.count, number);
    for (const std::uint64_t cost_us : shards.cell_costs_us) {
        database.insert("shard_costs (microseconds)", cost_us);
    }
}

void read_shards(const Database& database, CampaignPlan& plan) {
    database.for_each<std::uint64_t>("SELECT count FROM shard", [&](std::uint64_t count) {
        plan.shards = ShardPlan{count, {}};
    });
    if (plan.shards) {
        database.for_each<std::uint64_t>("SELECT microseconds FROM shard_costs ORDER BY place",
                                         [&](std::uint64_t cost_us) { plan.shards->cell_costs_us.push_back(cost_us); });
    }
}

}  // namespace

bool is_new(const Database& database) {
    return database.number("SELECT count(*) FROM sqlite_master") == 0;
}

void require_layout(const Database& database, const std::filesystem::path& file) {
    if (database.number("PRAGMA application_id") != application_id) {
        throw CampaignError(file.string() + " holds no results of a campaign; choose another folder");
    }
    const std::uint64_t version = database.number("PRAGMA user_version");
    if (version != layout_version) {
        throw CampaignError(file.string() + " holds no results that this version can read: its layout is number " +
                            std::to_string(version) + ", not " + std::to_string(layout_version) +
                            ". Report it with the version of downwash that wrote it, or run the campaign again into "
                            "another folder");
    }
    // A table may be a view that never ends, or have triggers that change what we read.
    if (schema_of(database) != our_schema()) {
        throw CampaignError(file.string() +
                            " has other tables than `downwash bench run` makes: it is damaged, or another program "
                            "wrote into it. Restore it from a copy, or run the campaign again into another folder");
    }
}

std::optional<std::uint64_t> shard_number(const Database& database) {
    std::optional<std::uint64_t> number;
    database.for_each<std::optional<std::uint64_t>>("SELECT number FROM shard",
                                                    [&](const auto& found) { number = found; });
    return number;
}

void write_plan(const Database& database, const CampaignPlan& plan, std::optional<std::uint64_t> shard) {
    database.execute("PRAGMA application_id = " + std::to_string(application_id));
    database.execute("PRAGMA user_version = " + std::to_string(layout_version));
    database.execute(layout);
    write_what_runs(database, plan);
    if (plan.shards) {
        write_shards(database, *plan.shards, shard);
    }
    for (const CampaignExpectation& target : plan.expectations) {
        database.insert("expectations (" + std::string(expectation_columns) + ")", downwash::name_of(target.variant),
                        target.algorithm, target.solved_ratio, target.failed_flights, target.first_solution_median_s,
                        target.first_solution_95_s, target.verified_median_s, target.cost_after_s, target.cost_to_best,
                        target.cheaper_than, target.cheaper_than_after_s, target.max_failure_share,
                        target.certified_ratio, target.first_certified_median_s);
    }
    for (const auto& [name, value] : plan.settings) {
        database.insert("campaign (name, value)", name, value);
    }
    for (const auto& [first, last] : ranges_of(plan.seeds)) {
        database.insert("campaign_seeds (first, last)", std::uint64_t{first}, std::uint64_t{last});
    }
    for (const std::string& what : plan.left_out) {
        database.insert("left_out (what)", what);
    }
    database.insert("campaign_limits", plan.time_limit_s, std::uint64_t{plan.stop_at_first_solution ? 1U : 0U},
                    plan.evaluation_worlds);
    database.insert("campaign_checksum", checksum_of(plan), std::uint64_t{0});
}

std::string stored_plan_checksum(const Database& database) {
    std::string checksum;
    database.for_each<std::string>("SELECT checksum FROM campaign_checksum",
                                   [&](const std::string& found) { checksum = found; });
    return checksum;
}

CampaignPlan read_plan(const Database& database, const std::filesystem::path& file) {
    using Text = std::string;
    using OptionalNumber = std::optional<double>;
    CampaignPlan plan;
    database.for_each<Text, Text>(
        "SELECT name, value FROM campaign ORDER BY place",
        [&](const Text& name, const Text& value) { plan.settings.emplace_back(name, value); });
    database.for_each<Text, Text>("SELECT problem, objective FROM experiments ORDER BY id",
                                  [&](const Text& problem, const Text& objective) {
                                      plan.experiments.push_back({problem, objective});
                                  });
    database.for_each<Text, Text, OptionalNumber>(
        "SELECT variant, algorithm, margin_m FROM plannerConfigs ORDER BY id",
        [&](const Text& variant, const Text& algorithm, const OptionalNumber& margin_m) {
            plan.planners.push_back({variant_of(variant), algorithm, margin_m, {}});
        });
    database.for_each<std::uint64_t, Text, double>("SELECT plannerid, name, value FROM planner_parameters",
                                                   [&](std::uint64_t planner, const Text& name, double value) {
                                                       if (planner >= 1 && planner <= plan.planners.size()) {
                                                           plan.planners[planner - 1].parameters[name] = value;
                                                       }
                                                   });
    plan.seeds = read_seeds(database);
    database.for_each<Text, std::optional<Text>, OptionalNumber, std::optional<std::uint64_t>, OptionalNumber,
                      OptionalNumber, OptionalNumber, OptionalNumber, OptionalNumber, std::optional<Text>,
                      OptionalNumber, OptionalNumber, OptionalNumber, OptionalNumber>(
        "SELECT " + std::string(expectation_columns) + " FROM expectations ORDER BY place",
        [&](const Text& variant, const auto&... rest) {
            plan.expectations.push_back({variant_of(variant), rest...});
        });
    database.for_each<Text>("SELECT what FROM left_out ORDER BY place",
                            [&](const Text& what) { plan.left_out.push_back(what); });
    database.for_each<OptionalNumber, std::uint64_t, std::uint64_t>(
        "SELECT time_limit_s, stop_at_first_solution, evaluation_worlds FROM campaign_limits",
        [&](const OptionalNumber& time_limit_s, std::uint64_t stops, std::uint64_t worlds) {
            plan.time_limit_s = time_limit_s;
            plan.stop_at_first_solution = stops != 0;
            plan.evaluation_worlds = worlds;
        });
    read_shards(database, plan);
    if (stored_plan_checksum(database) != checksum_of(plan)) {
        throw CampaignError(file.string() +
                            ": what says which runs belong to the campaign is damaged (settings, problems, planners, "
                            "seeds or targets). Restore the file from a copy, or run the campaign again into another "
                            "folder");
    }
    return plan;
}

std::string setting(const CampaignPlan& plan, std::string_view name) {
    for (const auto& [known, value] : plan.settings) {
        if (known == name) {
            return value;
        }
    }
    return "";
}

}  // namespace downwash::bench
