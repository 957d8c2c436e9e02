#include <pybind11/stl.h>

#include <cmath>
#include <optional>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/judge/world_runs.hpp"
#include "downwash/python/columns.hpp"
#include "downwash/python/core_solution.hpp"
#include "downwash/python/interruptible.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash::python {
namespace {

/// Numbers of files are finite; those that are not stand for nothing.
std::optional<double> finite(double value) {
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

py::dict dict_of(const judge::Probability& p) {
    py::dict dict;
    dict["estimate"] = p.estimate;
    dict["low"] = p.low;
    dict["high"] = p.high;
    return dict;
}

void add_runs(py::dict& document, const judge::WorldRuns& worlds) {
    document["runs"] = worlds.runs.size();
    document["collisions"] = worlds.collisions;
    document["lateral_collisions"] = worlds.lateral_collisions;
    document["collision_probability"] = dict_of(worlds.collision_probability);
    document["failures"] = worlds.failures;
    document["failure_probability"] = dict_of(worlds.failure_probability);
    py::dict clearance;
    clearance["p01"] = finite(worlds.clearance_p01_m);
    clearance["p10"] = finite(worlds.clearance_p10_m);
    clearance["p50"] = finite(worlds.clearance_p50_m);
    document["clearance_m"] = clearance;
    py::list sensitivity;
    for (const judge::Sensitivity& each : worlds.sensitivity) {
        py::dict row;
        row["parameter"] = each.parameter;
        row["rank_correlation"] = each.rank_correlation;
        sensitivity.append(row);
    }
    document["sensitivity"] = sensitivity;
}

/// Every flight in a world, one row each.
py::tuple flights_of(const judge::WorldRuns& worlds) {
    NumberTable table;
    table.names = {"world", "min_clearance_m", "max_tracking_error_m", "energy_j"};
    table.columns.resize(table.names.size());
    py::list outcomes;
    for (const judge::WorldRun& run : worlds.runs) {
        table.add_row({static_cast<double>(run.world), run.min_clearance_m, run.max_tracking_error_m, run.energy_j});
        outcomes.append(judge::name_of(run.outcome));
    }
    return py::make_tuple(columns_of(std::move(table)), outcomes);
}

py::tuple validate(const std::shared_ptr<CoreProblem>& problem, const CoreSolution& of, std::uint64_t runs,
                   const std::optional<std::uint64_t>& world, const std::optional<std::uint64_t>& asked_seed,
                   int threads, const py::object& on_progress, const py::object& stop) {
    if (!of.solution.plan) {
        throw_input_error("has no plan to be flown", "the solution");
    }
    constexpr std::uint64_t most_runs = 10'000'000;
    if (runs > most_runs) {
        throw_input_error("is " + std::to_string(runs) + ": expected 0 to " + std::to_string(most_runs), "runs");
    }
    if ((runs > 0 || world) && !problem->problem().uncertainty) {
        throw_input_error("need to know what is uncertain: the problem has no `uncertainty:`", "worlds");
    }
    const std::uint64_t seed = asked_seed.value_or(of.solution.seed);
    const Plan& plan = *of.solution.plan;
    judge::JudgedFlight flight;
    const std::optional<judge::WorldRuns> worlds = interruptible(stop, [&](Attendance& attendance) {
        const judge::PlanJudge judge(as_visited(problem->problem(), of.solution));
        judge::FlightConditions conditions;
        if (world) {
            conditions.world = draw_world(*problem->problem().uncertainty, problem->problem().robot, seed, *world);
        }
        flight = judge.fly(plan, conditions);
        if (runs == 0) {
            return std::optional<judge::WorldRuns>();
        }
        std::function<void(double)> tell;
        if (!on_progress.is_none()) {
            tell = [&](double share) { attendance.tell([&on_progress, share] { on_progress(share); }); };
        }
        return judge::fly_in_worlds(judge, plan, {runs, seed, thread_count(threads), 0, attendance.token(), tell});
    });
    py::dict document;
    document["outcome"] = judge::name_of(flight.outcome);
    document["min_clearance_m"] = finite(flight.min_clearance_m);
    document["energy_j"] = finite(flight.energy_j);
    document["duration_s"] = flight.duration_s;
    document["goal_error_m"] = finite(flight.goal_error_m);
    if (worlds) {
        add_runs(document, *worlds);
    }
    return py::make_tuple(document, worlds ? py::object(flights_of(*worlds)) : py::none());
}

}  // namespace

void bind_validate(py::module_& module) {
    module.def("validate", validate);
}

}  // namespace downwash::python
