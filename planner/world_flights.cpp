#include "downwash/planner/world_flights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "downwash/base/parallel.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/touch.hpp"
#include "downwash/simulation/vehicle_effect.hpp"

namespace downwash {
namespace {

/// The goal to which a flight was on the way when it failed.
/// @param first knot at which its first leg begins; a leg ends at each knot after it
/// @param hovers knots at which those at the goals before the last end
std::size_t failed_goal(const FlightJob& job, std::size_t first, const std::vector<std::size_t>& hovers) {
    const FlightLeg* const rejected = job.rejected_leg();
    if (rejected == nullptr) {
        return 0;
    }
    const std::size_t knot = first + static_cast<std::size_t>(rejected - job.legs.data()) + 1;
    return static_cast<std::size_t>(std::lower_bound(hovers.begin(), hovers.end(), knot) - hovers.begin());
}

/// Whether a flight ends in a collision where its vehicle, at the same pose in its plane, touches nothing.
bool is_lateral_collision(const FlightModel& model, const FlightJob& job) {
    const FlightLeg* const rejected = job.rejected_leg();
    if (rejected == nullptr || rejected->flight.rejection != Rejection::collision || job.world->lateral_m == 0) {
        return false;
    }
    PlanarPose pose = among_obstacles(pose_of(rejected->end), job.world);
    pose.lateral_m = 0;
    return !model.collisions().is_nearer_than(pose, 0);
}

/// Sets what long work asks, for a scope.
class AskingScope {
 public:
    AskingScope(StopCondition& asked, const StopCondition& is_over) : asked_(asked) { asked_ = is_over; }
    ~AskingScope() { asked_ = nullptr; }
    AskingScope(const AskingScope&) = delete;
    AskingScope& operator=(const AskingScope&) = delete;

 private:
    StopCondition& asked_;
};

}  // namespace

Plan with_hover(const Plan& plan, const Goal& goal, const FlightModel& model) {
    return plan.held_for(hold_ticks(goal, model, plan.reference.back().point));
}

double min_clearance_m(const FlightJob& job) {
    double least_m = std::numeric_limits<double>::infinity();
    for (const FlightLeg& leg : job.legs) {
        least_m = std::min(least_m, leg.flight.min_clearance_m);
    }
    return least_m;
}

WorldFlights::WorldFlights(const Problem& problem, std::shared_ptr<const FlightModel> model,
                           std::shared_ptr<const AeroMap> map, int threads, std::optional<ClearanceError> clearance)
    : problem_(problem),
      model_(std::move(model)),
      map_(std::move(map)),
      goals_(goals_of(problem)),
      threads_(threads),
      clearance_(clearance),
      pools_(goals_.size()) {}

FlightPool& WorldFlights::pool(std::size_t goal) {
    if (pools_[goal] == nullptr) {
        FlightRules rules = rules_of_execution();
        rules.finds_min_clearance = clearance_;
        rules.is_over = [this] { return is_over_ && is_over_(); };
        pools_[goal] = std::make_unique<FlightPool>(*model_, map_.get(), rules, &goals_[goal], threads_);
    }
    return *pools_[goal];
}

std::vector<std::optional<FlightState>> WorldFlights::starts_in(std::span<const FlownWorld> worlds) {
    const FlightState nominal = start_state(*model_, problem_.start);
    std::vector<std::optional<FlightState>> starts(worlds.size(), nominal);
    if (is_at_rest(problem_.start)) {
        if (equilibria_ == nullptr) {
            equilibria_ = std::make_unique<HoverEquilibria>(*model_, map_.get(), nominal);
        }
        run_parallel(worlds.size(), threads_, [&](std::size_t i) { starts[i] = equilibria_->in(worlds[i]); });
        std::vector<std::size_t> without_equilibrium;
        for (std::size_t i = 0; i < worlds.size(); ++i) {
            if (!starts[i]) {
                without_equilibrium.push_back(i);
            } else if (!is_clear(*starts[i], worlds[i])) {
                starts[i].reset();
            }
        }
        hover_at_start(worlds, without_equilibrium, starts);
    }
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        if (starts[i]) {
            starts[i]->plant.energy_j = 0;
            starts[i]->world = memory_at_start(worlds[i], starts[i]->plant);
        }
    }
    return starts;
}

