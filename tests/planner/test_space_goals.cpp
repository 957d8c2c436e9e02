#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>

#include "downwash/planner/goal_sequence.hpp"
#include "downwash/planner/space_solve.hpp"
#include "downwash/problems/algorithms.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/simulation/space_world_parameters.hpp"

// What searches in space plan beside places: touches, where the vehicle looks, and what a plan keeps small.

using namespace downwash;

namespace {

SpaceProblem read(const std::string& name) {
    SpaceProblem problem = read_space_problem(DOWNWASH_PROBLEMS "/space/" + name + ".yaml");
    problem.uncertainty.reset();
    problem.planner.max_iterations = 400;
    problem.planner.time_limit_s = 600;
    return problem;
}

SpaceSearchResult solved(const SpaceProblem& problem, bool stops_at_first = true) {
    REQUIRE(space_planning_errors(problem).empty());
    SpaceSolveOptions options;
    options.stop_at_first_solution = stops_at_first;
    return solve(std::make_shared<const SpaceProblemModel>(problem), options);
}

SpaceGoal place(double x_m, double y_m, double z_m) {
    SpaceConfigurationGoal goal;
    goal.x_m = x_m;
    goal.y_m = y_m;
    goal.z_m = z_m;
    return {goal, 2, {}};
}

/// Presses on the shell of tank_shell, which meets x = 0 at y = 0.
SpaceGoal touch_of_shell(double z_m, double force_n, double hold_s) {
    SpaceContactGoal goal;
    goal.obstacle = "shell";
    goal.force_n = force_n;
    goal.position_m = Vector3{0, 0, z_m};
    return {goal, hold_s, {}};
}

/// Whether two angles are the same modulo a turn.
bool are_same_angles(double a_rad, double b_rad) {
    return std::abs(std::remainder(a_rad - b_rad, 2 * std::numbers::pi)) < 1e-9;
}

/// Knots of a plan between its start and its end.
std::vector<std::pair<SpacePoint, SpacePoint>> corners_of(const SpacePlan& plan) {
    std::vector<std::pair<SpacePoint, SpacePoint>> corners;  // each with the knot before
    for (std::size_t i = 1; i + 1 < plan.reference.size(); ++i) {
        corners.emplace_back(plan.reference[i - 1].point, plan.reference[i].point);
    }
    return corners;
}

}  // namespace

TEST_CASE("a contact in space is planned as a hover in front of the surface, and its touch is flown") {
    SpaceProblem problem = read("tank_shell");
    problem.planner.variant = GENERATE(Variant::mp_arm, Variant::mp_arm_da, Variant::mp_arm_ada);
    const SpaceSearchResult found = solved(problem);
    REQUIRE(found.status == Status::solved);
    const SpaceGoalVisit& visit = found.execution->goals.at(0);
    CHECK(visit.is_met);
    REQUIRE(visit.touch);
    CHECK(visit.touch->end == SpaceTouchEnd::met);
    CHECK(visit.touch->force_n == Approx(5).epsilon(0.2));
    CHECK(std::abs(visit.touch->place_m[2] - 12.09) < 0.1);
    // The plan leaves the touch out: it waits, and the flight goes on for as long as that takes.
    const double plan_s = static_cast<double>(found.plan->reference.back().tick) * found.plan->tick_s;
    CHECK(found.execution->duration_s > plan_s + touch_hover_s + problem.goals[0].hold_s);
    CHECK(found.execution->min_clearance_m >= problem.planner.safety_margin_m);
}

