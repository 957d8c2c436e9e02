#include "downwash/bench/awareness_study/awareness_run.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <set>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/base/sha256.hpp"
#include "downwash/base/text.hpp"
#include "downwash/base/version.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/bench/plan_evaluation.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_writer.hpp"

namespace downwash::bench {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

bool is_known(const std::string& commit, const std::vector<std::string>& same_as) {
    return commit == source_commit() || std::find(same_as.begin(), same_as.end(), commit) != same_as.end();
}

/// Hashes of many runs: everything but the seed is hashed once.
class RunHashes {
 public:
    explicit RunHashes(const AwarenessSettings& settings) : settings_(settings) {}

    const std::string& of(const AwarenessTask& task, std::uint64_t worlds) {
        std::string& hash =
            known_[std::to_string(task.problem) + "/" + name_of(task.condition) + "/" + std::to_string(worlds)];
        if (hash.empty()) {
            hash = run_hash(settings_, task, worlds);
        }
        return hash;
    }

 private:
    const AwarenessSettings& settings_;
    std::map<std::string, std::string> known_;
};

/// What the runs of a problem with one robot share: the map of its surfaces, and the worlds in which plans are flown.
class Judge {
 public:
    Judge(const AwarenessSettings& settings, const AwarenessTask& task, const std::filesystem::path& cache)
        : problem_(judged_problem(settings, task.problem, task.condition.robot)) {
        // Made for the first search of all levels: no search pays for it.
        if (problem_.aero.enabled) {
            map_ = make_flight_model(problem_)->make_whole_map(problem_.bounds, 1, {}, cache);
        }
    }

    [[nodiscard]] const std::shared_ptr<const AeroMap>& map() const noexcept { return map_; }

    FreshFlights fly(const Plan& plan, std::uint64_t worlds) {
        const WorldFigures figures = evaluation(worlds).evaluate(plan);
        return {figures.worlds, figures.failures};
    }

 private:
    PlanEvaluation& evaluation(std::uint64_t worlds) {
        const std::scoped_lock lock(mutex_);
        std::unique_ptr<PlanEvaluation>& made = evaluations_[worlds];
        if (made == nullptr) {
            made = std::make_unique<PlanEvaluation>(problem_, worlds, map_);
        }
        return *made;
    }

    Problem problem_;
    std::shared_ptr<const AeroMap> map_;
    std::mutex mutex_;
    std::map<std::uint64_t, std::unique_ptr<PlanEvaluation>> evaluations_;
};

/// The judges of all problems and robots, each made when it is first needed.
class Judges {
 public:
    Judges(const AwarenessSettings& settings, std::filesystem::path cache)
        : settings_(settings), cache_(std::move(cache)) {}

    Judge& of(const AwarenessTask& task) {
        Place* place = nullptr;
        {
            const std::scoped_lock lock(mutex_);
            place = &places_[{task.problem, task.condition.robot}];
        }
        std::call_once(place->once, [&] { place->judge = std::make_unique<Judge>(settings_, task, cache_); });
        return *place->judge;
    }

 private:
    struct Place {
        std::once_flag once;
        std::unique_ptr<Judge> judge;
    };