void WorldFlights::hover_at_start(std::span<const FlownWorld> worlds,
                                  const std::vector<std::size_t>& without_equilibrium,
                                  std::vector<std::optional<FlightState>>& starts) {
    if (without_equilibrium.empty()) {
        return;
    }
    const FlightState nominal = start_state(*model_, problem_.start);
    const ReferencePoint here = at_rest(problem_.start.at);
    const double tick_s = model_->tick().tick_s;
    const ReferenceSegment hover(here, here, std::llround(settling_before_start_s / tick_s), tick_s);
    std::vector<FlownWorld> quiet;
    quiet.reserve(without_equilibrium.size());
    std::vector<FlightJob> jobs;
    for (const std::size_t world : without_equilibrium) {
        quiet.push_back(without_noise(worlds[world]));
        FlightJob job{nominal, {{hover}}, 0, &quiet.back()};
        job.start.world = memory_at_start(quiet.back(), nominal.plant);
        jobs.push_back(std::move(job));
    }
    pool(0).fly(jobs);
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        starts[without_equilibrium[i]] =
            jobs[i].rejection() == Rejection::none ? std::optional(jobs[i].end()) : std::nullopt;
    }
}

bool WorldFlights::is_clear(const FlightState& vehicle, const FlownWorld& world) const {
    const PlanarPose pose = among_obstacles(pose_of(vehicle), &world);
    return !model_->collisions().is_nearer_than(pose, 0) && (map_ == nullptr || is_flyable(*model_, *map_, pose));
}

void WorldFlights::advance(std::vector<FlightJob>& jobs, const Plan& plan, std::size_t first, std::size_t last,
                           std::optional<std::size_t> goal) {
    const std::int64_t judged_ticks = goal ? std::llround(goal_settling_s / model_->tick().tick_s) : 0;
    std::vector<FlightLeg> legs;
    for (std::size_t i = first + 1; i <= last; ++i) {
        legs.push_back({plan.segment_to(i)});
    }
    if (legs.empty()) {
        return;
    }
    std::vector<FlightJob> flying;
    std::vector<FlightJob*> owners;
    for (FlightJob& job : jobs) {
        if (job.rejection() == Rejection::none) {
            flying.push_back({job.legs.empty() ? job.start : job.end(), legs, judged_ticks, job.world,
                              job.first_tick + plan.reference[first].tick});
            owners.push_back(&job);
        }
    }
    pool(goal.value_or(0)).fly(flying);
    for (std::size_t i = 0; i < flying.size(); ++i) {
        std::move(flying[i].legs.begin(), flying[i].legs.end(), std::back_inserter(owners[i]->legs));
    }
}

void WorldFlights::advance(std::vector<FlightJob>& jobs, const Plan& plan, std::span<const PlannedTouch> touches) {
    std::size_t knot = 0;
    for (const PlannedTouch& each : touches) {
        const auto end = std::ranges::find(plan.reference, each.tick, &ReferenceKnot::tick);
        const auto last = static_cast<std::size_t>(end - plan.reference.begin());
        advance(jobs, plan, std::exchange(knot, last), last, std::nullopt);
        touch(jobs, each);
    }
    advance(jobs, plan, knot, plan.reference.size() - 1, std::nullopt);
}

std::vector<PlannedTouch> WorldFlights::touches_of(const Plan& plan, std::size_t visits) const {
    return downwash::touches_of(*model_, plan.reference, std::span(goals_).first(visits));
}

std::vector<WorldFlight> WorldFlights::fly(const Plan& plan, std::size_t visits, std::span<const FlownWorld> worlds,
                                           const StopCondition& is_over) {
    const AskingScope scope(is_over_, is_over);
    return fly_from(starts_in(worlds), plan, visits, worlds, is_over);
}