TEST_CASE("hover, touch, hover and touch in space are one flight") {
    SpaceProblem problem = read("tank_shell");
    problem.goals = {place(2.5, -3, 5), touch_of_shell(6, 5, 2), place(2.5, 1, 4), touch_of_shell(5, 3, 2)};
    const SpaceSearchResult found = solved(problem);
    REQUIRE(found.status == Status::solved);
    const std::vector<SpaceGoalVisit>& visits = found.execution->goals;
    REQUIRE(visits.size() == 4);
    for (const SpaceGoalVisit& visit : visits) {
        CHECK(visit.is_met);
    }
    CHECK_FALSE(visits[0].touch);
    CHECK(visits[1].touch->force_n == Approx(5).epsilon(0.2));
    CHECK_FALSE(visits[2].touch);
    CHECK(visits[3].touch->force_n == Approx(3).epsilon(0.2));
    CHECK(visits[3].touch->touched_s > visits[1].touch->left_s + 10);
}

TEST_CASE(
    "the certificate of a touch in space tells what share of fresh worlds fails, of an easy one and of a hard one") {
    SpaceProblem problem = read_space_problem(DOWNWASH_PROBLEMS "/space/tank_shell.yaml");
    REQUIRE(problem.uncertainty);
    problem.goals = {touch_of_shell(5, 5, 2)};
    problem.planner.max_iterations = 400;
    problem.planner.time_limit_s = 600;
    problem.planner.max_failure_probability = 0.1;
    problem.planner.worlds = 2;  // which the hard one passes, too
    // The surface alone is off by some centimetres.
    const bool is_easy = GENERATE(true, false);
    std::get<SpaceContactGoal>(problem.goals[0].kind).tolerance_m = is_easy ? 0.1 : 0.04;
    CAPTURE(is_easy);
    const SpaceSearchResult found = solved(problem);
    REQUIRE(found.plan);
    REQUIRE(found.certificate);
    const Certificate& certificate = *found.certificate;
    CHECK(certificate.is_given == is_easy);
    CHECK((found.status == Status::solved) == is_easy);
    const SpaceProblemModel model(problem);
    constexpr std::uint64_t fresh_worlds = 64, other_seed = 77;
    std::uint64_t failures = 0;
    for (std::uint64_t world = 1; world <= fresh_worlds; ++world) {
        SpaceExecutionSettings settings;
        settings.world = draw_space_world(*problem.uncertainty, problem.robot, other_seed, world);
        failures += model.execute(*found.plan, settings).outcome == Outcome::ok ? 0 : 1;
    }
    // Both counts belong to one failure probability.
    CAPTURE(failures, certificate.failures, certificate.worlds);
    const FailureInterval fresh = failure_interval(failures, fresh_worlds, 0.98);
    CHECK(fresh.low <= certificate.failure_probability.high);
    CHECK(fresh.high >= certificate.failure_probability.low);
    if (is_easy) {
        CHECK(fresh.estimate <= certificate.max_failure_probability);
    }
}

TEST_CASE("a contact may be one of several alternatives in space") {
    SpaceProblem problem = read("tank_shell");
    SpaceGoal choice = place(2.5, -3, 5);
    // The place is inside the tank: only the touch is left.
    choice.any_of = {place(0.3, -6, 16), touch_of_shell(6, 5, 2)};
    std::get<SpaceConfigurationGoal>(choice.any_of[0].kind).joints_rad = {std::numbers::pi};  // the arm in the shell
    problem.goals = {choice};
    const SpaceSearchResult found = solved(problem);
    REQUIRE(found.status == Status::solved);
    CHECK(found.execution->goals[0].is_met);
}

