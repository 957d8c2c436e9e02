#include "downwash/planner/planner.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/planner/braking.hpp"
#include "downwash/planner/family_parts.hpp"
#include "downwash/planner/planner_parts.hpp"
#include "downwash/planner/space_worlds.hpp"
#include "downwash/planner/stopwatch.hpp"
#include "downwash/planner/worlds.hpp"
#include "downwash/search/search_space.hpp"
#include "downwash/simulation/flight.hpp"

namespace downwash {
namespace {

/// The places with the most places beyond them, those nearer to the root first.
template <class Node>
auto carrying_places(const std::vector<Node>& tree, std::size_t most) {
    std::vector<std::size_t> beyond(tree.size(), 1);
    for (std::size_t i = tree.size(); i-- > 0;) {  // parents may come later in the list, after a rewiring
        for (int parent = tree[i].parent; parent != Node::no_parent;
             parent = tree[static_cast<std::size_t>(parent)].parent) {
            ++beyond[static_cast<std::size_t>(parent)];
        }
    }
    std::vector<std::size_t> order(tree.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return beyond[a] > beyond[b]; });
    std::vector<decltype(Node::at)> places;
    for (const std::size_t i : order) {
        if (places.size() < most && beyond[i] > 1 && tree[i].parent != Node::no_parent) {
            places.push_back(tree[i].at);
        }
    }
    return places;
}

/// Checks the limits of PlannerSettings. No time at all is allowed, too: then there is only the stop.
template <class Options>
void throw_if_out_of_range(const Options& options) {
    constexpr double most_s = 1e6;
    constexpr std::uint64_t most_iterations = 1'000'000'000'000'000;
    if (options.time_limit_s && !(*options.time_limit_s <= most_s)) {
        throw_input_error("is " + std::to_string(*options.time_limit_s) + ": expected at most 1000000 s",
                          "time_limit_s");
    }
    if (options.max_iterations && *options.max_iterations > most_iterations) {
        throw_input_error("is " + std::to_string(*options.max_iterations) + ": expected at most 10^15",
                          "max_iterations");
    }
}

}  // namespace

std::string_view name_of(Advice advice) {
    switch (advice) {
        case Advice::keep:
            return "keep";
        case Advice::follow:
            return "follow";
        case Advice::stop:
            return "stop";
        case Advice::none:
            break;
    }
    return "none";
}

/// One call of replan().
template <class Family>
struct PlannerOf<Family>::Call {
    const ReplanOptions& options;
    planning::Stopwatch clock;
    Answer best;
};

template <class Family>
PlannerOf<Family>::PlannerOf(const Problem& problem, SolveOptions options) : options_(std::move(options)) {
    auto checked = planning::checked(problem);
    problem_ = std::move(checked.problem);
    model_ = std::move(checked.model);
    options_.map = nullptr;
    options_.known_plan.reset();
    options_.known_places.clear();
    options_.known_way.clear();
    options_.enough_cost.reset();
    options_.keep_tree = true;
    options_.threads = std::max(1, options_.threads);
}

template <class Family>
PlannerOf<Family>::~PlannerOf() = default;

template <class Family>
auto PlannerOf<Family>::solve(std::stop_token stop) -> const Solution& {
    SolveOptions options = options_;
    options.stop = std::move(stop);
    options.map = unmapped_.empty() ? map_ : nullptr;  // a stopped replan() may have left the former one
    solution_ = planning::solved(problem_, model_, options);
    remember(solution_);
    if (solution_.status == Status::solved) {
        planning::take_order(problem_, solution_);
        bind();
    }
    return solution_;
}

/// The problem has another start or other goals.
template <class Family>
void PlannerOf<Family>::bind() {
    model_ = planning::model_of(problem_, model_);
}

template <class Family>
void PlannerOf<Family>::remember(const Solution& solution) {
    constexpr std::size_t most_places = 64;
    if (solution.map) {
        map_ = solution.map;
        unmapped_.clear();
    }
    if (solution.status == Status::solved) {
        plan_ = solution.plan;
    }
    if (!solution.tree.empty()) {
        places_ = carrying_places(solution.tree, most_places);
    }
}

template <class Family>
auto PlannerOf<Family>::latest() const -> std::optional<Answer> {
    const std::scoped_lock lock(mutex_);
    return latest_;
}

template <class Family>
void PlannerOf<Family>::publish(Call& call, Answer answer) {
    answer.after_wall_s = call.clock.seconds();
    call.best = std::move(answer);
    {
        const std::scoped_lock lock(mutex_);
        latest_ = call.best;
    }
    if (call.options.on_answer) {
        call.options.on_answer(call.best);
    }
}

