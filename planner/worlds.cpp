#include "downwash/planner/worlds.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <span>
#include <utility>

#include "downwash/base/parallel.hpp"
#include "downwash/planner/certificate_record.hpp"
#include "downwash/planner/search_quantiles.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/noise.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash::planning {
namespace {

/// Worlds of a search. @param number of the world, from 1   @return quantiles of world_parameters_of(robot)
std::vector<double> quantiles_of_world(const Robot& robot, std::uint64_t number) {
    const std::vector<const WorldParameter*> parameters = world_parameters_of(robot);
    std::vector<DangerQuantiles> dangers;
    dangers.reserve(parameters.size());
    for (const WorldParameter* parameter : parameters) {
        dangers.push_back(parameter->danger);
    }
    // A sequence for what moves in the plane, and one for what displaces beside it.
    const auto first_lateral = std::ranges::find_if(parameters, &WorldParameter::is_lateral);
    return search_quantiles(dangers, static_cast<std::size_t>(first_lateral - parameters.begin()), number);
}

/// Enough to tell which flights came nearest.
constexpr ClearanceError rough_clearance{0.1, 0.02};

}  // namespace

ProblemWorlds::ProblemWorlds(const Problem& problem, const PlannerModel& model, const SolveOptions& options)
    : problem_(problem),
      flights_(problem, model.flight, model.true_map, options.threads, rough_clearance),
      close_flights_(problem, model.flight, model.true_map, options.threads, ClearanceError{}),
      threads_(options.threads),
      fleets_(goals() + 1) {
    if (model.own_map != model.true_map) {
        in_free_air_ = std::make_unique<WorldFlights>(problem, model.flight, model.own_map, options.threads);
    }
}

std::vector<FlownWorld> search_worlds(const Problem& problem) {
    std::vector<FlownWorld> worlds;
    for (std::uint64_t i = 1; i < problem.planner.worlds; ++i) {
        const std::uint64_t tape = simulation::mixed(~std::uint64_t{problem.planner.seed} ^ simulation::mixed(i));
        worlds.push_back(make_world(
            problem.robot, world_at(*problem.uncertainty, problem.robot, quantiles_of_world(problem.robot, i), tape)));
    }
    return worlds;
}

SearchWorlds ProblemWorlds::for_search(const Course& before) {
    std::vector<FlownWorld> worlds = search_worlds(problem_);
    const VehiclesOf<Plane> vehicles = vehicles_after(before, worlds);
    return worlds_of_search<Plane>(std::move(worlds), vehicles);
}

VehiclesOf<Plane> ProblemWorlds::vehicles_after(const Course& before, std::span<const FlownWorld> worlds) {
    VehiclesOf<Plane> vehicles = own_flights().starts_in(worlds);
    if (before.plan.reference.empty()) {
        return vehicles;
    }
    std::vector<FlightJob> jobs;
    std::vector<std::size_t> world_of;
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        if (vehicles[i]) {
            jobs.push_back({*vehicles[i], {}, 0, &worlds[i]});
            world_of.push_back(i);
        }
    }
    Plan flown = before.plan;
    flown.reference.pop_back();  // the hover at its last goal
    own_flights().advance(jobs, before.plan, own_flights().touches_of(flown, before.goals.size()));
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        vehicles[world_of[i]] = jobs[i].rejection() == Rejection::none ? std::optional(jobs[i].end()) : std::nullopt;
    }
    return vehicles;
}

std::vector<Counterexample> ProblemWorlds::counterexamples(const Certificate& certificate, const Course& before) {
    std::vector<FlownWorld> worlds;
    for (const std::uint64_t index : failed_on_way_to(before.goals.size(), certificate)) {
        worlds.push_back(world(index));
    }
    return counterexamples_of<Plane>(worlds, vehicles_after(before, worlds));
}

FlownWorld ProblemWorlds::world(std::uint64_t index) const {
    return make_world(problem_.robot, draw_world(*problem_.uncertainty, problem_.robot, problem_.planner.seed, index));
}