std::vector<WorldFlight> WorldFlights::fly_from(std::span<const std::optional<FlightState>> starts, const Plan& plan,
                                                std::size_t visits, std::span<const FlownWorld> worlds,
                                                const StopCondition& is_over) {
    std::vector<std::optional<FlightState>> vehicles(starts.begin(), starts.end());
    return fly_on(vehicles, plan, 0, visits, worlds, is_over);
}

std::vector<WorldFlight> WorldFlights::fly_on(std::vector<std::optional<FlightState>>& vehicles, const Plan& plan,
                                              std::size_t first, std::size_t visits, std::span<const FlownWorld> worlds,
                                              const StopCondition& is_over) {
    const AskingScope scope(is_over_, is_over);
    std::vector<WorldFlight> flights(worlds.size(), {Rejection::unstable, 0});
    std::vector<FlightJob> jobs;
    std::vector<std::size_t> world_of;
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        if (vehicles[i]) {
            jobs.push_back({*vehicles[i], {}, 0, &worlds[i]});
            world_of.push_back(i);
        }
    }
    const std::span<const Goal> goals = std::span(goals_).first(visits);
    const std::vector<std::size_t> hovers = hover_ends(*model_, plan.reference, goals);
    const Plan held = with_hover(plan, goals.back(), *model_);
    const std::vector<PlannedTouch> touches = touches_of(plan, visits);
    std::size_t knot = first;
    const auto go_on = [&](std::size_t last, std::size_t goal) {
        advance(jobs, held, std::exchange(knot, last), last, goal);
        const auto next = std::ranges::find(touches, held.reference[last].tick, &PlannedTouch::tick);
        if (next != touches.end()) {
            touch(jobs, *next);
        }
    };
    for (std::size_t i = 0; i < hovers.size(); ++i) {
        if (hovers[i] > knot) {
            go_on(hovers[i], i);
        }
    }
    go_on(held.reference.size() - 1, visits - 1);
    throw_if_over(is_over);  // then some were interrupted
    const bool misses_a_goal = hovers.size() + 1 < visits;
    const double budget_j = problem_.energy_budget_j.value_or(std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const Rejection rejection = jobs[i].rejection();
        if (rejection == Rejection::none && !misses_a_goal && jobs[i].end().plant.energy_j > budget_j) {
            flights[world_of[i]] = {Rejection::over_budget, min_clearance_m(jobs[i]), visits - 1};
            continue;
        }
        flights[world_of[i]] = {
            rejection == Rejection::none && misses_a_goal ? Rejection::goal_missed : rejection,
            min_clearance_m(jobs[i]),
            misses_a_goal && rejection == Rejection::none ? hovers.size() : failed_goal(jobs[i], first, hovers),
            is_lateral_collision(*model_, jobs[i])};
    }
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        std::optional<FlightState>& vehicle = vehicles[world_of[i]];
        vehicle = flights[world_of[i]].rejection == Rejection::none ? std::optional(jobs[i].end()) : std::nullopt;
    }
    return flights;
}

void WorldFlights::touch(std::vector<FlightJob>& jobs, const PlannedTouch& touch) {
    run_parallel(jobs.size(), threads_, [&](std::size_t i) {
        FlightJob& job = jobs[i];
        if (job.legs.empty() || job.rejection() != Rejection::none || (is_over_ && is_over_())) {
            return;
        }
        FlightLeg& last = job.legs.back();
        const TouchFlight flown =
            fly_touch(*model_, map_.get(), touch.touch, touch.base, last.end, {job.world, job.first_tick + touch.tick});
        job.first_tick += flown.ticks;
        last.flight.rejection = flown.rejection;
        if (flown.rejection == Rejection::collision) {
            last.flight.min_clearance_m = 0;
        }
        if (flown.rejection == Rejection::none && !meets_goal(goals_[touch.goal], model_->tick().plant, last.end)) {
            last.flight.rejection = Rejection::goal_missed;
        }
    });
    throw_if_over(is_over_);
}

}  // namespace downwash
