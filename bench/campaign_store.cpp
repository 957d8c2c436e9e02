#include "downwash/bench/campaign_store.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "downwash/bench/campaign_checksums.hpp"

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

/// As SQLite stores it.
std::uint64_t number(bool value) {
    return value ? 1U : 0U;
}

/// A run as a file can hold it: SQLite knows no NaN, and has one row for each cause and each time.
Run storable(Run run) {
    constexpr double unknown = std::numeric_limits<double>::infinity();
    constexpr std::size_t max_error_bytes = 10000;
    const auto make_known = [](double& number) { number = std::isnan(number) ? unknown : number; };
    const auto make_optional = [](std::optional<double>& number) {
        number = number && std::isnan(*number) ? std::nullopt : number;
    };
    std::vector<Improvement> improvements;
    for (Improvement& improvement : run.improvements) {
        make_known(improvement.wall_s);
        make_known(improvement.cost);
        make_optional(improvement.flown_cost);
        if (!improvements.empty() && improvement.wall_s <= improvements.back().wall_s) {
            improvements.pop_back();  // of two within one tick of the clock the later one is cheaper
        }
        improvements.push_back(improvement);
    }
    run.improvements = std::move(improvements);
    std::erase_if(run.rejections, [](const auto& cause) { return cause.second == 0; });
    for (auto* const number : {&run.first_solution_s, &run.cost, &run.nearest_approach_m, &run.first_certified_s}) {
        make_optional(*number);
    }
    if (run.flight) {
        auto& [outcome, cost, energy_j, duration_s, length_m, min_clearance_m, goal_error_m] = *run.flight;
        for (double* const figure : {&cost, &energy_j, &duration_s, &length_m, &min_clearance_m, &goal_error_m}) {
            make_known(*figure);
        }
    }
    if (!run.certificate) {
        run.first_certified_s.reset();
    }
    run.error.resize(std::min(run.error.size(), max_error_bytes));
    return run;
}

/// Tables of rows that belong to a run.
constexpr std::array of_run{"progress",          "flights",    "certificates", "world_flights",
                            "parameter_flights", "rejections", "errors",       "checksums"};

struct StoredRun {
    std::uint64_t key = 0;
    Run run;
    std::uint64_t is_solved = 0, is_approximate = 0, is_correct = 0;  ///< columns that follow from the others
    std::string checksum;                                             ///< that the run should have

    [[nodiscard]] bool is_damaged(const CampaignPlan& plan) const {
        return run.experiment >= plan.experiments.size() || run.planner >= plan.planners.size() ||
               static_cast<std::size_t>(run.status) >= run_status_count ||
               is_solved != number(run.status == RunStatus::solved) ||
               is_approximate != number(run.status == RunStatus::approximate) || is_correct != number(run.holds()) ||
               checksum_of(run) != checksum;
    }
    /// As much as can be said of it.
    [[nodiscard]] std::string name(const CampaignPlan& plan) const {
        return fmt::format(
            "run {}: problem {}, {}, seed {}", key,
            run.experiment < plan.experiments.size() ? plan.experiments[run.experiment].name() : "unknown",
            run.planner < plan.planners.size() ? plan.planners[run.planner].name() : "unknown planner", run.seed);
    }
};