/// Checks the changed problem before anything becomes another.
template <class Family>
void PlannerOf<Family>::apply(const SceneChange& change) {
    if (change.put.empty() && change.removed.empty() && !change.goal) {
        return;
    }
    Problem next = problem_;
    std::vector<BoundingBox> changed;
    const auto box_of = [&changed](const Obstacle& obstacle) { changed.push_back(Scene({obstacle}).bounds(0)); };
    const auto take_away = [&](const std::string& name) {
        const auto found = std::find_if(next.obstacles.begin(), next.obstacles.end(),
                                        [&](const Obstacle& obstacle) { return obstacle.name == name; });
        if (found == next.obstacles.end()) {
            return false;
        }
        box_of(*found);
        next.obstacles.erase(found);
        return true;
    };
    for (const std::string& name : change.removed) {
        if (name.empty() || !take_away(name)) {
            throw_input_error("has no obstacle '" + name + "' to remove: expected the name of one that is there",
                              "environment.obstacles");
        }
    }
    for (const Obstacle& obstacle : change.put) {
        if (!obstacle.name.empty()) {
            static_cast<void>(take_away(obstacle.name));
        }
        box_of(obstacle);
    }
    next.obstacles.insert(next.obstacles.end(), change.put.begin(), change.put.end());
    if (change.goal) {
        planning::set_goal(next, *change.goal);
    }
    throw_if_any(planning::errors_beside_start(next));
    problem_ = planning::with_places(std::move(next));
    model_ = planning::model_of(problem_, changed.empty() ? model_ : nullptr);
    unmapped_.insert(unmapped_.end(), changed.begin(), changed.end());
}

/// Goals whose hovers are over by a tick of the last plan need no further visit.
template <class Family>
void PlannerOf<Family>::drop_visited_goals(std::int64_t tick) {
    if (plan_) {
        planning::drop_visited(problem_, *model_, *plan_, tick);
    }
}

template <class Family>
bool PlannerOf<Family>::certifies() const {
    return problem_.uncertainty && problem_.planner.certify;
}

/// The worlds of a search, which are chosen so that dangers come early; none without an uncertainty.
template <class Family>
auto PlannerOf<Family>::worlds() const -> std::vector<FlownWorld> {
    return problem_.uncertainty ? planning::search_worlds(problem_) : std::vector<FlownWorld>{};
}

template <class Family>
bool PlannerOf<Family>::can_keep(const Plan& left, const StopCondition& is_over, double& cost) const {
    const auto flight = planning::executed(problem_, *model_, left);
    cost = planning::cost_when_executed(flight, problem_.planner.objective);
    if (!planning::is_good(flight, problem_.planner.safety_margin_m)) {
        return false;
    }
    const std::vector<FlownWorld> in = worlds();
    const planning::PlannerModelOf<Family> model(problem_.planner.variant, model_, map_);
    return in.empty() || planning::survives(problem_, model, options_.threads, left, in, is_over);
}

template <class Family>
auto PlannerOf<Family>::replan(const Start& start, std::int64_t tick, const SceneChange& change,
                               const ReplanOptions& options) -> Answer {
    Call call{options, {}, {}};
    throw_if_out_of_range(options);
    throw_if_any(start_errors(start, problem_.robot));  // it may be anywhere, but has to be of this robot
    if (!planning::is_finite(start)) {
        throw_input_error("has a number that is not finite: expected finite ones", "start");
    }
    apply(change);
    {
        const std::scoped_lock lock(mutex_);
        latest_.reset();
    }
    if (!change.goal) {
        drop_visited_goals(tick);
    }
    problem_.start = start;
    bind();
    using planning::reference_at;
    const auto reference = reference_at(start);
    Plan left = planning::blank_plan_of(*model_);
    left.reference.emplace_back();
    if (plan_ && !change.goal) {
        left = plan_->rest_after(tick);
    }
    left.reference.front().point = reference;

    planning::BrakingOf<Family> braking(problem_, model_, planning::map_around(problem_, *model_, map_, unmapped_),
                                        worlds(), options_.threads);
    Answer first;
    first.plan = left;
    if (auto stop = braking.best_stop(braking.moment_of(reference, start_state(*model_, start)))) {
        first.advice = stop->failures == 0 ? Advice::stop : Advice::none;
        first.plan = std::move(stop->plan);
    }
    publish(call, std::move(first));

    try {
        find_better(call, left, plan_ && !change.goal);
    } catch (const WorkStopped&) {  // there is what was found before
    }
    if (call.best.advice == Advice::keep || call.best.advice == Advice::follow) {
        plan_ = call.best.plan;
    } else {
        plan_.reset();
    }
    return call.best;
}