    const AwarenessSettings& settings_;
    std::filesystem::path cache_;
    std::mutex mutex_;
    std::map<std::pair<std::size_t, RobotChoice>, Place> places_;
};

void fill(AwarenessRow& row, const Solution& solution) {
    const SearchRecord& record = solution.planning;
    row.status = static_cast<RunStatus>(solution.status);
    if (record.first_solution_wall_s) {
        row.first_candidate_s = record.setup_wall_s + *record.first_solution_wall_s;
    }
    if (record.first_certified_wall_s) {
        row.first_certified_s = record.setup_wall_s + *record.first_certified_wall_s;
    }
    if (const auto discarded = record.rejected.find("direct_flight"); discarded != record.rejected.end()) {
        row.discarded = discarded->second;
    }
    if (solution.certificate) {
        const Certificate& tested = *solution.certificate;
        row.tested = CertificateFigures{tested.is_given, tested.worlds, tested.failures, tested.attempts};
    }
    // What asks for a certificate and has none is not reported, whoever planned it.
    if (row.condition.asked == Asked::certified && row.has_plan() && !(row.tested && row.tested->is_given)) {
        row.status = RunStatus::approximate;
    }
    if (!row.has_plan()) {
        row.nearest_approach_m = solution.nearest_approach_m;
        row.missed = solution.obstruction ? solution.obstruction->cause : row.tested ? "certificate" : std::string();
        return;
    }
    row.planned_cost = solution.cost;
    if (solution.execution) {
        const Execution& flight = *solution.execution;
        row.executed =
            ExecutedFlight{flight.outcome, solution.execution_cost, flight.min_clearance_m, flight.duration_s};
    }
}

/// One run. What a search cannot do is in the row, never thrown, apart from std::bad_alloc.
AwarenessRow attempt(const AwarenessSettings& settings, const AwarenessTask& task, const AwarenessRunOptions& options,
                     Judge& judge) {
    Problem problem = searched_problem(settings, task);
    AwarenessRow row;
    row.condition = task.condition;
    row.problem = problem.name;
    row.seed = task.seed;
    row.commit = source_commit();
    SolveOptions how;
    how.stop = options.stop;
    how.stop_at_first_solution = task.condition.kind == PlanKind::first;
    how.map_cache = options.map_cache;
    if (options.map_cache.empty() && problem.planner.variant == Variant::mp_arm_ada) {
        how.map = judge.map();
    }
    std::optional<Plan> plan;
    const Clock::time_point begin = Clock::now();
    try {
        Solution solution = solve(problem, how);
        fill(row, solution);
        plan = row.has_plan() ? std::move(solution.plan) : std::nullopt;
    } catch (const InputError& error) {
        row.status = RunStatus::impossible;
        row.error = error.what();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        row.status = RunStatus::error;
        row.error = error.what();
    }
    row.wall_s = since(begin);
    if (plan && !options.stop.stop_requested()) {
        const Clock::time_point flown = Clock::now();
        row.fresh = judge.fly(*plan, settings.lines[task.line].worlds);
        row.evaluation_s = since(flown);
    }
    return row;
}

}  // namespace

std::string run_hash(const AwarenessSettings& settings, const AwarenessTask& task, std::uint64_t worlds) {
    AwarenessTask any_seed = task;
    any_seed.seed = 1;
    const Problem searched = searched_problem(settings, any_seed);
    std::string all = "awareness 1\n" + std::string(version()) + "\n" + name_of(task.condition) + "\n" +
                      problem_sha256(searched) + "\n" +
                      problem_sha256(judged_problem(settings, task.problem, task.condition.robot)) + "\n";
    all +=
        std::string(searched.planner.certify ? "certify" : "-") + (searched.planner.check_execution ? " check" : " -");
    return sha256_hex(all + "\n" + std::to_string(worlds));
}

std::vector<AwarenessRow> current_rows(const AwarenessSettings& settings, const std::filesystem::path& out,
                                       const std::vector<std::string>& same_as) {
    RunHashes hashes(settings);
    std::map<std::string, std::size_t> places;
    std::vector<AwarenessRow> current;
    std::vector<std::pair<Condition, std::size_t>> lines;
    for (std::size_t l = 0; l < settings.lines.size(); ++l) {
        for (const Condition& condition : conditions_of(settings.lines[l])) {
            lines.emplace_back(condition, l);
        }
    }
    for (AwarenessRow& row : AwarenessRows(out / awareness_rows_file).read()) {
        const auto line =
            std::find_if(lines.begin(), lines.end(), [&](const auto& each) { return each.first == row.condition; });
        const auto problem = std::find_if(settings.problems.begin(), settings.problems.end(),
                                          [&](const StudyProblem& each) { return each.problem.name == row.problem; });
        if (line == lines.end() || problem == settings.problems.end() || !flies(row.condition.robot, problem->group) ||
            !is_known(row.commit, same_as)) {
            continue;
        }
        const AwarenessTask task{line->second, static_cast<std::size_t>(problem - settings.problems.begin()),
                                 row.condition, row.seed};
        if (row.hash != hashes.of(task, settings.lines[task.line].worlds)) {
            continue;
        }
        const auto [place, is_new] = places.emplace(key_of(row.condition, row.problem, row.seed), current.size());
        if (is_new) {
            current.push_back(std::move(row));
        } else {
            current[place->second] = std::move(row);
        }
    }
    return current;
}

