#include "downwash/planner/planner.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "downwash/aeromap/map_cache.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/planner/braking.hpp"
#include "downwash/planner/direct_flight.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/planner/stopwatch.hpp"
#include "downwash/planner/world_flights.hpp"
#include "downwash/planner/worlds.hpp"
#include "downwash/search/search_space.hpp"

namespace downwash {
namespace {

/// The places with the most places beyond them, those nearer to the root first.
std::vector<Configuration> carrying_places(const std::vector<TreeNode>& tree, std::size_t most) {
    std::vector<std::size_t> beyond(tree.size(), 1);
    for (std::size_t i = tree.size(); i-- > 0;) {  // parents may come later in the list, after a rewiring
        for (int parent = tree[i].parent; parent != TreeNode::no_parent;
             parent = tree[static_cast<std::size_t>(parent)].parent) {
            ++beyond[static_cast<std::size_t>(parent)];
        }
    }
    std::vector<std::size_t> order(tree.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return beyond[a] > beyond[b]; });
    std::vector<Configuration> places;
    for (const std::size_t i : order) {
        if (places.size() < most && beyond[i] > 1 && tree[i].parent != TreeNode::no_parent) {
            places.push_back(tree[i].at);
        }
    }
    return places;
}

/// Checks the limits of PlannerSettings. No time at all is allowed, too: then there is only the stop.
void throw_if_out_of_range(const ReplanOptions& options) {
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

bool is_finite(const Start& start) {
    const ReferencePoint reference = start.reference.value_or(ReferencePoint{});
    double sum = start.pitch_rad + start.pitch_rate_rad_s;
    for (std::size_t axis = 0; axis < max_axes; ++axis) {
        sum += start.at[axis] + start.velocity[axis];
        sum += reference.position[axis] + reference.velocity[axis] + reference.acceleration[axis];
    }
    return std::isfinite(sum);
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
struct Planner::Call {
    const ReplanOptions& options;
    planning::Stopwatch clock;
    Answer best;
};

Planner::Planner(const Problem& problem, SolveOptions options) : options_(std::move(options)) {
    PlannableProblem checked = plannable(problem);
    problem_ = std::move(checked.problem);
    model_ = std::move(checked.model);
    options_.map = nullptr;
    options_.known_plan.reset();
    options_.known_places.clear();
    options_.keep_tree = true;
    options_.threads = std::max(1, options_.threads);
}

Planner::~Planner() = default;

const Solution& Planner::solve(std::stop_token stop) {
    SolveOptions options = options_;
    options.stop = std::move(stop);
    options.map = unmapped_.empty() ? map_ : nullptr;  // a stopped replan() may have left the former one
    solution_ = downwash::solve(PlannableProblem{problem_, model_}, options);
    remember(solution_);
    if (solution_.status == Status::solved) {
        problem_ = in_order(problem_, solution_.order);
        problem_.energy_budget_j.reset();  // how much of it a vehicle has left, it knows itself
    }
    return solution_;
}

void Planner::remember(const Solution& solution) {
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

std::optional<Answer> Planner::latest() const {
    const std::scoped_lock lock(mutex_);
    return latest_;
}

void Planner::publish(Call& call, Answer answer) {
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
void Planner::apply(const SceneChange& change) {
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
        next.goals_before.clear();
        next.targets.clear();
        next.return_to.reset();
        next.energy_budget_j.reset();
        next.goal = *change.goal;
    }
    std::vector<KeyError> errors;
    for (KeyError& error : problem_errors(next)) {
        if (!error.key.starts_with("start")) {  // a vehicle is where it is
            errors.push_back(std::move(error));
        }
    }
    throw_if_any(std::move(errors));
    if (!changed.empty()) {
        model_ = make_flight_model(next);
        unmapped_.insert(unmapped_.end(), changed.begin(), changed.end());
    }
    problem_ = std::move(next);
}

/// Goals whose hovers are over by a tick of the last plan need no further visit.
void Planner::drop_visited_goals(std::int64_t tick) {
    if (!plan_ || problem_.goals_before.empty()) {
        return;
    }
    const std::vector<std::size_t> ends = hover_ends(*model_, plan_->reference, goals_of(problem_));
    const auto visited =
        std::count_if(ends.begin(), ends.end(), [&](std::size_t knot) { return plan_->reference[knot].tick <= tick; });
    problem_.goals_before.erase(
        problem_.goals_before.begin(),
        problem_.goals_before.begin() + std::min<std::ptrdiff_t>(visited, std::ssize(problem_.goals_before)));
}

bool Planner::certifies() const {
    return problem_.uncertainty && problem_.planner.certify;
}

/// The worlds of a search, which are chosen so that dangers come early; none without an uncertainty.
std::vector<FlownWorld> Planner::worlds() const {
    return problem_.uncertainty ? planning::search_worlds(problem_) : std::vector<FlownWorld>{};
}

bool Planner::can_keep(const Plan& left, const StopCondition& is_over, double& cost) const {
    const Execution flight = execute(*model_, start_state(*model_, problem_.start), left.reference, goals_of(problem_),
                                     problem_.aero.enabled);
    cost = cost_of(flight, problem_.planner.objective);
    if (!planning::is_good(flight, problem_.planner.safety_margin_m)) {
        return false;
    }
    const std::vector<FlownWorld> in = worlds();
    if (in.empty()) {
        return true;
    }
    WorldFlights flights(problem_, model_, map_, options_.threads);
    const std::vector<WorldFlight> flown = flights.fly(left, goals_of(problem_).size(), in, is_over);
    return std::all_of(flown.begin(), flown.end(),
                       [](const WorldFlight& each) { return each.rejection == Rejection::none; });
}

/// A map around some places of the vehicle: the one that is there, if nothing has changed over or under them.
std::shared_ptr<const AeroMap> Planner::map_around(const Bounds& places) const {
    if (!problem_.aero.enabled) {
        return nullptr;
    }
    if (map_ && !map_->is_touched(unmapped_, rotor_extent(problem_.robot.rotors, places))) {
        return map_;
    }
    return model_->make_map(places);
}

Answer Planner::replan(const Start& start, std::int64_t tick, const SceneChange& change, const ReplanOptions& options) {
    Call call{options, {}, {}};
    throw_if_out_of_range(options);
    throw_if_any(start_errors(start, problem_.robot));  // it may be anywhere, but has to be of this robot
    if (!is_finite(start)) {
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
    const ReferencePoint reference = planning::reference_at(start);
    Plan left{{{}}, model_->tick().tick_s};
    if (plan_ && !change.goal) {
        left = plan_->rest_after(tick);
    }
    left.reference.front().point = reference;

    planning::Braking braking(
        problem_, model_, [this](const Bounds& places) { return map_around(places); }, worlds(), options_.threads);
    Answer first;
    first.plan = left;
    if (auto stop = braking.best_stop(start)) {
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
void Planner::find_better(Call& call, const Plan& left, bool has_plan) {
    const StopCondition is_over = [&call] { return call.options.stop.stop_requested(); };
    throw_if_over(is_over);
    const bool is_first_map = problem_.aero.enabled && !map_;
    if (problem_.aero.enabled && (!map_ || !unmapped_.empty())) {
        map_ = map_ ? model_->remake_map(*map_, unmapped_) : model_->make_map(problem_.bounds, options_.map_cache);
        unmapped_.clear();
    }
    double cost = 0;
    if (has_plan && can_keep(left, is_over, cost)) {
        publish(call, {Advice::keep, left, cost, 0, {}});
    }
    search(call, left);
    if (is_first_map) {
        keep_map(options_.map_cache, *map_);
    }
}

void Planner::search(Call& call, const Plan& left) {
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
    if (!problem_errors(next).empty()) {
        return;  // from where the vehicle is nothing can be planned, only stopped
    }
    SolveOptions options = options_;
    options.stop = call.options.stop;
    options.map = map_;
    options.known_plan = left;
    options.known_places = places_;
    Solution found = downwash::solve(PlannableProblem{next, model_}, options);
    // The plan that is found may have a certificate, and what is kept has flown in the worlds of a search only.
    const bool is_better = found.status == Status::solved &&
                           (call.best.advice != Advice::keep || certifies() || found.execution_cost < call.best.cost);
    remember(found);
    if (is_better) {
        Answer answer{Advice::follow, *found.plan, found.execution_cost, 0, {}};
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

Start Planner::predicted(const Start& start, const Plan& plan, std::int64_t ticks) const {
    FlightState state = start_state(*model_, start);
    static_cast<void>(fly_along(*model_, map_.get(), plan, ticks, state));
    return start_of(*model_, state, plan.at(ticks));
}

}  // namespace downwash