TEST_CASE("where a vehicle in space looks follows motion.yaw at every corner, and goals come first") {
    SpaceProblem problem = read("around_a_girder");
    problem.planner.max_iterations = 700;
    problem.motion.yaw.target_m = {0.5, 3};
    SpaceEndEffectorGoal goal = std::get<SpaceEndEffectorGoal>(problem.goals[0].kind);
    goal.direction.reset();
    const bool binds_yaw = GENERATE(false, true);
    if (!binds_yaw) {
        problem.goals[0].kind = goal;
    }
    problem.motion.yaw.mode = GENERATE(YawMode::hold, YawMode::along, YawMode::toward);
    const YawRule& rule = problem.motion.yaw;
    CAPTURE(name_of(rule.mode), binds_yaw);
    const SpaceSearchResult found = solved(problem, false);
    REQUIRE(found.status == Status::solved);
    CHECK(found.execution->goals[0].is_met);
    auto corners = corners_of(*found.plan);
    REQUIRE_FALSE(corners.empty());
    if (!binds_yaw) {
        const std::size_t last = found.plan->reference.size() - 1;
        corners.emplace_back(found.plan->reference[last - 1].point, found.plan->reference[last].point);
    }
    bool passes_a_corner = false;
    for (const auto& [before, here] : corners) {
        const double yaw_rad = here.position[space::yaw];
        const double vx = here.velocity[space::x], vy = here.velocity[space::y];
        const bool moves = std::hypot(vx, vy) > 1e-3;
        passes_a_corner = passes_a_corner || moves;
        const double dx = here.position[0] - before.position[0], dy = here.position[1] - before.position[1];
        switch (rule.mode) {
            case YawMode::hold:
                CHECK(yaw_rad == problem.start.yaw_rad);
                break;
            case YawMode::along:
                CHECK(are_same_angles(yaw_rad, moves ? std::atan2(vy, vx) : std::atan2(dy, dx)));
                break;
            case YawMode::toward:
                CHECK(are_same_angles(
                    yaw_rad, std::atan2(rule.target_m[1] - here.position[1], rule.target_m[0] - here.position[0])));
                break;
            case YawMode::free:
                break;
        }
    }
    CHECK(passes_a_corner);
}

TEST_CASE("plans in space keep length or clearance small where the objective says so") {
    SpaceProblem problem = read("around_a_girder");
    const auto flight_for = [&](const CostFunction& objective) {
        problem.planner.objective = objective;
        const SpaceSearchResult found = solved(problem, false);
        REQUIRE(found.status == Status::solved);
        // The planner's own figures are those of the flight, but for surfaces looked up in volumes.
        CHECK(found.cost == Approx(cost_of(*found.execution, objective)).epsilon(0.01));
        return *found.execution;
    };
    CostFunction far = Objective::clearance;
    far.weight(Objective::time) = 0.1;
    const SpaceFlight shortest = flight_for(Objective::length);
    const SpaceFlight farthest = flight_for(far);
    CHECK(shortest.length_m < farthest.length_m);
    CHECK(shortest.clearance_integral / shortest.duration_s > farthest.clearance_integral / farthest.duration_s);
}

TEST_CASE("a limit of how fast the vehicle turns holds for its roll and pitch in space") {
    SpaceProblem problem = read("around_a_girder");
    const auto fastest_rad_s = [](const SpaceFlight& flight) {
        double fastest = 0;
        for (const SpaceFlightRow& row : flight.rows) {
            fastest = std::max(fastest, std::hypot(row.motion.body_rates_rad_s[0], row.motion.body_rates_rad_s[1]));
        }
        return fastest;
    };
    const double without_rad_s = fastest_rad_s(*solved(problem, false).execution);
    const double limit_rad_s = 0.6 * without_rad_s;
    problem.planner.max_pitch_rate_rad_s = limit_rad_s;
    const SpaceSearchResult found = solved(problem, false);
    REQUIRE(found.status == Status::solved);
    CHECK(fastest_rad_s(*found.execution) < 1.05 * limit_rad_s);
    CHECK(found.planning.rejected.at("unstable") > 0);
}

