#include "downwash/bench/campaign_store.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <system_error>

namespace downwash::bench {
namespace {

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
    for (const auto& now : plan.settings) {
        const auto then =
            std::find_if(begun.begin(), begun.end(), [&](const auto& other) { return other.first == now.first; });
        if (then == begun.end()) {
            differ(now.first, "none", now.second);
        } else if (then->second != now.second) {
            differ(now.first, then->second, now.second);
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
    run.error = row.is_null(13) ? "" : row.text(13);
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
    run.nearest_approach_m = row.optional_number(21);
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
            "solution_difference, correct_solution, time_to_first_solution, best_cost, iterations, edges_simulated, "
            "states_checked, "
            "simulated_time, discarded_plans) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
        .bind(std::uint64_t{run.experiment + 1})
        .bind(std::uint64_t{run.planner + 1})
        .bind(std::uint64_t{run.seed})
        .bind(run.wall_s)
        .bind(static_cast<std::uint64_t>(run.status))
        .bind(std::uint64_t{run.status == RunStatus::solved ? 1U : 0U})
        .bind(std::uint64_t{run.status == RunStatus::approximate ? 1U : 0U})
        .bind(run.nearest_approach_m)
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
        database_.prepare("INSERT OR REPLACE INTO progress VALUES (?, ?, ?, ?, ?)")
            .bind(key)
            .bind(improvement.wall_s)
            .bind(improvement.iteration)
            .bind(improvement.cost)
            .bind(improvement.flown_cost)
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
    if (!run.error.empty()) {
        database_.prepare("INSERT INTO faults VALUES (?, ?)").bind(key).bind(run.error).run();
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
             "duration_s, length_m, min_clearance_m, goal_error_m, solution_difference FROM runs LEFT JOIN flights ON "
             "runs.id = flights.runid LEFT JOIN faults ON runs.id = faults.runid ORDER BY id");
         row.step();) {
        place_of[row.integer(0)] = results.runs.size();
        results.runs.push_back(run_of(row));
        if (results.runs.back().experiment >= results.plan.experiments.size() ||
            results.runs.back().planner >= results.plan.planners.size()) {
            throw DatabaseError(file.string() + ": a run belongs to nothing: another program wrote into this file");
        }
    }
    for (Statement row = database.prepare(
             "SELECT runid, time, iterations, best_cost, flown_cost FROM progress ORDER BY runid, time");
         row.step();) {
        if (const auto found = place_of.find(row.integer(0)); found != place_of.end()) {
            results.runs[found->second].improvements.push_back(
                {row.number(1), row.integer(2), row.number(3), row.optional_number(4)});
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
