#include "downwash/bench/campaign_store.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <system_error>

#include "downwash/base/text.hpp"
#include "downwash/base/version.hpp"

namespace downwash::bench {
namespace {

/// "Down" in ASCII: says to file(1) and to us whose SQLite file this is.
constexpr std::uint64_t application_id = 0x446f776e;
constexpr std::uint64_t layout_version = 1;

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
  correct_solution BOOLEAN, time_to_first_solution REAL, best_cost REAL, iterations INTEGER, edges_simulated INTEGER,
  states_checked INTEGER, simulated_time REAL, discarded_plans INTEGER,
  UNIQUE (experimentid, plannerid, seed),
  FOREIGN KEY (experimentid) REFERENCES experiments(id) ON DELETE CASCADE,
  FOREIGN KEY (plannerid) REFERENCES plannerConfigs(id) ON DELETE CASCADE);
CREATE TABLE progress (
  runid INTEGER, time REAL, iterations INTEGER, best_cost REAL, PRIMARY KEY (runid, time),
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
  place INTEGER PRIMARY KEY, variant TEXT NOT NULL, solved_ratio REAL, failed_flights INTEGER,
  first_solution_median_s REAL, first_solution_95_s REAL);
)";

/// The value whose name that is. @throws DatabaseError when none has it
template <class Enumeration>
Enumeration named(const std::string& name, std::initializer_list<Enumeration> values) {
    for (const Enumeration value : values) {
        if (name_of(value) == name) {
            return value;
        }
    }
    throw DatabaseError(results_file + (": there is no '" + excerpt(name)) + "': another program wrote into this file");
}

Variant variant_of(const std::string& name) {
    return named(name, {Variant::mp_arm, Variant::mp_arm_da, Variant::mp_arm_ada});
}

std::string setting(const CampaignPlan& plan, std::string_view name) {
    for (const auto& [known, value] : plan.settings) {
        if (known == name) {
            return value;
        }
    }
    return "";
}