/// All runs, damaged ones too, in the order of their keys.
std::vector<StoredRun> read_runs(const Database& database) {
    using Count = std::uint64_t;
    using Text = std::string;
    using OptionalNumber = std::optional<double>;
    std::vector<StoredRun> runs;
    std::map<Count, std::size_t> place_of;
    database.for_each<Count, Count, Count, Count, Count, Count, Count, Count, double, OptionalNumber, OptionalNumber,
                      OptionalNumber, Count, Count, Count, double, Count>(
        "SELECT id, experimentid, plannerid, seed, status, solved, approximate_solution, correct_solution, time, "
        "time_to_first_solution, best_cost, "
        "solution_difference, iterations, edges_simulated, states_checked, simulated_time, discarded_plans FROM runs "
        "ORDER BY id",
        [&](Count key, Count experiment, Count planner, Count seed, Count status, Count is_solved, Count is_approximate,
            Count is_correct, const auto&... figures) {
            place_of[key] = runs.size();
            const auto known_status = std::min<Count>(status, run_status_count);
            runs.push_back({key,
                            {experiment - 1,
                             planner - 1,
                             static_cast<std::uint32_t>(seed),
                             static_cast<RunStatus>(known_status),
                             figures...,
                             {},
                             {},
                             {},
                             {}},
                            is_solved,
                            is_approximate,
                            is_correct,
                            {}});
        });
    /// Calls take(run, column...) for every row of a table that belongs to a run.
    const auto rows_of_runs = [&]<class... Columns>(const char* sql, const auto& take) {
        database.for_each<Count, Columns...>(sql, [&](Count key, const Columns&... columns) {
            if (const auto found = place_of.find(key); found != place_of.end()) {
                take(runs[found->second], columns...);
            }
        });
    };
    rows_of_runs.operator()<Text>("SELECT runid, message FROM errors",
                                  [](StoredRun& of, const Text& error) { of.run.error = error; });
    rows_of_runs.operator()<Text, double, double, double, double, double, double>(
        "SELECT runid, outcome, cost, energy_j, duration_s, length_m, min_clearance_m, goal_error_m FROM flights",
        [](StoredRun& of, const Text& outcome, const auto&... figures) {
            if (const auto known =
                    named(outcome, {Outcome::ok, Outcome::collision, Outcome::unstable, Outcome::left_flyable_area,
                                    Outcome::goal_missed, Outcome::over_budget})) {
                of.run.flight = {*known, figures...};
            }
        });
    rows_of_runs.operator()<Count, Count, Count, Count, OptionalNumber>(
        "SELECT runid, given, worlds, failures, attempts, first_certified_s FROM certificates",
        [](StoredRun& of, Count is_given, Count worlds, Count failures, Count attempts, const OptionalNumber& first_s) {
            of.run.certificate = {is_given != 0, worlds, failures, attempts};
            of.run.first_certified_s = first_s;
        });
    rows_of_runs.operator()<Count, Count>("SELECT runid, worlds, failures FROM world_flights",
                                          [](StoredRun& of, Count worlds, Count failures) {
                                              of.run.in_worlds = WorldFigures{worlds, failures, {}};
                                          });
    rows_of_runs.operator()<Text, Count, Count>(
        "SELECT runid, parameter, fails_low, fails_high FROM parameter_flights ORDER BY runid, rowid",
        [](StoredRun& of, const Text& parameter, Count fails_low, Count fails_high) {
            if (of.run.in_worlds) {
                of.run.in_worlds->alone.push_back({parameter, fails_low != 0, fails_high != 0});
            }
        });
    rows_of_runs.operator()<double, Count, double, OptionalNumber>(
        "SELECT runid, time, iterations, best_cost, flown_cost FROM progress ORDER BY runid, time",
        [](StoredRun& of, const auto&... columns) { of.run.improvements.push_back({columns...}); });
    rows_of_runs.operator()<Text, Count>(
        "SELECT runid, cause, edges FROM rejections",
        [](StoredRun& of, const Text& cause, Count edges) { of.run.rejections[cause] = edges; });
    rows_of_runs.operator()<Text>("SELECT runid, checksum FROM checksums",
                                  [](StoredRun& of, const Text& checksum) { of.checksum = checksum; });
    return runs;
}

/// @throws CampaignError that names every damaged run
void require_whole(const Database& database, const CampaignPlan& plan, const std::vector<StoredRun>& runs,
                   const std::filesystem::path& folder) {
    const std::string file = (folder / results_file).string();
    constexpr int max_lines = 20;
    std::string errors;
    int damaged = 0;
    for (const StoredRun& each : runs) {
        if (each.is_damaged(plan) && ++damaged <= max_lines) {
            errors += file + ": " + each.name(plan) + ": is not what was written\n";
        }
    }
    if (damaged > max_lines) {
        errors += fmt::format("{}: {} more runs are not what was written\n", file, damaged - max_lines);
    }
    if (const std::uint64_t written = database.number("SELECT finished_runs FROM campaign_checksum");
        written != runs.size()) {
        errors += fmt::format("{}: {} runs were written, {} are there\n", file, written, runs.size());
    }
    if (!errors.empty()) {
        throw CampaignError(errors +
                            "the file is damaged: restore it from a copy, or repeat these runs with `downwash "
                            "bench run CAMPAIGN --resume --out " +
                            folder.string() + "`");
    }
}

