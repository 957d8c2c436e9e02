#include "downwash/bench/results_layout.hpp"

#include "downwash/base/version.hpp"

namespace downwash::bench {
namespace {

/// "Down" in ASCII: says to file(1) and to us whose SQLite file this is.
constexpr std::uint64_t application_id = 0x446f776e;
constexpr std::uint64_t layout_version = 3;

// The first five tables are those that OMPL's ompl_benchmark_statistics.py makes, with the columns that it lets a log
// add to experiments, runs and progress. Planner Arena reads them as they are.
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
CREATE TABLE refusals (
  runid INTEGER, cause TEXT, edges INTEGER NOT NULL, PRIMARY KEY (runid, cause),
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE);
CREATE TABLE faults (
  runid INTEGER PRIMARY KEY, message TEXT NOT NULL,
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE);
CREATE TABLE campaign (place INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, value TEXT NOT NULL);
CREATE TABLE campaign_limits (time_limit_s REAL, stop_at_first_solution INTEGER NOT NULL);
CREATE TABLE campaign_seeds (place INTEGER PRIMARY KEY, seed INTEGER NOT NULL UNIQUE);
CREATE TABLE left_out (place INTEGER PRIMARY KEY, what TEXT NOT NULL);
CREATE TABLE expectations (
  place INTEGER PRIMARY KEY, variant TEXT NOT NULL, algorithm TEXT, solved_ratio REAL, failed_flights INTEGER,
  first_solution_median_s REAL, first_solution_95_s REAL, verified_median_s REAL, cost_after_s REAL, cost_to_best REAL,
  cheaper_than TEXT, cheaper_than_after_s REAL);
)";

Variant variant_of(const std::string& name) {
    return named(name, {Variant::mp_arm, Variant::mp_arm_da, Variant::mp_arm_ada});
}

std::string all_settings(const CampaignPlan& plan) {
    std::string text;
    for (const auto& [name, value] : plan.settings) {
        text.append(name).append(": ").append(value).append("\n");
    }
    return text;
}

void write_enums(const Database& database) {
    for (std::uint64_t i = 0; i < run_status_count; ++i) {
        database.prepare("INSERT INTO enums VALUES ('status', ?, ?)")
            .bind(i)
            .bind(name_of(static_cast<RunStatus>(i)))
            .run();
    }
}

void write_what_runs(const Database& database, const CampaignPlan& plan) {
    for (const Experiment& experiment : plan.experiments) {
        database
            .prepare(
                "INSERT INTO experiments (name, totaltime, timelimit, runcount, version, hostname, cpuinfo, date, "
                "seed, setup, problem, objective) VALUES (?, 0, ?, ?, ?, ?, ?, datetime('now'), ?, ?, ?, ?)")
            .bind(experiment.name())
            .bind(plan.time_limit_s)
            .bind(std::uint64_t{plan.seeds.size()})
            .bind("Downwash " + std::string(version()))
            .bind(setting(plan, "host"))
            .bind(setting(plan, "processor"))
            .bind(std::to_string(plan.seeds.at(0)))
            .bind(all_settings(plan))
            .bind(experiment.problem)
            .bind(experiment.objective)
            .run();
    }
    for (const PlannerSetup& planner : plan.planners) {
        database
            .prepare(
                "INSERT INTO plannerConfigs (name, settings, variant, algorithm, margin_m) VALUES (?, '', ?, ?, ?)")
            .bind(planner.name())
            .bind(downwash::name_of(planner.variant))
            .bind(planner.algorithm)
            .bind(planner.margin_m)
            .run();
    }
}

void write_expectations(const Database& database, const CampaignPlan& plan) {
    for (const CampaignExpectation& bar : plan.expectations) {
        database
            .prepare(
                "INSERT INTO expectations (variant, algorithm, solved_ratio, failed_flights, first_solution_median_s, "
                "first_solution_95_s, verified_median_s, cost_after_s, cost_to_best, cheaper_than, "
                "cheaper_than_after_s) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
            .bind(downwash::name_of(bar.variant))
            .bind(bar.algorithm)
            .bind(bar.solved_ratio)
            .bind(bar.failed_flights)
            .bind(bar.first_solution_median_s)
            .bind(bar.first_solution_95_s)
            .bind(bar.verified_median_s)
            .bind(bar.cost_after_s)
            .bind(bar.cost_to_best)
            .bind(bar.cheaper_than)
            .bind(bar.cheaper_than_after_s)
            .run();
    }
}

std::uint64_t pragma(const Database& database, const std::string& name) {
    Statement ask = database.prepare("PRAGMA " + name);
    return ask.step() ? ask.integer(0) : 0;
}

}  // namespace

/// Whether nothing was written yet: SQLite makes an empty file, and a kill may leave one.
bool is_new(const Database& database) {
    Statement ask = database.prepare("SELECT count(*) FROM sqlite_master");
    return ask.step() && ask.integer(0) == 0;
}

void require_layout(const Database& database, const std::filesystem::path& file) {
    if (pragma(database, "application_id") != application_id || pragma(database, "user_version") != layout_version) {
        throw CampaignError(file.string() +
                            " holds no results of a campaign that this version can read; choose another "
                            "folder");
    }
}

void write_plan(const Database& database, const CampaignPlan& plan) {
    database.execute("PRAGMA application_id = " + std::to_string(application_id));
    database.execute("PRAGMA user_version = " + std::to_string(layout_version));
    database.execute(layout);
    write_enums(database);
    write_what_runs(database, plan);
    write_expectations(database, plan);
    for (const auto& [name, value] : plan.settings) {
        database.prepare("INSERT INTO campaign (name, value) VALUES (?, ?)").bind(name).bind(value).run();
    }
    for (const std::uint32_t seed : plan.seeds) {
        database.prepare("INSERT INTO campaign_seeds (seed) VALUES (?)").bind(std::uint64_t{seed}).run();
    }
    for (const std::string& what : plan.left_out) {
        database.prepare("INSERT INTO left_out (what) VALUES (?)").bind(what).run();
    }
    database.prepare("INSERT INTO campaign_limits VALUES (?, ?)")
        .bind(plan.time_limit_s)
        .bind(std::uint64_t{plan.stop_at_first_solution ? 1U : 0U})
        .run();
}

CampaignPlan read_plan(const Database& database) {
    CampaignPlan plan;
    for (Statement ask = database.prepare("SELECT name, value FROM campaign ORDER BY place"); ask.step();) {
        plan.settings.emplace_back(ask.text(0), ask.text(1));
    }
    for (Statement ask = database.prepare("SELECT problem, objective FROM experiments ORDER BY id"); ask.step();) {
        plan.experiments.push_back({ask.text(0), ask.text(1)});
    }
    for (Statement ask = database.prepare("SELECT variant, algorithm, margin_m FROM plannerConfigs ORDER BY id");
         ask.step();) {
        plan.planners.push_back({variant_of(ask.text(0)), ask.text(1), ask.optional_number(2)});
    }
    for (Statement ask = database.prepare("SELECT seed FROM campaign_seeds ORDER BY place"); ask.step();) {
        plan.seeds.push_back(static_cast<std::uint32_t>(ask.integer(0)));
    }
    for (Statement ask = database.prepare(
             "SELECT variant, algorithm, solved_ratio, failed_flights, first_solution_median_s, first_solution_95_s, "
             "verified_median_s, cost_after_s, cost_to_best, cheaper_than, cheaper_than_after_s FROM expectations "
             "ORDER BY place");
         ask.step();) {
        plan.expectations.push_back({variant_of(ask.text(0)), ask.optional_text(1), ask.optional_number(2),
                                     ask.optional_integer(3), ask.optional_number(4), ask.optional_number(5),
                                     ask.optional_number(6), ask.optional_number(7), ask.optional_number(8),
                                     ask.optional_text(9), ask.optional_number(10)});
    }
    for (Statement ask = database.prepare("SELECT what FROM left_out ORDER BY place"); ask.step();) {
        plan.left_out.push_back(ask.text(0));
    }
    Statement limits = database.prepare("SELECT time_limit_s, stop_at_first_solution FROM campaign_limits");
    if (limits.step()) {
        plan.time_limit_s = limits.optional_number(0);
        plan.stop_at_first_solution = limits.integer(1) != 0;
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