std::string all_settings(const CampaignPlan& plan) {
    std::string text;
    for (const auto& [name, value] : plan.settings) {
        text += name + ": " + value + "\n";
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
            .bind(downwash::name_of(experiment.objective))
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
                "INSERT INTO expectations (variant, solved_ratio, failed_flights, first_solution_median_s, "
                "first_solution_95_s) VALUES (?, ?, ?, ?, ?)")
            .bind(downwash::name_of(bar.variant))
            .bind(bar.solved_ratio)
            .bind(bar.failed_flights)
            .bind(bar.first_solution_median_s)
            .bind(bar.first_solution_95_s)
            .run();
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

std::uint64_t pragma(const Database& database, const std::string& name) {
    Statement ask = database.prepare("PRAGMA " + name);
    return ask.step() ? ask.integer(0) : 0;
}

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

/// Says what differs from the settings that the file was begun with.
void require_equal_settings(const Database& database, const CampaignPlan& plan, const std::filesystem::path& file) {
    std::string differences;
    const auto differ = [&](const std::string& name, const std::string& begun, const std::string& now) {
        differences += (differences.empty() ? "" : "\n") + file.string() + " was begun with " + name + " " + begun +
                       ", not " + now;
    };
    std::vector<std::pair<std::string, std::string>> begun;
    for (Statement ask = database.prepare("SELECT name, value FROM campaign ORDER BY place"); ask.step();) {
        begun.emplace_back(ask.text(0), ask.text(1));
    }
    for (const auto& [name, value] : plan.settings) {
        const auto found =
            std::find_if(begun.begin(), begun.end(), [&](const auto& other) { return other.first == name; });
        if (found == begun.end()) {
            differ(name, "none", value);
        } else if (found->second != value) {
            differ(name, found->second, value);
        }
    }
    for (const auto& [name, value] : begun) {
        if (setting(plan, name).empty()) {
            differ(name, value, "without");
        }
    }
    if (!differences.empty()) {
        throw CampaignError(
            differences +
            "\nruns of different settings are not mixed: choose another folder with --out, or move this "
            "one away");
    }
}

CampaignPlan read_plan(const Database& database) {
    CampaignPlan plan;
    for (Statement ask = database.prepare("SELECT name, value FROM campaign ORDER BY place"); ask.step();) {
        plan.settings.emplace_back(ask.text(0), ask.text(1));
    }
    for (Statement ask = database.prepare("SELECT problem, objective FROM experiments ORDER BY id"); ask.step();) {
        plan.experiments.push_back({ask.text(0), named(ask.text(1), {Objective::energy, Objective::time,
                                                                     Objective::length, Objective::clearance})});
    }
    for (Statement ask = database.prepare("SELECT variant, algorithm, margin_m FROM plannerConfigs ORDER BY id");
         ask.step();) {
        plan.planners.push_back({variant_of(ask.text(0)), ask.text(1), ask.optional_number(2)});
    }
    for (Statement ask = database.prepare("SELECT seed FROM campaign_seeds ORDER BY place"); ask.step();) {
        plan.seeds.push_back(static_cast<std::uint32_t>(ask.integer(0)));
    }
    for (Statement ask = database.prepare("SELECT variant, solved_ratio, failed_flights, first_solution_median_s, "
                                          "first_solution_95_s FROM expectations ORDER BY place");
         ask.step();) {
        plan.expectations.push_back({variant_of(ask.text(0)), ask.optional_number(1), ask.optional_integer(2),
                                     ask.optional_number(3), ask.optional_number(4)});
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

Run run_of(const Statement& row) {
    Run run;
    run.experiment = row.integer(1) - 1;
    run.planner = row.integer(2) - 1;
    run.seed = static_cast<std::uint32_t>(row.integer(3));
    run.wall_s = row.number(4);
    if (row.integer(5) >= run_status_count) {
        throw DatabaseError(std::string(results_file) + ": a run has an unknown status: another program wrote into it");
    }
    run.status = static_cast<RunStatus>(row.integer(5));
    run.first_solution_s = row.optional_number(6);
    run.cost = row.optional_number(7);
    run.iterations = row.integer(8);
    run.edges_simulated = row.integer(9);
    run.states_checked = row.integer(10);
    run.simulated_s = row.number(11);
    run.discarded = row.integer(12);
    run.fault = row.is_null(13) ? "" : row.text(13);
    if (!row.is_null(14)) {
        run.flight = FlightFigures{named(row.text(14), {Outcome::ok, Outcome::collision, Outcome::unstable,
                                                        Outcome::left_flyable_area, Outcome::goal_missed}),
                                   row.number(15),
                                   row.number(16),
                                   row.number(17),
                                   row.number(18),
                                   row.number(19),
                                   row.number(20)};
    }
    return run;
}

}  // namespace

CampaignStore::FolderLock::FolderLock(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    descriptor_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor_ < 0) {
        throw CampaignError(folder.string() + " cannot be made a folder: " +
                            (error ? error.message() : std::generic_category().message(errno)));
    }
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
        close(descriptor_);
        throw CampaignError("another program is running the campaign in " + folder.string());
    }
}

CampaignStore::FolderLock::~FolderLock() {
    close(descriptor_);
}

CampaignStore::CampaignStore(const std::filesystem::path& folder, const CampaignPlan& plan, bool resumes)
    : lock_(folder), database_(folder / results_file, Database::Access::create) {
    if (is_new(database_)) {
        Transaction all(database_);
        write_plan(database_, plan);
        all.commit();
        return;
    }
    const std::filesystem::path file = folder / results_file;
    require_layout(database_, file);
    if (!resumes) {
        throw CampaignError(file.string() + " holds runs already; --resume goes on with them");
    }
    require_equal_settings(database_, plan, file);
    for (Statement ask = database_.prepare("SELECT experimentid, plannerid, seed FROM runs"); ask.step();) {
        done_.emplace(ask.integer(0) - 1, ask.integer(1) - 1, static_cast<std::uint32_t>(ask.integer(2)));
    }
}

CampaignStore::~CampaignStore() = default;