void ProblemWorlds::look_closely(const Plan& whole, std::size_t visits, std::vector<WorldSample>& samples,
                                 const StopCondition& is_over) {
    constexpr std::size_t flown_directly = 2;
    constexpr double step_s = 0.5;
    std::vector<FlownWorld> worlds;
    worlds.reserve(samples.size());
    for (const WorldSample& sample : samples) {
        worlds.push_back(world(sample.world));
    }
    const std::span<const Goal> goals = std::span(flights_.goals()).first(visits);
    const Plan moments = with_hover(whole, goals.back(), flights_.model())
                             .divided(std::max<std::int64_t>(1, std::llround(step_s / whole.tick_s)));
    const std::vector<std::optional<FlightState>> starts = close_flights_.starts_in(worlds);
    std::vector<FlightJob> jobs;
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        jobs.push_back({starts[i].value_or(FlightState{}), {}, 0, &worlds[i]});
    }
    const std::vector<PlannedTouch> touches = close_flights_.touches_of(whole, visits);
    close_flights_.advance(jobs, moments, touches);
    throw_if_over(is_over);
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        samples[i].min_clearance_m = min_clearance_m(jobs[i]);
    }
    std::vector<std::size_t> nearest(samples.size());
    std::iota(nearest.begin(), nearest.end(), std::size_t{0});
    std::ranges::stable_sort(nearest, {}, [&](std::size_t i) { return samples[i].min_clearance_m; });
    nearest.resize(std::min(flown_directly, nearest.size()));
    run_parallel(nearest.size(), threads_, [&](std::size_t number) {
        const FlightJob& job = jobs[nearest[number]];
        WorldSample& sample = samples[nearest[number]];
        if (!touches.empty()) {
            fly_directly(whole, goals, job, sample, is_over);
        } else {
            fly_directly_where_nearest(whole, goals, moments, job, sample, is_over);
        }
    });
}

void ProblemWorlds::fly_directly(const Plan& whole, std::span<const Goal> goals, const FlightJob& job,
                                 WorldSample& sample, const StopCondition& is_over) const {
    const Execution flight = execute(flights_.model(), job.start, whole.reference, goals, true, {job.world}, is_over,
                                     problem_.energy_budget_j);
    sample.outcome = flight.outcome;
    sample.min_clearance_m = flight.min_clearance_m;
    const auto missed = std::ranges::find_if(flight.goals, [](const GoalVisit& visit) { return !visit.is_met; });
    sample.goal = missed != flight.goals.end() ? static_cast<std::size_t>(missed - flight.goals.begin()) : 0;
}

void ProblemWorlds::fly_directly_where_nearest(const Plan& whole, std::span<const Goal> goals, const Plan& moments,
                                               const FlightJob& job, WorldSample& sample,
                                               const StopCondition& is_over) const {
    constexpr double before_s = 2, after_s = 1;  // the loops settle in less
    const auto tick_at = [&](std::size_t leg) { return moments.reference[leg].tick; };
    const auto found = std::ranges::find_if(
        job.legs, [&](const FlightLeg& leg) { return leg.flight.min_clearance_m <= sample.min_clearance_m; });
    const auto nearest = static_cast<std::size_t>(found - job.legs.begin());
    std::size_t first = nearest;
    while (first > 0 && tick_at(nearest) - tick_at(first) < std::llround(before_s / whole.tick_s)) {
        --first;
    }
    std::vector<ReferenceSegment> segments;
    const std::int64_t end = tick_at(nearest + 1) + std::llround(after_s / whole.tick_s);
    for (std::size_t i = first; i < job.legs.size() && tick_at(i) < end; ++i) {
        segments.push_back(job.legs[i].segment);
    }
    const FlightPart part = execute_part(flights_.model(), first == 0 ? job.start : job.legs[first - 1].end, segments,
                                         true, {job.world, tick_at(first)}, is_over);
    sample.min_clearance_m = part.min_clearance_m;
    sample.outcome = outcome_of(part.rejection);
    sample.goal = static_cast<std::size_t>(
        std::ranges::count_if(hover_ends(flights_.model(), whole.reference, goals),
                              [&](std::size_t knot) { return whole.reference[knot].tick <= tick_at(nearest); }));
}

/// Adds flights in new worlds to a record, until it is known whether the plan passes. @throws WorkStopped
/// @return whether direct flights agree that it does
bool ProblemWorlds::fly_for_certificate(const Test& test, const StopCondition& is_over, const WorldCounter& counter,
                                        CertificateRecord& record) {
    constexpr std::uint64_t chunk = 64;   // worlds side by side: a bad plan fails in the first of them
    constexpr int threads_of_chunk = 16;  // that it keeps busy; for more, chunks are flown that are likely to be wanted
    const auto chunks_at_once = static_cast<std::uint64_t>(std::max(1, threads_ / threads_of_chunk));
    constexpr std::size_t looked_at = 10;  // the worst that a certificate lists
    std::deque<WorldFlight> flown;         // of the worlds after those of the record
    for (;;) {
        throw_if_over(is_over);
        if (counter) {
            counter(record.worlds(), record.failures());
        }
        const std::uint64_t wanted = record.worlds_wanted();
        if (wanted == 0) {
            if (!record.passes()) {
                return false;
            }
            // The map is not the last word where the flights came nearest.
            std::vector<WorldSample> nearest = record.nearest_successes(looked_at);
            look_closely(test.whole, test.visits, nearest, is_over);
            if (!record.replace(nearest)) {
                return true;
            }
            continue;
        }
        const std::uint64_t number = record.worlds();
        const std::uint64_t next = std::min(chunk, wanted);
        if (flown.size() < next) {
            std::vector<FlownWorld> worlds;
            const std::uint64_t begin = number + flown.size();
            for (std::uint64_t i = begin; i < number + std::min(chunks_at_once * chunk, wanted); ++i) {
                worlds.push_back(world(test.first_world + i));
            }
            const std::vector<WorldFlight> flights = test.fly(begin, worlds);
            flown.insert(flown.end(), flights.begin(), flights.end());
        }
        for (std::uint64_t i = 0; i < next; ++i) {
            const WorldFlight& flight = flown.front();
            record.add({test.first_world + number + i, outcome_of(flight.rejection), flight.min_clearance_m,
                        flight.goal, flight.is_lateral_collision});
            flown.pop_front();
        }
    }
}

