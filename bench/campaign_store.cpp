#include "downwash/bench/campaign_store.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <fmt/core.h>

#include <cerrno>
#include <map>
#include <optional>
#include <system_error>

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

/// The columns of runs, flights and errors that read_results() reads, in the order of its function.
constexpr const char* run_columns =
    "id, experimentid, plannerid, seed, time, status, time_to_first_solution, best_cost, iterations, edges_simulated, "
    "states_checked, simulated_time, discarded_plans, message, solution_difference";

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
    require_equal_settings(read_plan(database_), plan, file);
    database_.for_each<std::uint64_t, std::uint64_t, std::uint64_t>(
        "SELECT experimentid, plannerid, seed FROM runs", [this](auto experiment, auto planner, auto seed) {
            done_.emplace(experiment - 1, planner - 1, static_cast<std::uint32_t>(seed));
        });
}

CampaignStore::~CampaignStore() = default;

void CampaignStore::add(const Run& run) {
    const auto number = [](bool value) { return std::uint64_t{value ? 1U : 0U}; };
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
        // Of two within one tick of the clock the later one is cheaper.
        database_.run("INSERT OR REPLACE INTO progress VALUES (?, ?, ?, ?, ?)", key, improvement.wall_s,
                      improvement.iteration, improvement.cost, improvement.flown_cost);
    }
    for (const auto& [cause, edges] : run.rejections) {
        if (edges > 0) {
            database_.insert("rejections", key, cause, edges);
        }
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
    database_.run("UPDATE experiments SET totaltime = totaltime + ? WHERE id = ?", run.wall_s,
                  std::uint64_t{run.experiment + 1});
    all.commit();
    done_.emplace(run.experiment, run.planner, run.seed);
}

CampaignResults read_results(const std::filesystem::path& folder) {
    using Count = std::uint64_t;
    using Text = std::string;
    using OptionalNumber = std::optional<double>;
    const std::filesystem::path file = folder / results_file;
    if (!std::filesystem::exists(file)) {
        throw CampaignError(file.string() +
                            " does not exist: expected the folder of a campaign that `downwash bench run` made");
    }
    const Database database(file);
    require_layout(database, file);
    CampaignResults results{read_plan(database), {}};
    std::map<Count, std::size_t> place_of;
    database.for_each<Count, Count, Count, Count, double, Count, OptionalNumber, OptionalNumber, Count, Count, Count,
                      double, Count, std::optional<Text>, OptionalNumber>(
        "SELECT " + std::string(run_columns) + " FROM runs LEFT JOIN errors ON runs.id = errors.runid ORDER BY id",
        [&](Count key, Count experiment, Count planner, Count seed, double wall_s, Count status,
            const OptionalNumber& first_solution_s, const OptionalNumber& cost, Count iterations, Count edges,
            Count states, double simulated_s, Count discarded, const std::optional<Text>& error,
            const OptionalNumber& nearest_approach_m) {
            if (status >= run_status_count || experiment < 1 || experiment > results.plan.experiments.size() ||
                planner < 1 || planner > results.plan.planners.size()) {
                throw DatabaseError(
                    file.string() +
                    ": a run has no status, experiment or planner: another program wrote into this file");
            }
            place_of[key] = results.runs.size();
            results.runs.push_back({experiment - 1,
                                    planner - 1,
                                    static_cast<std::uint32_t>(seed),
                                    static_cast<RunStatus>(status),
                                    wall_s,
                                    first_solution_s,
                                    cost,
                                    nearest_approach_m,
                                    iterations,
                                    edges,
                                    states,
                                    simulated_s,
                                    discarded,
                                    {},
                                    {},
                                    {},
                                    error.value_or("")});
        });
    /// Calls take(run, column...) for every row of a table that belongs to a run.
    const auto of_runs = [&]<class... Columns>(const char* sql, const auto& take) {
        database.for_each<Count, Columns...>(sql, [&](Count key, const Columns&... columns) {
            if (const auto found = place_of.find(key); found != place_of.end()) {
                take(results.runs[found->second], columns...);
            }
        });
    };
    of_runs.operator()<Text, double, double, double, double, double, double>(
        "SELECT runid, outcome, cost, energy_j, duration_s, length_m, min_clearance_m, goal_error_m FROM flights",
        [](Run& run, const Text& outcome, const auto&... figures) {
            run.flight = {named(outcome, {Outcome::ok, Outcome::collision, Outcome::unstable,
                                          Outcome::left_flyable_area, Outcome::goal_missed}),
                          figures...};
        });
    of_runs.operator()<Count, Count, Count, Count, OptionalNumber>(
        "SELECT runid, given, worlds, failures, attempts, first_certified_s FROM certificates",
        [](Run& run, Count is_given, Count worlds, Count failures, Count attempts, const OptionalNumber& first_s) {
            run.certificate = {is_given != 0, worlds, failures, attempts};
            run.first_certified_s = first_s;
        });
    of_runs.operator()<Count, Count>("SELECT runid, worlds, failures FROM world_flights",
                                     [](Run& run, Count worlds, Count failures) {
                                         run.in_worlds = WorldFigures{worlds, failures, {}};
                                     });
    of_runs.operator()<Text, Count, Count>(
        "SELECT runid, parameter, fails_low, fails_high FROM parameter_flights ORDER BY runid, rowid",
        [](Run& run, const Text& parameter, Count fails_low, Count fails_high) {
            if (run.in_worlds) {
                run.in_worlds->alone.push_back({parameter, fails_low != 0, fails_high != 0});
            }
        });
    of_runs.operator()<double, Count, double, OptionalNumber>(
        "SELECT runid, time, iterations, best_cost, flown_cost FROM progress ORDER BY runid, time",
        [](Run& run, const auto&... columns) { run.improvements.push_back({columns...}); });
    of_runs.operator()<Text, Count>("SELECT runid, cause, edges FROM rejections",
                                    [](Run& run, const Text& cause, Count edges) { run.rejections[cause] = edges; });
    return results;
}

}  // namespace downwash::bench
