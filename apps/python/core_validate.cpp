#include <pybind11/stl.h>

#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/judge/space_disagreements.hpp"
#include "downwash/judge/space_plan_judge.hpp"
#include "downwash/judge/world_runs.hpp"
#include "downwash/python/columns.hpp"
#include "downwash/python/core_solution.hpp"
#include "downwash/python/interruptible.hpp"
#include "downwash/simulation/space_world_parameters.hpp"
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

void check_request(bool has_plan, std::uint64_t runs, bool needs_worlds, bool has_uncertainty) {
    if (!has_plan) {
        throw_input_error("has no plan to be flown", "the solution");
    }
    constexpr std::uint64_t most_runs = 10'000'000;
    if (runs > most_runs) {
        throw_input_error("is " + std::to_string(runs) + ": expected 0 to " + std::to_string(most_runs), "runs");
    }
    if (needs_worlds && !has_uncertainty) {
        throw_input_error("need to know what is uncertain: the problem has no `uncertainty:`", "worlds");
    }
}

/// What is told of the worlds that are flown.
std::function<void(double)> telling_share(Attendance& attendance, const py::object& on_progress) {
    if (on_progress.is_none()) {
        return {};
    }
    return
        [&attendance, &on_progress](double share) { attendance.tell([&on_progress, share] { on_progress(share); }); };
}

/// @param flight a JudgedFlight or a SpaceJudgedFlight
template <class Flight>
py::tuple findings(const Flight& flight, double goal_error_m, const std::optional<judge::WorldRuns>& worlds) {
    py::dict document;
    document["outcome"] = judge::name_of(flight.outcome);
    document["min_clearance_m"] = finite(flight.min_clearance_m);
    document["energy_j"] = finite(flight.energy_j);
    document["duration_s"] = flight.duration_s;
    document["goal_error_m"] = finite(goal_error_m);
    if (worlds) {
        add_runs(document, *worlds);
    }
    return py::make_tuple(document, worlds ? py::object(flights_of(*worlds)) : py::none());
}

py::tuple validate(const std::shared_ptr<CoreProblem>& problem, const CoreSolution& of, std::uint64_t runs,
                   const std::optional<std::uint64_t>& world, const std::optional<std::uint64_t>& asked_seed,
                   int threads, const py::object& on_progress, const py::object& stop) {
    check_request(of.solution.plan.has_value(), runs, runs > 0 || world, problem->problem().uncertainty.has_value());
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
        return judge::fly_in_worlds(
            judge, plan,
            {runs, seed, thread_count(threads), 0, attendance.token(), telling_share(attendance, on_progress)});
    });
    return findings(flight, flight.goal_error_m, worlds);
}

py::tuple validate_in_space(const std::shared_ptr<CoreSpaceProblem>& problem, const CoreSpaceSolution& of,
                            std::uint64_t runs, const std::optional<std::uint64_t>& world,
                            const std::optional<std::uint64_t>& asked_seed, int threads, const py::object& on_progress,
                            const py::object& stop) {
    const SpaceProblem& flown = problem->problem();
    check_request(of.solution.plan.has_value(), runs, runs > 0 || world, flown.uncertainty.has_value());
    const SpaceProblem visited = as_visited(flown, of.solution);
    const std::uint64_t seed = asked_seed.value_or(of.solution.seed);
    const SpacePlan& plan = *of.solution.plan;
    judge::SpaceJudgedFlight flight;
    const std::optional<judge::WorldRuns> worlds = interruptible(stop, [&](Attendance& attendance) {
        const judge::SpacePlanJudge judge(visited);
        flight = judge.fly(
            plan, true,
            world ? std::optional(draw_space_world(*flown.uncertainty, flown.robot, seed, *world)) : std::nullopt);
        if (runs == 0) {
            return std::optional<judge::WorldRuns>();
        }
        return judge::fly_in_worlds(
            judge, plan,
            {runs, seed, thread_count(threads), 0, attendance.token(), telling_share(attendance, on_progress)});
    });
    return findings(flight, judge::worst_goal_error_m(flight), worlds);
}

}  // namespace

void bind_validate(py::module_& module) {
    module.def("validate", validate);
    module.def("validate", validate_in_space);
}

}  // namespace downwash::python