Certificate ProblemWorlds::tested(const Test& test, const StopCondition& is_over, const WorldCounter& counter,
                                  CertificateRecord record) {
    bool is_checked = false;
    try {
        is_checked = fly_for_certificate(test, is_over, counter, record);
    } catch (const WorkStopped&) {  // it has what was flown so far
    }
    return record.certificate(is_checked);
}

Certificate ProblemWorlds::certify(const Plan& whole, std::uint64_t attempt, const StopCondition& is_over,
                                   const WorldCounter& counter) {
    const PlannerSettings& settings = problem_.planner;
    const auto fly = [&](std::uint64_t /*number*/, std::span<const FlownWorld> worlds) {
        return flights_.fly(whole, goals(), worlds, is_over);
    };
    return tested({whole, goals(), attempt * worlds_per_attempt, fly}, is_over, counter,
                  CertificateRecord(settings.max_failure_probability, settings.confidence, attempt));
}

const FlownFleet& ProblemWorlds::screened(const Course& course, std::uint64_t worlds, const StopCondition& is_over) {
    FlownFleet& fleet = fleets_[course.goals.size()];
    if (!is_flown(fleet, course.plan) || fleet.reference.size() != course.plan.reference.size()) {
        fleet = {course.plan.reference, {}, {}};
    }
    const std::uint64_t known = fleet.vehicles.size();
    std::vector<FlownWorld> more;
    for (std::uint64_t i = known; i < worlds; ++i) {
        more.push_back(world(first_screening + i));
    }
    std::vector<std::optional<FlightState>> vehicles = flights_.starts_in(more);
    if (!course.goals.empty() && !more.empty()) {
        Plan flown = course.plan;
        flown.reference.pop_back();  // the hover at its last goal, which is flown again
        static_cast<void>(flights_.fly_on(vehicles, flown, 0, course.goals.size(), more, is_over));
    }
    fleet.vehicles.insert(fleet.vehicles.end(), vehicles.begin(), vehicles.end());
    return fleet;
}

Certificate ProblemWorlds::screen(const Course& before, const Plan& part, const StopCondition& is_over,
                                  const WorldCounter& counter) {
    // With less, parts pass that no later part can make up for; where no flight has failed as a whole, that is to be
    // seen first.
    constexpr double confidence = 0.8, first_confidence = 0.5;
    const std::size_t visited = before.goals.size();
    const Plan whole = before.plan.followed_by(part);
    const std::size_t first = before.plan.reference.empty() ? 0 : before.plan.reference.size() - 1;
    FlownFleet after{with_hover(whole, flights_.goals()[visited], flights_.model()).reference, {}, {}};
    const auto fly = [&](std::uint64_t number, std::span<const FlownWorld> worlds) {
        const auto begin = static_cast<std::ptrdiff_t>(number);
        const FlownFleet& fleet = screened(before, number + worlds.size(), is_over);
        std::vector<std::optional<FlightState>> vehicles(
            fleet.vehicles.begin() + begin,
            fleet.vehicles.begin() + begin + static_cast<std::ptrdiff_t>(worlds.size()));
        std::vector<WorldFlight> flights = flights_.fly_on(vehicles, whole, first, visited + 1, worlds, is_over);
        after.vehicles.insert(after.vehicles.end(), vehicles.begin(), vehicles.end());
        return flights;
    };
    const double share = problem_.planner.max_failure_probability / static_cast<double>(goals());
    Certificate certificate =
        tested({whole, visited + 1, first_screening, fly}, is_over, counter,
               CertificateRecord(share, before.attempts > 0 ? confidence : first_confidence, 1, visited));
    if (certificate.is_given) {
        fleets_[visited + 1] = std::move(after);
    }
    return certificate;
}

std::optional<std::size_t> weakest_part(const Certificate& certificate) {
    std::vector<int> failures;
    for (const WorldSample& sample : certificate.worst) {
        if (sample.outcome != Outcome::ok) {
            failures.resize(std::max(failures.size(), sample.goal + 1));
            ++failures[sample.goal];
        }
    }
    if (failures.empty()) {
        return std::nullopt;
    }
    const auto most = std::max_element(failures.rbegin(), failures.rend());
    return static_cast<std::size_t>(failures.rend() - most) - 1;
}

}  // namespace downwash::planning