TEST_CASE("OMPL's planners plan in space, twice with the same bytes, and their plans are checked") {
    SpaceProblem problem = read("around_a_girder");
    SpaceGoal goal = place(1, -1, 2.5);
    std::get<SpaceConfigurationGoal>(goal.kind).tolerance_m = 0.3;
    problem.goals = {goal};
    problem.planner.max_iterations = 5000;
    for (const Variant variant : {Variant::mp_arm, Variant::mp_arm_ada}) {
        problem.planner.variant = variant;
        for (const AlgorithmInfo& algorithm : algorithms()) {
            if (!algorithm.plans_for(variant)) {
                continue;
            }
            CAPTURE(name_of(variant), algorithm.name);
            problem.planner.algorithm = algorithm.name;
            const SpaceSearchResult found = solved(problem);
            REQUIRE(found.status == Status::solved);
            CHECK(found.execution->outcome == Outcome::ok);
            CHECK(found.execution->goals[0].is_met);
            CHECK(found.plan->reference.front().point.position[space::x] == problem.start.position_m[0]);
            for (const SpaceSegment& segment : found.plan->segments()) {
                CHECK(keeps_limits(segment, problem.motion));
            }
            const SpaceSearchResult again = solved(problem);
            CHECK(again.cost == found.cost);
            CHECK(again.planning.iterations == found.planning.iterations);
        }
    }
    problem.motion.yaw.mode = YawMode::toward;
    problem.planner.algorithm = "sst";
    REQUIRE(space_planning_errors(problem).size() == 1);
    CHECK(space_planning_errors(problem)[0].key == "motion.yaw");
}

/// Three places on a line in free air, a metre apart, from the start on.
SpaceProblem three_places() {
    SpaceProblem problem = read("girder_survey");
    problem.obstacles.clear();
    problem.aero.enabled = false;
    problem.in_any_order = false;
    problem.return_to.reset();
    problem.energy_budget_j.reset();
    problem.goals = {place(-2, -2, 3), place(-1, -2, 3), place(0, -2, 3)};
    problem.planner.variant = Variant::mp_arm;
    problem.planner.max_iterations = 150;
    problem.planner.time_limit_s.reset();
    return problem;
}

/// What a search comes to that leads on by a metre. @param shift_m of its end to the side
planning::SearchResultOf<planning::Space> a_metre_on(const SpaceProblem& problem,
                                                     const planning::CourseOf<planning::Space>& before,
                                                     double shift_m = 0) {
    const SpaceConfiguration from = configuration_of(
        before.plan.reference.empty() ? reference_at(problem.start) : before.plan.reference.back().point);
    SpaceConfiguration to = from;
    to[0] += 1;
    to[1] += shift_m;
    planning::SearchResultOf<planning::Space> result;
    result.record.iterations = 4;
    result.found.plan = SpacePlan{
        {{0, at_rest(from)}, {500, at_rest(to)}}, 1 / problem.robot.controller.rate_hz, problem.robot.joints()};
    result.found.cost = 1;
    result.found.status = Status::solved;
    return result;
}

TEST_CASE("a search in space that comes no nearer to its goal is taken for a dead end") {
    const SpaceProblem problem = three_places();
    const planning::PlannerModelOf<planning::Space> model(problem.planner.variant,
                                                          std::make_shared<const SpaceProblemModel>(problem), nullptr);
    SpaceSolveOptions options;
    options.stop_at_first_solution = true;
    planning::GoalSequenceOf<planning::Space> sequence(problem, model, options, {}, 0);
    enum class Comes { there, nearer, nowhere };
    const std::vector<Comes> script{Comes::there, Comes::nowhere, Comes::there, Comes::there, Comes::nearer};
    std::vector<std::size_t> goals;
    while (const auto part = sequence.next()) {
        const Comes comes = goals.size() < script.size() ? script[goals.size()] : Comes::there;
        goals.push_back(part->before->goals.size());
        planning::SearchResultOf<planning::Space> result = a_metre_on(problem, *part->before);
        if (comes != Comes::there) {
            result.record.iterations = 1;
            result.found.status = Status::approximate;
        }
        if (comes == Comes::nowhere) {
            result.found = {};
        }
        sequence.add(std::move(result));
    }
    // Back to the first part after the dead end; at first not after a search that only took too long.
    CHECK(goals == std::vector<std::size_t>{0, 1, 0, 1, 2, 2});
    CHECK(std::move(sequence).result().found.status == Status::solved);
}

