#include <catch2/catch.hpp>
#include <map>
#include <stdexcept>

#include "../support/random.hpp"
#include "downwash/aeromap/known_factors.hpp"

using namespace downwash;

TEST_CASE("what is known of a point is evaluated once, however many points there are") {
    KnownFactors known;
    std::map<std::uint64_t, double> expected;
    test::Random random(5);
    int evaluated = 0;
    for (int i = 0; i < 20000; ++i) {
        // Columns and rows of a lattice, as maps have them, and the largest number.
        const auto column = static_cast<std::uint64_t>(random.integer(0, 99));
        const auto row = static_cast<std::uint64_t>(random.integer(0, 99));
        const std::uint64_t point = i == 777 ? ~std::uint64_t{1} : (column << 15U) * 64 + row * 64;
        const auto [at, is_new] = expected.try_emplace(point, i);
        const SidedFactor<double> k = known.find_or_add(point, [&] {
            ++evaluated;
            return SidedFactor<double>{static_cast<double>(i), -static_cast<double>(i)};
        });
        REQUIRE(k.all == at->second);
        REQUIRE(k.above == -at->second);
    }
    CHECK(evaluated == static_cast<int>(expected.size()));
    CHECK(known.size() == expected.size());
    CHECK(known.size() > 8000);
    known.clear();
    CHECK(known.size() == 0);
    CHECK(known.find_or_add(0, [] { return SidedFactor<double>{3, 2}; }).all == 3);
}

TEST_CASE("an evaluation that throws leaves its point unknown") {
    KnownFactors known;
    CHECK_THROWS_AS(known.find_or_add(4, []() -> SidedFactor<double> { throw std::runtime_error("stopped"); }),
                    std::runtime_error);
    CHECK(known.size() == 0);
    CHECK(known.find_or_add(4, [] { return SidedFactor<double>{2, 1}; }).all == 2);
}
