#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "../support/test_problem.hpp"
#include "downwash/planner/goal_search.hpp"
#include "downwash/planner/goal_sequence.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/planner/stop_finder.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/simulation/world_parameters.hpp"

using namespace downwash;

namespace {

/// A flight of 7 m between ground and ceiling to a place in the middle of the air.
Problem long_flight() {
    Problem problem = test::with_place(4, 2.5);
    problem.start.at[plane::z] = 2.5;
    problem.planner.max_iterations = 600;
    return problem;
}

/// A finder of stops for whom something hangs in the middle of the way that no plan knows of.
struct StricterStops {
    explicit StricterStops(Problem known) : problem(std::move(known)) {
        problem.obstacles.push_back(test::box("hanging", {1.6, 6, 1.2}, {0, 0, 2.9}));
        model = make_flight_model(problem);
        finder.emplace(problem, model, model->make_map(problem.bounds), std::vector<FlownWorld>());
    }
    Problem problem;
    std::shared_ptr<const FlightModel> model;
    std::optional<planning::StopFinder> finder;
};

planning::SearchResult result_of(const Problem& problem, planning::StopFinder* stop_finder,
                                 const SolveOptions& options) {
    const auto model = make_flight_model(problem);
    return planning::search_goal(problem, problem, {problem.planner.variant, model, model->make_map(problem.bounds)},
                                 planning::Course::from_start(problem, *model), {nullptr, stop_finder}, options);
}

Found searched(const Problem& problem, planning::StopFinder* stop_finder, const SolveOptions& options) {
    return result_of(problem, stop_finder, options).found;
}

}  // namespace

TEST_CASE("a plan has a stop at each knot and every half second, and no stop where something is in the way") {
    const Problem problem = long_flight();
    const Solution solution = solve(problem);
    REQUIRE(solution.plan);
    planning::StopFinder finder(problem, make_flight_model(problem), solution.map, {});
    const SafeStops stops = finder.along(*solution.plan);
    CHECK(stops.share_without == 0);
    for (const ReferenceKnot& knot : solution.plan->reference) {
        CHECK(std::any_of(stops.moments.begin(), stops.moments.end(),
                          [&](const SafeStops::Moment& moment) { return moment.tick == knot.tick && moment.rest; }));
    }
    for (std::size_t i = 1; i < stops.moments.size(); ++i) {
        const std::int64_t ticks = stops.moments[i].tick - stops.moments[i - 1].tick;
        CHECK(ticks > 0);
        CHECK(static_cast<double>(ticks) * solution.plan->tick_s <= 0.5 + 1e-9);
    }
    StricterStops stricter(problem);
    const SafeStops fewer = stricter.finder->along(*solution.plan);
    CHECK(fewer.share_without > 0.05);
    CHECK(fewer.share_without < 1);
    CHECK(is_clearly_worse(fewer, stops));
    CHECK_FALSE(is_clearly_worse(stops, fewer));
    CHECK_FALSE(is_clearly_worse(stops, stops));
}

TEST_CASE("stops of a plan are the same whether the finder knows a plan with the same beginning or not") {
    Problem problem = long_flight();
    problem.uncertainty.emplace();
    problem.planner.certify = false;
    problem.planner.worlds = 3;
    const Solution solution = solve(problem);
    REQUIRE(solution.plan);
    const auto model = make_flight_model(problem);
    std::vector<FlownWorld> worlds;
    for (const std::uint64_t index : {1, 2}) {
        worlds.push_back(make_world(problem.robot, draw_world(*problem.uncertainty, problem.robot, 1, index)));
    }
    const auto finder = [&] { return planning::StopFinder(problem, model, solution.map, worlds); };
    // Another way from the middle on.
    Plan other = *solution.plan;
    const std::int64_t middle = other.reference.back().tick / 2;
    other = other.beginning(middle).followed_by(other.rest_after(middle));
    other.reference.back().point.position[plane::z] -= 0.2;
    planning::StopFinder knowing = finder();
    const SafeStops first = knowing.along(*solution.plan);
    for (const Plan& plan : {other, *solution.plan}) {
        const SafeStops again = knowing.along(plan);
        const SafeStops anew = finder().along(plan);
        CHECK(again.share_without == anew.share_without);
        REQUIRE(again.moments.size() == anew.moments.size());
        for (std::size_t i = 0; i < anew.moments.size(); ++i) {
            CHECK(again.moments[i].tick == anew.moments[i].tick);
            CHECK(again.moments[i].duration_s == anew.moments[i].duration_s);
            REQUIRE(again.moments[i].rest.has_value() == anew.moments[i].rest.has_value());
            CHECK((!anew.moments[i].rest || at_rest(*again.moments[i].rest) == at_rest(*anew.moments[i].rest)));
        }
    }
    CHECK(first.moments.size() > 5);
}

TEST_CASE("a cheaper plan that can be left for a hover for less of its time does not replace one that can for more") {
    const Problem problem = long_flight();
    StricterStops stricter(problem);
    const Found free = searched(problem, nullptr, {});
    REQUIRE(free.status == Status::solved);
    CHECK_FALSE(free.safe_stops);
    std::vector<double> shares;
    SolveOptions options;
    options.on_plan = [&](const FoundPlan& found) {
        shares.push_back(stricter.finder->along(found.plan).share_without);
    };
    const planning::SearchResult result = result_of(problem, &*stricter.finder, options);
    const Found& preferring = result.found;
    REQUIRE(preferring.status == Status::solved);
    const Candidates& candidates = result.record.candidates;
    CHECK(candidates.worse_stops > 0);
    CHECK(candidates.unfinished == 0);
    CHECK(result.record.rejected.at("direct_flight") ==
          candidates.failed_execution + candidates.failed_certificate + candidates.worse_stops);
    REQUIRE(preferring.safe_stops);
    CHECK(preferring.safe_stops->share_without == shares.back());
    for (std::size_t i = 1; i < shares.size(); ++i) {
        CHECK(shares[i] <= shares[i - 1] + 0.01);
    }
    CHECK(stricter.finder->along(*free.plan).share_without > preferring.safe_stops->share_without + 0.01);
    CHECK(preferring.cost > free.cost);
}

TEST_CASE("of two ways through several goals the one that can be left for more of its time is taken") {
    Problem problem = long_flight();
    problem.goals_before = {test::configuration_goal(0, 2.5)};
    problem.goals_before[0].hold_s = 1;
    problem.planner.max_iterations = 400;
    const auto flight_model = make_flight_model(problem);
    const planning::PlannerModel model{problem.planner.variant, flight_model, flight_model->make_map(problem.bounds)};
    const bool is_first_better = GENERATE(true, false);
    CAPTURE(is_first_better);
    double first_cost = 0;
    int ways = 0;
    const SolveOptions options;
    planning::GoalSequence sequence(problem, model, options, {}, 0);
    while (const auto part = sequence.next()) {
        planning::SearchResult result =
            planning::search_goal(part->problem, problem, model, *part->before, {}, part->options);
        Found& found = result.found;
        if (part->before->goals.size() == 1 && found.status == Status::solved) {
            found.safe_stops.emplace();
            found.safe_stops->share_without = (ways++ == 0) == is_first_better ? 0.2 : 0.4;
            if (ways == 1) {
                first_cost = part->before->cost + found.cost;
            }
        }
        sequence.add(std::move(result));
    }
    const Found found = std::move(sequence).result().found;
    REQUIRE(found.status == Status::solved);
    REQUIRE(ways > 1);
    REQUIRE(found.safe_stops);
    CHECK(found.safe_stops->share_without == 0.2);
    CHECK((found.cost == first_cost) == is_first_better);
}
