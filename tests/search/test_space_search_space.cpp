#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numbers>

#include "../support/space_robots.hpp"
#include "downwash/controllers/space_duration.hpp"
#include "downwash/search/free_air_cost.hpp"
#include "downwash/search/planned_flights.hpp"
#include "downwash/search/space_search_space.hpp"

using namespace downwash;

namespace {

constexpr double degree = std::numbers::pi / 180;

/// A box over the ground and a goal for the tip of an arm of two joints, which shall point sideways.
SpaceProblem box_problem() {
    SpaceProblem problem;
    problem.robot = test::space_robot(2);
    for (SpaceLinkLimits& link : problem.robot.links) {
        link.is_limited = true;
        link.lower_limit_rad = -100 * degree;
        link.upper_limit_rad = 100 * degree;
    }
    problem.robot.body.push_back({Box{{0.3, 0.3, 0.1}}});
    problem.bounds = {{-2, -2, 0.5}, {2, 2, 3}};
    Obstacle box;
    box.name = "box";
    box.shape = Box{{0.5, 0.5, 0.5}};
    box.center_world_m = {0, 0, 1};
    problem.obstacles.push_back(box);
    problem.start.position_m = {-1.5, 0, 1.5};
    SpaceEndEffectorGoal tip;
    tip.position_m = {1, 1, 1.5};
    tip.direction = Vector3{0, 1, 0};
    tip.direction_tolerance_rad = 15 * degree;
    SpaceGoal goal;
    goal.kind = tip;
    problem.goals.push_back(goal);
    problem.aero.enabled = false;
    return problem;
}

struct Fixture {
    SpaceProblem problem = box_problem();
    std::shared_ptr<const SpaceProblemModel> model = std::make_shared<const SpaceProblemModel>(problem);
    planning::SearchTaskOf<planning::Space> task{problem, *model, nullptr};
    const planning::SpaceSearchSpace& space = task.space;
    planning::Random random{7};
};

}  // namespace

TEST_CASE("the distance of configurations in space is a metric without weights, and yaw goes the shorter way") {
    Fixture f;
    for (int i = 0; i < 300; ++i) {
        const SpaceConfiguration a = f.space.sample(f.random), b = f.space.sample(f.random),
                                 c = f.space.sample(f.random);
        const double ab = f.space.distance_m(a, b);
        CHECK(ab == Approx(f.space.distance_m(b, a)).epsilon(1e-12));
        CHECK(ab <= f.space.distance_m(a, c) + f.space.distance_m(c, b) + 1e-12);
        CHECK(f.space.distance_m(a, a) == 0);
        // It is the time of the reference that is flown, at the top speed.
        const SpaceConfiguration seen = f.space.seen_from(a, b);
        const std::int64_t ticks = shortest_ticks(at_rest(a), at_rest(seen), f.problem.motion, f.task.tick_s);
        const double duration_s = ab * planning::peak_over_mean_speed / f.problem.motion.max_speed_m_s;
        CHECK(static_cast<double>(ticks) * f.task.tick_s >= duration_s - 1e-9);
        CHECK(static_cast<double>(ticks - 1) * f.task.tick_s < duration_s + 1e-9);
    }
    SpaceConfiguration east{}, west{};
    east[space::yaw] = 170 * degree;
    west[space::yaw] = -170 * degree;
    CHECK(f.space.seen_from(east, west)[space::yaw] == Approx(190 * degree));
}

TEST_CASE("samples in space keep bounds and limits, and those at a goal meet it without a collision") {
    Fixture f;
    int found = 0;
    for (int i = 0; i < 50; ++i) {
        CHECK(f.space.is_inside(f.space.sample(f.random)));
        if (const auto sample = f.space.sample_goal(f.random)) {
            ++found;
            CHECK(f.space.is_near_goal(*sample));
            CHECK(f.space.is_valid(*sample));
            CHECK(f.space.goal_distance_m(*sample) == 0);
            if (const auto near = f.space.sample_goal_near(*sample, 0.2, f.random)) {
                CHECK(f.space.is_near_goal(*near));
            }
            CHECK(f.space.error(f.space.moved_into_goal(*sample, 0)).distance_m < 1e-9);
        }
    }
    CHECK(found > 25);
    SpaceConfiguration in_box{};
    in_box[space::z] = 1;
    CHECK(f.space.rejection_at(in_box) == Rejection::collision);
    in_box[space::y] = 2.5;
    CHECK(f.space.rejection_at(in_box) == Rejection::bounds);
    in_box[space::y] = 1.5;
    in_box[space::first_joint] = 101 * degree;
    CHECK(f.space.rejection_at(in_box) == Rejection::arm_limits);
}