/// @param has_plan whether what is left leads to the goal
/// @throws WorkStopped when a stop is requested before the search
template <class Family>
void PlannerOf<Family>::find_better(Call& call, const Plan& left, bool has_plan) {
    const StopCondition is_over = [&call] { return call.options.stop.stop_requested(); };
    throw_if_over(is_over);
    const bool is_first_map = problem_.aero.enabled && !map_;
    if (problem_.aero.enabled && (!map_ || !unmapped_.empty())) {
        map_ = planning::map_after(problem_, *model_, map_, unmapped_, options_.map_cache);
        unmapped_.clear();
    }
    double cost = 0;
    if (has_plan && can_keep(left, is_over, cost)) {
        publish(call, {Advice::keep, left, cost, 0, {}});
    }
    search(call, left);
    if (is_first_map) {
        planning::keep(options_.map_cache, *map_);
    }
}

template <class Family>
void PlannerOf<Family>::search(Call& call, const Plan& left) {
    Problem next = problem_;
    next.planner.seed += ++searches_;  // certificates are flown in worlds that no earlier search has seen
    next.planner.time_limit_s = call.options.time_limit_s;
    next.planner.max_iterations = call.options.max_iterations;
    if (call.options.time_limit_s) {
        const double left_s = *call.options.time_limit_s - call.clock.seconds();
        if (left_s <= 0) {
            return;
        }
        next.planner.time_limit_s = left_s;
    }
    if (!planning::errors_of(next).empty()) {
        return;  // from where the vehicle is nothing can be planned, only stopped
    }
    SolveOptions options = options_;
    options.stop = call.options.stop;
    options.map = map_;
    options.known_plan = left;
    options.known_places = places_;
    Solution found = planning::solved(next, model_, options);
    if (found.status != Status::solved) {
        remember(found);
        return;
    }
    const double cost = planning::cost_when_executed(*found.execution, problem_.planner.objective);
    // The plan that is found may have a certificate, and what is kept has flown in the worlds of a search only.
    const bool is_better = call.best.advice != Advice::keep || certifies() || cost < call.best.cost;
    remember(found);
    if (is_better) {
        Answer answer{Advice::follow, *found.plan, cost, 0, {}};
        answer.solution = std::move(found);
        publish(call, std::move(answer));
    }
}

bool fly_along(const FlightModel& model, const AeroMap* map, const Plan& plan, std::int64_t ticks, FlightState& vehicle,
               const FlightWorld& in) {
    std::int64_t tick = in.first_tick;
    for (const ReferenceSegment& segment : plan.beginning(ticks).segments()) {
        if (fly(model, map, rules_of_execution(), segment, vehicle, {in.world, tick}).rejection != Rejection::none) {
            return false;
        }
        tick += segment.ticks();
    }
    return true;
}

bool fly_along(const SpaceProblemModel& model, const SurfaceVolumes* volumes, const SpacePlan& plan, std::int64_t ticks,
               AnySpaceState& vehicle, const planning::SpaceFlightWorld& in) {
    const SpaceProblem& problem = model.problem();
    SpacePoolSetup setup{problem.robot};
    if (volumes != nullptr) {
        setup.aero = simulation::space_aero(problem.aero, problem.robot.rotor_radius_m);
        setup.volumes = volumes;
    }
    SpaceFlightJob job{vehicle, {}, in.world, in.first_tick};
    for (const SpaceSegment& segment : plan.beginning(ticks).segments()) {
        job.legs.push_back({segment});
    }
    if (job.legs.empty()) {
        return true;
    }
    SpacePool(setup).fly(std::span(&job, 1));
    const SpaceFlightLeg* const rejected = job.rejected_leg();
    vehicle = rejected != nullptr ? rejected->end : job.end();
    return rejected == nullptr;
}

template <class Family>
auto PlannerOf<Family>::predicted(const Start& start, const Plan& plan, std::int64_t ticks) const -> Start {
    auto state = start_state(*model_, start);
    static_cast<void>(fly_along(*model_, map_.get(), plan, ticks, state));
    return start_of(*model_, state, plan.at(ticks));
}

template class PlannerOf<planning::Plane>;
template class PlannerOf<planning::Space>;

}  // namespace downwash
