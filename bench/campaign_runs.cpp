#include "downwash/bench/campaign_runs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "downwash/bench/campaign_checksums.hpp"
#include "downwash/bench/campaign_schema.hpp"

namespace downwash::bench {
namespace {

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
constexpr std::array of_run{"progress",   "flights", "certificates", "world_flights", "parameter_flights",
                            "rejections", "errors",  "checksums",    "run_machines"};

/// Reads runs in blocks of keys, so that a file of any size needs little memory.
class BlockReader {
 public:
    explicit BlockReader(const Database& database) : database_(database) {
        database.for_each<Count, Text, Text, Text>(
            "SELECT id, host, processor, instruction_set FROM machines",
            [&](Count key, const auto&... columns) { machines_[key] = {columns...}; });
    }

    /// The next runs; none after the last one. They are valid until the next call.
    std::vector<StoredRun>& next() {
        runs_.clear();
        read_columns();
        if (!runs_.empty()) {
            const std::optional<std::int64_t> before = last_;
            last_ = static_cast<std::int64_t>(runs_.back().key);
            if (before && *last_ <= *before) {  // would never end
                throw CampaignError(database_.file() +
                                    ": the file is damaged: restore it from a copy, or run the campaign again into "
                                    "another folder");
            }
            range_ = fmt::format("runid BETWEEN {} AND {}", static_cast<std::int64_t>(runs_.front().key), *last_);
            read_flights();
            read_worlds();
            read_search();
            read_machines();
        }
        return runs_;
    }

 private:
    using Count = std::uint64_t;
    using Text = std::string;
    using OptionalNumber = std::optional<double>;

