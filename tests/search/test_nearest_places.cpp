#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "../support/test_problem.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/search/nearest_places.hpp"

using namespace downwash;

TEST_CASE("scanned and indexed places are the same in the same order, those at the same distance by age") {
    const Problem problem = test::ceiling_problem();
    const auto model = make_flight_model(problem);
    const planning::SearchSpace space(problem, *model);
    planning::Random random(5);
    planning::NearestPlaces scanned(space, 1'000'000);
    planning::NearestPlaces indexed(space, 100);
    std::vector<Configuration> places;
    for (int i = 0; i < 3000; ++i) {
        // Every third is where another one is already, or a turn of the arm from it.
        Configuration place = space.sample(random);
        if (i % 3 == 2) {
            place = places[static_cast<std::size_t>(random.uniform(0, static_cast<double>(places.size())))];
        }
        place[plane::arm] += 6.283185307179586 * std::floor(random.uniform(-2, 3));
        places.push_back(place);
        scanned.add(place);
        indexed.add(place);
    }
    for (int i = 0; i < 3000; ++i) {
        const Configuration to = i % 2 == 0 ? space.sample(random) : places[static_cast<std::size_t>(i)];
        for (const std::size_t count : {1U, 2U, 33U}) {
            const std::vector<std::size_t> nearest = scanned.nearest(to, count);
            REQUIRE(nearest.size() == count);
            CHECK(indexed.nearest(to, count) == nearest);
        }
    }
    CHECK(scanned.nearest(places[0], 5000).size() == 3000);
    CHECK(indexed.nearest(places[0], 5000).size() == 3000);
    CHECK(indexed.nearest(places[0], 0).empty());
}

TEST_CASE("very many nodes at one place, as at a goal, are found like others") {
    const Problem problem = test::ceiling_problem();
    const auto model = make_flight_model(problem);
    const planning::SearchSpace space(problem, *model);
    planning::Random random(6);
    planning::NearestPlaces scanned(space, 1'000'000);
    planning::NearestPlaces indexed(space, 100);
    const Configuration crowded = space.sample(random);
    for (int i = 0; i < 3000; ++i) {
        const Configuration place = i % 2 == 0 ? crowded : space.sample(random);
        scanned.add(place);
        indexed.add(place);
    }
    for (int i = 0; i < 50; ++i) {
        const Configuration to = i == 0 ? crowded : space.sample(random);
        CHECK(indexed.nearest(to, 33) == scanned.nearest(to, 33));
    }
}