std::vector<AwarenessTask> missing_tasks(const AwarenessSettings& settings, const TaskShare& share,
                                         const std::vector<AwarenessRow>& rows) {
    std::set<std::string> done;
    for (const AwarenessRow& row : rows) {
        done.insert(key_of(row.condition, row.problem, row.seed));
    }
    std::vector<AwarenessTask> missing = share_of(tasks_of(settings), share);
    std::erase_if(missing, [&](const AwarenessTask& task) {
        return done.contains(key_of(task.condition, settings.problems[task.problem].problem.name, task.seed));
    });
    return missing;
}

double estimated_s(const AwarenessSettings& settings, const std::vector<AwarenessTask>& tasks,
                   const std::vector<AwarenessRow>& rows, std::uint64_t jobs) {
    constexpr std::size_t enough = 10;  // rows, to go by
    double sum_s = 0;
    for (std::size_t l = 0; l < settings.lines.size(); ++l) {
        const std::vector<Condition> conditions = conditions_of(settings.lines[l]);
        double measured_s = 0;
        std::size_t measured = 0;
        for (const AwarenessRow& row : rows) {
            if (std::find(conditions.begin(), conditions.end(), row.condition) != conditions.end()) {
                measured_s += row.wall_s + row.evaluation_s;
                ++measured;
            }
        }
        const auto planned = static_cast<double>(
            std::count_if(tasks.begin(), tasks.end(), [&](const AwarenessTask& task) { return task.line == l; }));
        sum_s +=
            planned * (measured >= enough ? measured_s / static_cast<double>(measured) : expected_s(settings.lines[l]));
    }
    return sum_s / static_cast<double>(std::max<std::uint64_t>(1, jobs));
}

std::uint64_t default_jobs() {
    return std::min(processor_count(), 256U);
}

void run_awareness(const AwarenessSettings& settings, const AwarenessRunOptions& options) {
    const std::vector<AwarenessTask> tasks =
        missing_tasks(settings, options.share, current_rows(settings, options.out, options.same_as));
    const std::size_t planned = share_of(tasks_of(settings), options.share).size();
    AwarenessRows rows(options.out / awareness_rows_file);
    Judges judges(settings, options.map_cache);
    std::vector<std::string> hashes;
    RunHashes known(settings);
    hashes.reserve(tasks.size());
    for (const AwarenessTask& task : tasks) {
        hashes.push_back(known.of(task, settings.lines[task.line].worlds));
    }
    const auto do_task = [&](std::size_t i) {
        if (options.stop.stop_requested()) {
            return;
        }
        try {
            AwarenessRow row = attempt(settings, tasks[i], options, judges.of(tasks[i]));
            row.hash = hashes[i];
            if (!options.stop.stop_requested()) {
                rows.add(row);
            }
        } catch (const std::bad_alloc&) {  // says nothing about the search: the next start repeats it
        }
    };
    const auto earlier = static_cast<double>(planned - tasks.size());
    const auto on_progress = [&](double share) {
        if (options.on_progress && planned > 0) {
            options.on_progress((earlier + share * static_cast<double>(tasks.size())) / static_cast<double>(planned));
        }
    };
    run_parallel(tasks.size(), static_cast<int>(options.jobs.value_or(default_jobs())), do_task, on_progress);
}

}  // namespace downwash::bench