TEST_CASE("with an uncertainty samples at a goal come from its middle and, where that is not free, from farther out") {
    for (const bool is_blocked : {false, true}) {
        CAPTURE(is_blocked);
        SpaceProblem problem = box_problem();
        problem.uncertainty.emplace();
        SpaceConfigurationGoal place;
        place.x_m = 1;
        place.y_m = 1;
        place.z_m = 1.5;
        place.tolerance_m = 0.6;
        problem.goals.front().kind = place;
        if (is_blocked) {  // the multirotor has to be more than half of the tolerance away
            Obstacle ball;
            ball.name = "ball";
            ball.shape = Sphere{0.25};
            ball.center_world_m = {1, 1, 1.5};
            problem.obstacles.push_back(ball);
        }
        const SpaceProblemModel model(problem);
        const planning::SearchTaskOf<planning::Space> task(problem, model, nullptr);
        planning::Random random(3);
        int found = 0, outer = 0;
        for (int i = 0; i < 40; ++i) {
            if (const std::optional<SpaceConfiguration> at = task.space.sample_goal(random)) {
                ++found;
                CHECK(task.space.is_valid(*at));
                CHECK(task.space.is_near_goal(*at));
                outer += task.space.error(*at).used_share > 0.5 ? 1 : 0;
            }
        }
        CHECK(found >= 38);
        CHECK(outer == (is_blocked ? found : 0));
    }
}

TEST_CASE("with an uncertainty samples at a goal beside a wall keep more room than without") {
    const auto mean_clearance_m = [](bool is_uncertain) {
        SpaceProblem problem = box_problem();
        Obstacle wall;
        wall.name = "wall";
        wall.shape = Box{{4, 0.1, 3}};
        wall.center_world_m = {0, 1.15, 1.5};
        problem.obstacles.push_back(wall);
        if (is_uncertain) {
            problem.uncertainty.emplace();
        }
        SpaceEndEffectorGoal tip;
        tip.position_m = {1, 0.9, 1.5};
        tip.tolerance_m = 0.15;
        problem.goals.front().kind = tip;
        const SpaceProblemModel model(problem);
        const planning::SearchTaskOf<planning::Space> task(problem, model, nullptr);
        planning::Random random(3);
        double sum_m = 0;
        int found = 0;
        for (int i = 0; i < 200; ++i) {
            if (const std::optional<SpaceConfiguration> at = task.space.sample_goal(random)) {
                sum_m += model.collisions().clearance_m(level_at(*at));
                ++found;
            }
        }
        REQUIRE(found > 150);
        return sum_m / found;
    };
    CHECK(mean_clearance_m(true) > 1.2 * mean_clearance_m(false));
}

TEST_CASE("no way to a goal in space is estimated to cost more than it does") {
    Fixture f;
    const planning::FreeAirCostOf<planning::Space> cost(f.task);
    for (int i = 0; i < 100; ++i) {
        const SpaceConfiguration from = f.space.sample(f.random);
        if (const auto goal = f.space.sample_goal(f.random)) {
            const double hold_s = f.problem.goals.front().hold_s;
            const double way = cost.of_motion(from, *goal);
            CHECK(cost.min_cost_to_goal(from) <= (way + cost.of_hold(*goal, hold_s)) * (1 + 1e-12));
            CHECK(cost.min_cost_of_motion(from, *goal) <= way * (1 + 1e-12));
        }
    }
}

TEST_CASE(
    "a flight in space that is flown again comes out the same to the last bit, by itself and in a chain of legs") {
    Fixture f;
    planning::PlannedFlightsOf<planning::Space> flights(f.task);
    const AnySpaceState start = f.task.start;
    SpaceConfiguration there = planning::place_of(f.problem.start);
    there[space::y] = 1.2;
    there[space::yaw] = 1;
    const SpacePoint from = reference_at(f.problem.start);
    const SpaceSegment segment = flights.fastest_segment(from, at_rest(there));
    std::vector<planning::FleetJobOf<planning::Space>> jobs{flights.job({start}, 0, {{segment}})};
    flights.fly(jobs);
    REQUIRE(jobs.front().is_accepted());
    planning::FlightPointOf<planning::Space> begin = planning::start_point(f.task), end = begin;
    end.vehicle = jobs.front().end().front();
    end.reference = segment.to();
    end.ticks = segment.ticks();
    CHECK_NOTHROW(flights.verify(std::vector{begin, end}));
    end.vehicle.plant.q[0] += 1e-15;
    end.vehicle.plant.energy_j += 1;
    CHECK_THROWS(flights.verify(std::vector{begin, end}));
}
