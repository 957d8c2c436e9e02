// What effects keep of the parts over and under discs, between one question and the next.

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <vector>

#include "scenes.hpp"

using namespace downwash;

TEST_CASE("What effects were asked before changes no digit of their answers") {
    constexpr double radius_m = 0.23;
    test::Random random(71);
    // So many boxes that those near a disc are looked for, with triangles and without.
    const std::vector<Obstacle> boxes = test::any_obstacles(random, 60, {3, 3, 2});
    std::vector<Obstacle> others = test::any_obstacles(random, 60, {3, 3, 2});
    others.push_back({"", test::some_triangles(random, 200, {3, 3, 2}, 0.6), {}, {}});
    const std::vector<std::shared_ptr<const DirectEffect>> asked = {test::effect_in(boxes, radius_m),
                                                                    test::effect_in(others, radius_m)};
    int unlike_one = 0;
    for (int way = 0; way < 12; ++way) {
        Vector3 hub_m = test::any_point(random, {3.5, 3.5, 2});
        const Vector3 step_m = test::any_point(random, {0.03, 0.03, 0.01});
        for (int i = 0; i < 60; ++i) {
            if (i == 30) {
                // On an edge between the squares that parts are kept for, or on a corner.
                hub_m[0] = radius_m * std::round(hub_m[0] / radius_m);
                hub_m[1] = way % 2 == 0 ? radius_m * std::round(hub_m[1] / radius_m) : hub_m[1];
            }
            const std::vector<double> answers = {asked[0]->factor(hub_m), asked[1]->factor(hub_m)};
            if (i % 10 == 0) {
                // Of effects that have not been asked before.
                REQUIRE(answers[0] == test::effect_in(boxes, radius_m)->factor(hub_m));
                REQUIRE(answers[1] == test::effect_in(others, radius_m)->factor(hub_m));
                unlike_one += answers[0] != 1 && answers[1] != 1 ? 1 : 0;
            }
            for (std::size_t k = 0; k < 3; ++k) {
                hub_m[k] += step_m[k];
            }
        }
    }
    CHECK(unlike_one > 30);
    // Too far away for numbers of squares.
    CHECK(asked[0]->factor({1e12, 0, 0}) == 1);
}