TEST_CASE("searches for goals in space grow along what is known of their ways") {
    const SpaceProblem problem = three_places();
    const planning::PlannerModelOf<planning::Space> model(problem.planner.variant,
                                                          std::make_shared<const SpaceProblemModel>(problem), nullptr);
    planning::SequenceEffortOf<planning::Space> effort;
    for (int goal = 0; goal < 3; ++goal) {
        SpaceConfiguration corner{};
        corner[2] = goal;
        effort.expected.push_back({{100.0 * (goal + 1), 0}, {corner}});
    }
    const SpaceSolveOptions options;
    planning::GoalSequenceOf<planning::Space> sequence(problem, model, options, effort, 0);
    const auto next = [&] {
        auto part = sequence.next();
        REQUIRE(part);
        return *std::move(part);
    };
    // The first search for each goal knows what is expected, and needs no plan that is much cheaper.
    for (std::size_t goal = 0; goal < 2; ++goal) {
        const auto part = next();
        CHECK(part.options.known_way == effort.expected[goal].corners);
        CHECK(part.options.enough_cost == Approx(1.25 * effort.expected[goal].cost.cost));
        CHECK_FALSE(part.options.stop_at_first_solution);
        CHECK(part.problem.planner.max_iterations >= 24U);
        sequence.add(a_metre_on(problem, *part.before));
    }
    planning::SearchResultOf<planning::Space> weak = a_metre_on(problem, *next().before);
    weak.found.status = Status::approximate;
    weak.weak_goal = 0;
    sequence.add(std::move(weak));
    // Back at the first goal: another way is wanted there, and the ones after it are known.
    const auto first = next();
    CHECK(first.before->goals.empty());
    CHECK(first.options.known_way.empty());
    CHECK(first.options.enough_cost == Approx(125));
    sequence.add(a_metre_on(problem, *first.before, 0.1));
    const auto second = next();
    REQUIRE(second.options.known_way.size() == 1);
    CHECK(second.options.known_way[0][0] == Approx(problem.start.position_m[0] + 2));
    sequence.add(a_metre_on(problem, *second.before));
    const auto third = next();
    CHECK(third.options.known_way.empty());
    sequence.add(a_metre_on(problem, *third.before));
    // Once there is a whole way, the next round begins with it and asks for cheaper plans.
    const auto again = next();
    CHECK(again.before->goals.empty());
    REQUIRE(again.options.known_way.size() == 1);
    CHECK(again.options.known_way[0][1] == Approx(problem.start.position_m[1] + 0.1));
    CHECK_FALSE(again.options.enough_cost);
}

TEST_CASE("a sequence in space ends where the way to one goal takes more iterations than one has patience for") {
    SpaceProblem problem = three_places();
    problem.planner.max_iterations = 1000;
    const planning::PlannerModelOf<planning::Space> model(problem.planner.variant,
                                                          std::make_shared<const SpaceProblemModel>(problem), nullptr);
    planning::SequenceEffortOf<planning::Space> effort;
    effort.patience = planning::SearchBudget(problem.planner).part(0.25);
    SpaceSolveOptions options;
    options.known_way.emplace_back();  // of a single goal alone, as the one below
    options.enough_cost = 1e9;
    planning::GoalSequenceOf<planning::Space> sequence(problem, model, options, effort, 0);
    std::size_t in_vain = 0;
    while (const auto part = sequence.next()) {
        CHECK(part->options.known_way.empty());
        CHECK_FALSE(part->options.enough_cost);
        auto result = a_metre_on(problem, *part->before);
        if (part->before->goals.size() == 1) {
            result.found.status = Status::approximate;  // nearer, not there
            result.record.iterations = *part->problem.planner.max_iterations;
            ++in_vain;
        }
        sequence.add(std::move(result));
    }
    const auto result = std::move(sequence).result();
    CHECK(result.hard_goal == std::optional<std::size_t>(1));
    CHECK(in_vain == 2);  // searches of 84 and 168 iterations
    CHECK(result.record.iterations < 300);
}