/// Removes what is damaged, so that it is run again.
void remove_damaged(const Database& database, const CampaignPlan& plan, std::vector<StoredRun>& runs) {
    Transaction all(database);
    std::erase_if(runs, [&](const StoredRun& each) {
        const bool is_damaged = each.is_damaged(plan);
        if (is_damaged) {
            database.run("DELETE FROM runs WHERE id = ?", each.key);
        }
        return is_damaged;
    });
    for (const char* const table : of_run) {
        database.run(std::string("DELETE FROM ") + table + " WHERE runid NOT IN (SELECT id FROM runs)");
    }
    database.run(
        "UPDATE experiments SET totaltime = (SELECT total(time) FROM runs WHERE experimentid = experiments.id)");
    database.run("UPDATE campaign_checksum SET finished_runs = ?", std::uint64_t{runs.size()});
    all.commit();
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
    : lock_(folder), database_(folder / results_file, true) {
    if (is_new(database_)) {
        Transaction all(database_);
        write_plan(database_, plan);
        all.commit();
        return;
    }
    const std::filesystem::path file = folder / results_file;
    require_layout(database_, file);
    if (!resumes) {
        throw CampaignError(file.string() + " holds runs already; --resume continues with them");
    }
    const CampaignPlan begun = read_plan(database_, file);
    require_equal_settings(begun, plan, file);
    std::vector<StoredRun> runs = read_runs(database_);
    remove_damaged(database_, begun, runs);
    for (const StoredRun& each : runs) {
        done_.emplace(each.run.experiment, each.run.planner, each.run.seed);
    }
}

CampaignStore::~CampaignStore() = default;

void CampaignStore::add(const Run& finished) {
    const Run run = storable(finished);
    Transaction all(database_);
    database_.insert(
        "runs (experimentid, plannerid, seed, time, status, solved, approximate_solution, solution_difference, "
        "correct_solution, time_to_first_solution, best_cost, iterations, edges_simulated, states_checked, "
        "simulated_time, discarded_plans)",
        std::uint64_t{run.experiment + 1}, std::uint64_t{run.planner + 1}, std::uint64_t{run.seed}, run.wall_s,
        static_cast<std::uint64_t>(run.status), number(run.status == RunStatus::solved),
        number(run.status == RunStatus::approximate), run.nearest_approach_m, number(run.holds()), run.first_solution_s,
        run.cost, run.iterations, run.edges_simulated, run.states_checked, run.simulated_s, run.discarded);
    const std::uint64_t key = database_.last_key();
    for (const Improvement& improvement : run.improvements) {
        database_.insert("progress", key, improvement.wall_s, improvement.iteration, improvement.cost,
                         improvement.flown_cost);
    }
    for (const auto& [cause, edges] : run.rejections) {
        database_.insert("rejections", key, cause, edges);
    }
    if (run.flight) {
        const FlightFigures& flight = *run.flight;
        database_.insert("flights", key, downwash::name_of(flight.outcome), flight.cost, flight.energy_j,
                         flight.duration_s, flight.length_m, flight.min_clearance_m, flight.goal_error_m);
    }
    if (run.certificate) {
        const CertificateFigures& certificate = *run.certificate;
        database_.insert("certificates", key, number(certificate.is_given), certificate.worlds, certificate.failures,
                         certificate.attempts, run.first_certified_s);
    }
    if (run.in_worlds) {
        database_.insert("world_flights", key, run.in_worlds->worlds, run.in_worlds->failures);
        for (const ParameterFlights& flights : run.in_worlds->alone) {
            database_.insert("parameter_flights", key, flights.parameter, number(flights.fails_low),
                             number(flights.fails_high));
        }
    }
    if (!run.error.empty()) {
        database_.insert("errors", key, run.error);
    }
    database_.insert("checksums", key, checksum_of(run));
    database_.run("UPDATE campaign_checksum SET finished_runs = finished_runs + 1");
    database_.run("UPDATE experiments SET totaltime = totaltime + ? WHERE id = ?", run.wall_s,
                  std::uint64_t{run.experiment + 1});
    all.commit();
    done_.emplace(run.experiment, run.planner, run.seed);
}

CampaignResults read_results(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / results_file;
    if (!std::filesystem::exists(file)) {
        throw CampaignError(file.string() +
                            " does not exist: expected the folder of a campaign that `downwash bench run` made");
    }
    const Database database(file);
    const Transaction all(database, Transaction::Kind::reading);
    require_layout(database, file);
    CampaignResults results{read_plan(database, file), {}};
    std::vector<StoredRun> runs = read_runs(database);
    require_whole(database, results.plan, runs, folder);
    for (StoredRun& each : runs) {
        results.runs.push_back(std::move(each.run));
    }
    return results;
}

}  // namespace downwash::bench
