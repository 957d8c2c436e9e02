#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <vector>

#include "../support/test_problem.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/search/nearest_places.hpp"

using namespace downwash;

namespace {

/// The places of a tree twice: scanned, and with an index.
struct Fixture {
    const Problem problem = test::ceiling_problem();
    const std::shared_ptr<const FlightModel> model = make_flight_model(problem);
    const planning::SearchSpace space{problem, *model};
    planning::NearestPlaces scanned{space, 1'000'000};
    planning::NearestPlaces indexed{space, 100};
};

}  // namespace

TEST_CASE("scanned and indexed places are the same in the same order, those at the same distance by age") {
    Fixture f;
    planning::Random random(5);
    std::vector<Configuration> places;
    for (int i = 0; i < 3000; ++i) {
        // Every third is where another one is already, or a turn of the arm from it.
        Configuration place = f.space.sample(random);
        if (i % 3 == 2) {
            place = places[static_cast<std::size_t>(random.uniform(0, static_cast<double>(places.size())))];
        }
        place[plane::arm] += 6.283185307179586 * std::floor(random.uniform(-2, 3));
        places.push_back(place);
        f.scanned.add(place);
        f.indexed.add(place);
    }
    for (int i = 0; i < 3000; ++i) {
        const Configuration to = i % 2 == 0 ? f.space.sample(random) : places[static_cast<std::size_t>(i)];
        for (const std::size_t count : {1U, 2U, 33U}) {
            const std::vector<std::size_t> nearest = f.scanned.nearest(to, count);
            REQUIRE(nearest.size() == count);
            CHECK(f.indexed.nearest(to, count) == nearest);
        }
    }
    CHECK(f.scanned.nearest(places[0], 5000).size() == 3000);
    CHECK(f.indexed.nearest(places[0], 5000).size() == 3000);
    CHECK(f.indexed.nearest(places[0], 0).empty());
}

TEST_CASE("very many nodes at one place, as at a goal, are found like others") {
    Fixture f;
    planning::Random random(6);
    const Configuration crowded = f.space.sample(random);
    for (int i = 0; i < 3000; ++i) {
        const Configuration place = i % 2 == 0 ? crowded : f.space.sample(random);
        f.scanned.add(place);
        f.indexed.add(place);
    }
    for (int i = 0; i < 50; ++i) {
        const Configuration to = i == 0 ? crowded : f.space.sample(random);
        CHECK(f.indexed.nearest(to, 33) == f.scanned.nearest(to, 33));
    }
}