void CampaignStore::add(const Run& run) {
    Transaction all(database_);
    database_
        .prepare(
            "INSERT INTO runs (experimentid, plannerid, seed, time, status, solved, approximate_solution, "
            "correct_solution, time_to_first_solution, best_cost, iterations, edges_simulated, states_checked, "
            "simulated_time, discarded_plans) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
        .bind(std::uint64_t{run.experiment + 1})
        .bind(std::uint64_t{run.planner + 1})
        .bind(std::uint64_t{run.seed})
        .bind(run.wall_s)
        .bind(static_cast<std::uint64_t>(run.status))
        .bind(std::uint64_t{run.status == RunStatus::solved ? 1U : 0U})
        .bind(std::uint64_t{run.status == RunStatus::approximate ? 1U : 0U})
        .bind(std::uint64_t{run.holds() ? 1U : 0U})
        .bind(run.first_solution_s)
        .bind(run.cost)
        .bind(run.iterations)
        .bind(run.edges_simulated)
        .bind(run.states_checked)
        .bind(run.simulated_s)
        .bind(run.discarded)
        .run();
    const std::uint64_t key = database_.last_key();
    for (const Improvement& improvement : run.improvements) {
        // Two within one tick of the clock: the later one is cheaper.
        database_.prepare("INSERT OR REPLACE INTO progress (runid, time, iterations, best_cost) VALUES (?, ?, ?, ?)")
            .bind(key)
            .bind(improvement.wall_s)
            .bind(improvement.iteration)
            .bind(improvement.cost)
            .run();
    }
    for (const auto& [cause, edges] : run.refusals) {
        if (edges > 0) {
            database_.prepare("INSERT INTO refusals VALUES (?, ?, ?)").bind(key).bind(cause).bind(edges).run();
        }
    }
    if (run.flight) {
        const FlightFigures& flight = *run.flight;
        database_.prepare("INSERT INTO flights VALUES (?, ?, ?, ?, ?, ?, ?, ?)")
            .bind(key)
            .bind(downwash::name_of(flight.outcome))
            .bind(flight.cost)
            .bind(flight.energy_j)
            .bind(flight.duration_s)
            .bind(flight.length_m)
            .bind(flight.min_clearance_m)
            .bind(flight.goal_error_m)
            .run();
    }
    if (!run.fault.empty()) {
        database_.prepare("INSERT INTO faults VALUES (?, ?)").bind(key).bind(run.fault).run();
    }
    database_.prepare("UPDATE experiments SET totaltime = totaltime + ? WHERE id = ?")
        .bind(run.wall_s)
        .bind(std::uint64_t{run.experiment + 1})
        .run();
    all.commit();
    done_.emplace(run.experiment, run.planner, run.seed);
}

CampaignResults read_results(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / results_file;
    if (!std::filesystem::exists(file)) {
        throw CampaignError(file.string() +
                            " does not exist: expected the folder of a campaign that `downwash bench run` "
                            "made");
    }
    const Database database(file, Database::Access::read);
    require_layout(database, file);
    CampaignResults results{read_plan(database), {}};
    std::map<std::uint64_t, std::size_t> place_of;
    for (Statement row = database.prepare(
             "SELECT id, experimentid, plannerid, seed, time, status, time_to_first_solution, best_cost, iterations, "
             "edges_simulated, states_checked, simulated_time, discarded_plans, message, outcome, cost, energy_j, "
             "duration_s, length_m, min_clearance_m, goal_error_m FROM runs LEFT JOIN flights ON runs.id = "
             "flights.runid "
             "LEFT JOIN faults ON runs.id = faults.runid ORDER BY id");
         row.step();) {
        place_of[row.integer(0)] = results.runs.size();
        results.runs.push_back(run_of(row));
        if (results.runs.back().experiment >= results.plan.experiments.size() ||
            results.runs.back().planner >= results.plan.planners.size()) {
            throw DatabaseError(file.string() + ": a run belongs to nothing: another program wrote into this file");
        }
    }
    for (Statement row =
             database.prepare("SELECT runid, time, iterations, best_cost FROM progress ORDER BY runid, time");
         row.step();) {
        if (const auto found = place_of.find(row.integer(0)); found != place_of.end()) {
            results.runs[found->second].improvements.push_back({row.number(1), row.integer(2), row.number(3)});
        }
    }
    for (Statement row = database.prepare("SELECT runid, cause, edges FROM refusals"); row.step();) {
        if (const auto found = place_of.find(row.integer(0)); found != place_of.end()) {
            results.runs[found->second].refusals[row.text(1)] = row.integer(2);
        }
    }
    return results;
}

}  // namespace downwash::bench