    void read_columns() {
        constexpr int block_runs = 2000;
        database_.for_each<Count, Count, Count, Count, Count, Count, Count, Count, double, OptionalNumber,
                           OptionalNumber, OptionalNumber, Count, Count, Count, double, Count>(
            fmt::format("SELECT id, experimentid, plannerid, seed, status, solved, approximate_solution, "
                        "correct_solution, time, time_to_first_solution, best_cost, solution_difference, iterations, "
                        "edges_simulated, states_checked, simulated_time, discarded_plans FROM runs {} ORDER BY id "
                        "LIMIT {}",
                        last_ ? fmt::format("WHERE id > {}", *last_) : "", block_runs),
            [&](Count key, Count experiment, Count planner, Count seed, Count status, Count is_solved,
                Count is_approximate, Count is_correct, const auto&... figures) {
                const auto known_status = std::min<Count>(status, run_status_count);
                runs_.push_back({key,
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
    }

    /// Calls take(run, column...) for every row of a table that belongs to a run of the block.
    template <class... Columns, class Take>
    void rows(const char* columns, const char* table, const char* order, const Take& take) {
        database_.for_each<Count, Columns...>(
            fmt::format("SELECT runid, {} FROM {} WHERE {} {}", columns, table, range_, order),
            [&](Count key, const Columns&... values) {
                const auto found = std::lower_bound(  // in a damaged file keys may be negative
                    runs_.begin(), runs_.end(), key, [](const StoredRun& run, Count of) {
                        return static_cast<std::int64_t>(run.key) < static_cast<std::int64_t>(of);
                    });
                if (found != runs_.end() && found->key == key) {
                    take(*found, values...);
                }
            });
    }

    void read_flights() {
        rows<Text>("message", "errors", "", [](StoredRun& of, const Text& error) { of.run.error = error; });
        rows<Text, double, double, double, double, double, double>(
            "outcome, cost, energy_j, duration_s, length_m, min_clearance_m, goal_error_m", "flights", "",
            [](StoredRun& of, const Text& outcome, const auto&... figures) {
                if (const auto known = named(
                        outcome, std::array{Outcome::ok, Outcome::collision, Outcome::unstable,
                                            Outcome::left_flyable_area, Outcome::goal_missed, Outcome::over_budget})) {
                    of.run.flight = {*known, figures...};
                }
            });
    }

    void read_worlds() {
        rows<Count, Count, Count, Count, OptionalNumber>(
            "given, worlds, failures, attempts, first_certified_s", "certificates", "",
            [](StoredRun& of, Count is_given, Count worlds, Count failures, Count attempts,
               const OptionalNumber& first_s) {
                of.run.certificate = {is_given != 0, worlds, failures, attempts};
                of.run.first_certified_s = first_s;
            });
        rows<Count, Count>("worlds, failures", "world_flights", "", [](StoredRun& of, Count worlds, Count failures) {
            of.run.in_worlds = WorldFigures{worlds, failures, {}};
        });
        rows<Text, Count, Count>(
            "parameter, fails_low, fails_high", "parameter_flights", "ORDER BY runid, rowid",
            [](StoredRun& of, const Text& parameter, Count fails_low, Count fails_high) {
                if (of.run.in_worlds) {
                    of.run.in_worlds->alone.push_back({parameter, fails_low != 0, fails_high != 0});
                }
            });
    }

    void read_search() {
        rows<double, Count, double, OptionalNumber>(
            "time, iterations, best_cost, flown_cost", "progress", "ORDER BY runid, time",
            [](StoredRun& of, const auto&... columns) { of.run.improvements.push_back({columns...}); });
        rows<Text, Count>("cause, edges", "rejections", "",
                          [](StoredRun& of, const Text& cause, Count edges) { of.run.rejections[cause] = edges; });
        rows<Text>("checksum", "checksums", "", [](StoredRun& of, const Text& checksum) { of.checksum = checksum; });
    }

    void read_machines() {
        rows<Count, double>("machineid, load", "run_machines", "", [&](StoredRun& of, Count machine, double load) {
            if (const auto found = machines_.find(machine); found != machines_.end()) {
                of.run.made_on = {found->second, load};
            }
        });
    }

    const Database& database_;
    std::map<Count, Machine> machines_;
    std::optional<std::int64_t> last_;
    std::string range_;
    std::vector<StoredRun> runs_;
};

}  // namespace

bool StoredRun::is_damaged(const CampaignPlan& plan) const {
    return run.experiment >= plan.experiments.size() || run.planner >= plan.planners.size() ||
           static_cast<std::size_t>(run.status) >= run_status_count ||
           is_solved != number(run.status == RunStatus::solved) ||
           is_approximate != number(run.status == RunStatus::approximate) || is_correct != number(run.holds()) ||
           checksum_of(run) != checksum;
}

std::string StoredRun::name(const CampaignPlan& plan) const {
    return fmt::format("run {}: problem {}, {}, seed {}", key,
                       run.experiment < plan.experiments.size() ? plan.experiments[run.experiment].name() : "unknown",
                       run.planner < plan.planners.size() ? plan.planners[run.planner].name() : "unknown planner",
                       run.seed);
}

void for_each_run(const Database& database, const std::function<void(StoredRun&&)>& take) {
    BlockReader reader(database);
    for (std::vector<StoredRun>* block = &reader.next(); !block->empty(); block = &reader.next()) {
        std::for_each(block->begin(), block->end(), [&](StoredRun& run) { take(std::move(run)); });
    }
}

std::set<RunKey> remove_damaged_runs(const Database& database, const CampaignPlan& plan) {
    Transaction all(database);
    std::set<RunKey> whole;
    std::vector<std::uint64_t> damaged;
    for_each_run(database, [&](const StoredRun& each) {
        if (each.is_damaged(plan)) {
            damaged.push_back(each.key);
        } else {
            whole.emplace(each.run.experiment, each.run.planner, each.run.seed);
        }
    });
    for (const std::uint64_t key : damaged) {
        database.run("DELETE FROM runs WHERE id = ?", key);
    }
    for (const char* const table : of_run) {
        database.run(std::string("DELETE FROM ") + table + " WHERE runid NOT IN (SELECT id FROM runs)");
    }
    database.run(
        "UPDATE experiments SET totaltime = (SELECT total(time) FROM runs WHERE experimentid = experiments.id)");
    database.run("UPDATE campaign_checksum SET finished_runs = ?", std::uint64_t{whole.size()});
    all.commit();
    return whole;
}

void RunWriter::add(Run finished) {
    const Run run = storable(std::move(finished));
    database_.insert(
        "runs (experimentid, plannerid, seed, time, status, solved, approximate_solution, solution_difference, "
        "correct_solution, time_to_first_solution, best_cost, iterations, edges_simulated, states_checked, "
        "simulated_time, discarded_plans)",
        std::uint64_t{run.experiment + 1}, std::uint64_t{run.planner + 1}, std::uint64_t{run.seed}, run.wall_s,
        static_cast<std::uint64_t>(run.status), number(run.status == RunStatus::solved),
        number(run.status == RunStatus::approximate), run.nearest_approach_m, number(run.holds()), run.first_solution_s,
        run.cost, run.iterations, run.edges_simulated, run.states_checked, run.simulated_s, run.discarded);
    const std::uint64_t key = database_.last_key();
    std::vector<std::tuple<std::uint64_t, double, std::uint64_t, double, std::optional<double>>> progress;
    for (const Improvement& improvement : run.improvements) {
        progress.emplace_back(key, improvement.wall_s, improvement.iteration, improvement.cost, improvement.flown_cost);
    }
    database_.insert_rows("progress", progress);
    std::vector<std::tuple<std::uint64_t, std::string_view, std::uint64_t>> rejections;
    for (const auto& [cause, edges] : run.rejections) {
        rejections.emplace_back(key, cause, edges);
    }
    database_.insert_rows("rejections", rejections);
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
    if (run.made_on) {
        database_.insert("run_machines", key, key_of(run.made_on->machine), run.made_on->load);
    }
    database_.insert("checksums", key, checksum_of(run));
    ++added_;
    added_s_[run.experiment] += run.wall_s;
}

void RunWriter::count() {
    database_.run("UPDATE campaign_checksum SET finished_runs = finished_runs + ?", std::exchange(added_, 0));
    for (const auto& [experiment, wall_s] : std::exchange(added_s_, {})) {
        database_.run("UPDATE experiments SET totaltime = totaltime + ? WHERE id = ?", wall_s,
                      std::uint64_t{experiment + 1});
    }
}

void RunWriter::forget() {
    machines_.clear();
    added_ = 0;
    added_s_.clear();
}

std::uint64_t RunWriter::key_of(const Machine& machine) {
    if (const auto known = machines_.find(machine); known != machines_.end()) {
        return known->second;
    }
    database_.run("INSERT OR IGNORE INTO machines (host, processor, instruction_set) VALUES (?, ?, ?)", machine.host,
                  machine.processor, machine.instruction_set);
    std::uint64_t key_of_machine = 0;
    database_.for_each<std::uint64_t, std::string, std::string, std::string>(
        "SELECT id, host, processor, instruction_set FROM machines", [&](std::uint64_t key, const auto&... columns) {
            if (Machine{columns...} == machine) {
                key_of_machine = key;
            }
        });
    machines_.emplace(machine, key_of_machine);
    return key_of_machine;
}

}  // namespace downwash::bench
