#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <vector>

#include "downwash/planner/space_solve.hpp"
#include "downwash/planner/stop_finder.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/results/space_solution_file.hpp"
#include "downwash/simulation/space_place.hpp"

using namespace downwash;
using planning::Space;

namespace {

using SpaceBraking = planning::BrakingOf<Space>;

/// The shipped plan around a girder.
struct AroundAGirder {
    AroundAGirder() : AroundAGirder(read_space_problem(DOWNWASH_PROBLEMS "/space/around_a_girder.yaml")) {}
    explicit AroundAGirder(SpaceProblem its_problem)
        : problem(std::move(its_problem)),
          model(std::make_shared<const SpaceProblemModel>(problem)),
          volumes(make_volumes(*model)),
          plan(*read_solution(DOWNWASH_PROBLEMS "/space/around_a_girder.json", problem).plan) {}

    SpaceProblem problem;
    std::shared_ptr<const SpaceProblemModel> model;
    std::shared_ptr<const SurfaceVolumes> volumes;
    SpacePlan plan;
};

/// The vehicle at each tick of a plan, as the planner's own model flies it.
std::vector<AnySpaceState> states_along(const AroundAGirder& its) {
    SpacePoolSetup setup{its.problem.robot};
    setup.aero = simulation::space_aero(its.problem.aero, its.problem.robot.rotor_radius_m);
    setup.volumes = its.volumes.get();
    SpaceFlightJob job{start_state(*its.model, its.problem.start), {}};
    for (const SpaceSegment& segment : its.plan.divided(1).segments()) {
        job.legs.push_back({segment});
    }
    SpacePool(setup).fly(std::span(&job, 1));
    REQUIRE(job.rejection() == Rejection::none);
    std::vector<AnySpaceState> states{job.start};
    for (const SpaceFlightLeg& leg : job.legs) {
        states.push_back(leg.end);
    }
    return states;
}

SpaceProblem with_something_in_the_way() {
    SpaceProblem problem = read_space_problem(DOWNWASH_PROBLEMS "/space/around_a_girder.yaml");
    problem.uncertainty.reset();
    return problem;
}

}  // namespace

TEST_CASE("a stop from every tick of a plan in space is flown without a collision") {
    const AroundAGirder its;
    SpaceBraking braking(its.problem, its.model, [&] { return its.volumes; }, {});
    const std::vector<AnySpaceState> states = states_along(its);
    std::vector<SpaceBraking::Moment> moments;
    for (std::size_t tick = 0; tick < states.size(); ++tick) {
        moments.push_back(braking.moment_of(its.plan.at(static_cast<std::int64_t>(tick)), states[tick]));
    }
    const auto stops = braking.best_stops(moments);
    REQUIRE(stops.size() == states.size());
    for (std::size_t tick = 0; tick < stops.size(); ++tick) {
        CAPTURE(tick);
        REQUIRE(stops[tick]);
        CHECK(stops[tick]->failures == 0);
        const SpacePlan& plan = stops[tick]->plan;
        CHECK(plan.reference.front().point == moments[tick].reference);
        CHECK(is_at_rest(plan.reference.back().point));
        if (tick % 50 != 0) {
            continue;
        }
        // Among surfaces that are evaluated directly, step by step.
        SpaceProblem from = its.problem;
        from.start = start_of(*its.model, states[tick], moments[tick].reference);
        const SpaceFlight flight =
            SpaceProblemModel(from, *its.model).execute_part(plan.held_for(std::llround(3 / plan.tick_s)));
        CHECK(flight.outcome == Outcome::ok);
        CHECK(flight.min_clearance_m > 0);
        const Vector3 off = flight.rows.back().motion.velocity_m_s;
        CHECK(std::sqrt(dot(off, off)) < 0.05);
    }
}

TEST_CASE("in space a vehicle that is too near for any stop is told which way fails least") {
    AroundAGirder its(with_something_in_the_way());
    const std::vector<AnySpaceState> states = states_along(its);
    const auto fastest = std::ranges::max_element(states, {}, [](const AnySpaceState& state) {
        const Vector3 v = motion_of(state).velocity_m_s;
        return dot(v, v);
    });
    const auto tick = static_cast<std::int64_t>(fastest - states.begin());
    const Vector3 v = motion_of(*fastest).velocity_m_s;
    const Vector3 ahead = (1 / std::sqrt(dot(v, v))) * v;
    for (const double away_m : {3.0, 0.75}) {
        CAPTURE(away_m);
        SpaceProblem blocked = its.problem;
        blocked.bounds = {{-5, -5, 0.5}, {5, 5, 6}};
        blocked.obstacles = {{"ball", Sphere{0.3}, motion_of(*fastest).position_m + away_m * ahead}};
        const auto model = std::make_shared<const SpaceProblemModel>(blocked);
        const auto volumes = make_volumes(*model);
        SpaceBraking braking(blocked, model, [&] { return volumes; }, {});
        const auto stop = braking.best_stop(braking.moment_of(its.plan.at(tick), *fastest));
        REQUIRE(stop);
        CHECK((stop->failures == 0) == (away_m > 1));
    }
}

TEST_CASE("a plan in space has a stop at each knot and every half second, safe in all worlds of the search") {
    AroundAGirder its;
    its.problem.planner.worlds = 3;
    const std::vector<SpaceWorld> worlds = planning::search_worlds(its.problem);
    REQUIRE(worlds.size() == 2);
    planning::StopFinderOf<Space> finder(its.problem, its.model, its.volumes, worlds);
    const auto stops = finder.along(its.plan);
    CHECK(stops.share_without == 0);
    for (const SpaceKnot& knot : its.plan.reference) {
        CHECK(std::ranges::any_of(stops.moments,
                                  [&](const auto& moment) { return moment.tick == knot.tick && moment.rest; }));
    }
    for (std::size_t i = 1; i < stops.moments.size(); ++i) {
        const std::int64_t ticks = stops.moments[i].tick - stops.moments[i - 1].tick;
        CHECK(ticks > 0);
        CHECK(static_cast<double>(ticks) * its.plan.tick_s <= 0.5 + 1e-9);
    }
    // Known moments say the same again.
    const auto again = finder.along(its.plan);
    REQUIRE(again.moments.size() == stops.moments.size());
    for (std::size_t i = 0; i < stops.moments.size(); ++i) {
        CHECK(again.moments[i].rest == stops.moments[i].rest);
    }
}

TEST_CASE("a search in space says where its plan can be left for a hover") {
    SpaceProblem problem = with_something_in_the_way();
    problem.planner.max_iterations = 400;
    problem.planner.time_limit_s = 100;
    SpaceSolveOptions options;
    options.stop_at_first_solution = true;
    options.finds_stops = true;
    const SpaceSearchResult found = solve(std::make_shared<const SpaceProblemModel>(problem), options);
    REQUIRE(found.status == Status::solved);
    REQUIRE(found.safe_stops);
    CHECK(found.safe_stops->moments.front().tick == 0);
    CHECK(found.safe_stops->moments.back().tick == found.plan->reference.back().tick);
    CHECK(found.safe_stops->share_without < 0.2);
}
