#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "../support/space_robots.hpp"
#include "downwash/search/search_task.hpp"
#include "downwash/search/ways_around.hpp"

using namespace downwash;
using Corners = planning::WaysAround::Corners;

namespace {

/// A wall in the plane x = 0 from y = -1 to the end of the bounds, from below to above them.
SpaceProblem walled_problem() {
    SpaceProblem problem;
    problem.robot = test::space_robot(2);
    problem.robot.body.push_back({Box{{0.3, 0.3, 0.1}}});
    problem.bounds = {{-2, -3, 0.5}, {2, 2, 3}};
    Obstacle wall;
    wall.name = "wall";
    wall.shape = Box{{0.1, 4, 4}};
    wall.center_world_m = {0, 1, 1.75};
    problem.obstacles.push_back(wall);
    problem.start.position_m = {-1, 1, 1.5};
    SpaceConfigurationGoal at;
    at.x_m = 1;
    problem.goals.push_back({at, 1, {}});
    problem.aero.enabled = false;
    return problem;
}

struct Fixture {
    explicit Fixture(const SpaceProblem& the_problem) : problem(the_problem) {}

    /// The corners of the way from one place to another.
    [[nodiscard]] std::optional<Corners> way(const Vector3& from_m, const Vector3& to_m, double room_m = 0) const {
        const std::vector<Vector3> places_m{from_m, to_m};
        planning::WaysAround ways(task.space, planning::place_of(problem.start), room_m, places_m);
        const std::vector<std::vector<Vector3>> ends_m{{to_m}};
        return ways.from(std::vector{from_m}, ends_m).front();
    }

    SpaceProblem problem;
    std::shared_ptr<const SpaceProblemModel> model = std::make_shared<const SpaceProblemModel>(problem);
    planning::SearchTaskOf<planning::Space> task{problem, *model, nullptr};
};

double length_m(const Vector3& from_m, const Corners& corners_m, const Vector3& to_m) {
    double sum_m = 0;
    Vector3 at_m = from_m;
    const auto go = [&](const Vector3& next_m) {
        const Vector3 step_m = next_m - at_m;
        sum_m += std::sqrt(dot(step_m, step_m));
        at_m = next_m;
    };
    std::ranges::for_each(corners_m, go);
    go(to_m);
    return sum_m;
}

}  // namespace

TEST_CASE("a way around a wall leads past its end and is hardly longer than it has to be") {
    const Fixture f(walled_problem());
    const Vector3 from_m{-1, 1, 1.5}, to_m{1, 1, 1.5};
    const std::optional<Corners> corners_m = f.way(from_m, to_m);
    REQUIRE(corners_m);
    REQUIRE_FALSE(corners_m->empty());
    for (const Vector3& corner_m : *corners_m) {
        SpaceConfiguration at{};
        std::ranges::copy(corner_m, at.begin());
        CHECK(f.task.space.is_valid(at));
        CHECK(corner_m[1] < -1);
    }
    // The vehicle's centre cannot come nearer to the end of the wall than half its width and the margin.
    const double shortest_m = 2 * std::hypot(1, 2.2);
    CHECK(length_m(from_m, *corners_m, to_m) > shortest_m);
    CHECK(length_m(from_m, *corners_m, to_m) < 1.15 * shortest_m);
    // It is the same the other way.
    const std::optional<Corners> back_m = f.way(to_m, from_m);
    REQUIRE(back_m);
    CHECK(length_m(to_m, *back_m, from_m) == Approx(length_m(from_m, *corners_m, to_m)));
}

TEST_CASE("a way on which nothing stands has no corners") {
    const Fixture f(walled_problem());
    const std::optional<Corners> corners_m = f.way({-1, 1, 1.5}, {-1.5, -2, 2.5});
    REQUIRE(corners_m);
    CHECK(corners_m->empty());
}

TEST_CASE("ways around obstacles keep room where there is some") {
    const Fixture f(walled_problem());
    const auto from_end_m = [&](double room_m) {
        const std::optional<Corners> corners_m = f.way({-1, 1, 1.5}, {1, 1, 1.5}, room_m);
        REQUIRE(corners_m);
        double nearest_m = 1e9;
        for (const Vector3& corner_m : *corners_m) {
            nearest_m = std::min(nearest_m, std::hypot(corner_m[0], corner_m[1] + 1));
        }
        return nearest_m;
    };
    CHECK(from_end_m(0.6) > from_end_m(0) + 0.25);
    CHECK(from_end_m(0.6) > 0.6);
    // Where there is none, the way leads through all the same: here the bounds leave 0.7 m.
    SpaceProblem narrow = walled_problem();
    narrow.bounds.low_m[1] = -1.7;
    CHECK(Fixture(narrow).way({-1, 1, 1.5}, {1, 1, 1.5}, 2).has_value());
}

TEST_CASE("there is no way through a wall that leaves nothing open") {
    SpaceProblem closed = walled_problem();
    closed.bounds.low_m[1] = -1.1;  // the vehicle's centre may get there, its body does not pass
    const Fixture f(closed);
    CHECK_FALSE(f.way({-1, 1, 1.5}, {1, 1, 1.5}).has_value());
    CHECK(f.way({-1, 1, 1.5}, {-1, 0, 1.5}).has_value());
}

TEST_CASE("the nearest of several places counts, at both ends") {
    const Fixture f(walled_problem());
    const std::vector<Vector3> begins_m{{-1, 1.5, 1.5}, {-1, -2, 1.5}};
    const std::vector<std::vector<Vector3>> ends_m{{{1, -2, 1.5}, {1, 1.5, 1.5}}, {{-1.5, 1.5, 1.5}}};
    std::vector<Vector3> all_m = begins_m;
    for (const std::vector<Vector3>& some_m : ends_m) {
        all_m.insert(all_m.end(), some_m.begin(), some_m.end());
    }
    planning::WaysAround ways(f.task.space, planning::place_of(f.problem.start), 0, all_m);
    const auto corners_m = ways.from(begins_m, ends_m);
    REQUIRE(corners_m.size() == 2);
    REQUIRE(corners_m[0]);
    CHECK(corners_m[0]->empty());  // from the second to the first, past the end of the wall
    REQUIRE(corners_m[1]);
    CHECK(corners_m[1]->empty());
}
