#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "downwash/planner/order_search.hpp"
#include "downwash/search/random.hpp"

using namespace downwash::planning;

namespace {

/// Costs that no plane has: legs are as long one way as they are not the other.
LegCosts random_costs(std::uint64_t seed, std::vector<std::size_t> target_of, bool costs_are_energies = true) {
    Random random(seed);
    LegCosts costs(std::move(target_of));
    for (std::size_t from = 0; from <= costs.outside(); ++from) {
        for (std::size_t to = 0; to <= costs.outside(); ++to) {
            const double cost = random.uniform(1, 10);
            costs.leg(from, to) = {cost, costs_are_energies ? cost : random.uniform(1, 10)};
        }
    }
    return costs;
}

std::vector<std::size_t> one_place_each(std::size_t targets) {
    std::vector<std::size_t> targets_of(targets);
    std::iota(targets_of.begin(), targets_of.end(), 0);
    return targets_of;
}

/// All orders of all choices of places, one after the other.
PlaceOrder best_by_trying(const LegCosts& costs, const std::vector<std::size_t>& places = {}) {
    PlaceOrder best = order_of(costs, places);
    for (std::size_t next = 0; next < costs.places(); ++next) {
        const auto is_same_target = [&](std::size_t place) { return costs.target_of(place) == costs.target_of(next); };
        if (std::ranges::any_of(places, is_same_target)) {
            continue;
        }
        std::vector<std::size_t> longer = places;
        longer.push_back(next);
        PlaceOrder other = best_by_trying(costs, longer);
        if (is_better(other, best)) {
            best = std::move(other);
        }
    }
    return best;
}

}  // namespace

TEST_CASE("the best order is the best of all orders") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        CAPTURE(seed);
        LegCosts costs = random_costs(seed, one_place_each(6));
        const PlaceOrder best = best_order(costs);
        CHECK(best.is_best);
        CHECK(best.places.size() == 6);
        CHECK(best.cost == Approx(best_by_trying(costs).cost));
        CHECK(best.cost <= nearest_first(costs).cost);
    }
}

TEST_CASE("of a target with several places the cheapest one is visited") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        CAPTURE(seed);
        const LegCosts costs = random_costs(seed, {0, 0, 1, 2, 2, 3});
        const PlaceOrder best = best_order(costs);
        CHECK(best.places.size() == 4);
        CHECK(best.cost == Approx(best_by_trying(costs).cost));
    }
}

TEST_CASE("under a budget the best order visits most targets, and of these orders it is the cheapest") {
    bool has_left_out = false;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        CAPTURE(seed);
        const bool costs_are_energies = seed % 2 == 0;
        LegCosts costs = random_costs(seed, one_place_each(5), costs_are_energies);
        costs.energy_budget_j = 14;
        const PlaceOrder best = best_order(costs);
        const PlaceOrder tried = best_by_trying(costs);
        CHECK(best.places.size() == tried.places.size());
        CHECK(best.cost == Approx(tried.cost));
        CHECK(best.energy_j <= 14);
        has_left_out = has_left_out || best.places.size() < 5;
        const PlaceOrder nearest = nearest_first(costs);
        CHECK_FALSE(is_better(nearest, best));
        CHECK(nearest.energy_j <= 14);
    }
    CHECK(has_left_out);
}

TEST_CASE("a place without a way to it is not visited") {
    LegCosts costs = random_costs(1, one_place_each(4));
    for (std::size_t from = 0; from <= costs.outside(); ++from) {
        costs.leg(from, 2) = {};
    }
    const PlaceOrder best = best_order(costs);
    CHECK(best.places.size() == 3);
    CHECK(std::ranges::find(best.places, 2U) == best.places.end());
    for (std::size_t from = 0; from <= costs.outside(); ++from) {
        costs.leg(from, costs.outside()) = {};
    }
    CHECK(std::isinf(best_order(costs).cost));
}

TEST_CASE("of twenty targets the local search finds an order near the best, the same each time") {
    // On a circle, the start on it too: the best order goes around, and back to the start.
    constexpr std::size_t count = 20;
    LegCosts costs(one_place_each(count));
    const auto at = [](std::size_t place) {
        return 2 * M_PI * static_cast<double>(place * 8 % (count + 1)) / (count + 1);
    };
    for (std::size_t from = 0; from <= count; ++from) {
        for (std::size_t to = 0; to <= count; ++to) {
            const double length = 2 * std::abs(std::sin((at(from) - at(to)) / 2));
            costs.leg(from, to) = {length, length};
        }
    }
    const PlaceOrder around = best_order(costs);
    CHECK(around.places.size() == count);
    CHECK(around.cost == Approx((count + 1) * 2 * std::sin(M_PI / (count + 1))));
    CHECK_FALSE(around.is_best);

    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        CAPTURE(seed);
        LegCosts random = random_costs(seed, one_place_each(count));
        const PlaceOrder best = best_order(random);
        CHECK(best.cost <= nearest_first(random).cost);
        CHECK(best.places == best_order(random).places);
        random.energy_budget_j = best.energy_j / 2;
        const PlaceOrder half = best_order(random);
        CHECK(half.energy_j <= random.energy_budget_j);
        CHECK(half.places.size() < count);
        CHECK_FALSE(is_better(nearest_first(random), half));
    }
}

TEST_CASE("a local search that begins with the best order of twelve targets keeps it") {
    const LegCosts small = random_costs(3, one_place_each(12));
    const PlaceOrder exact = best_order(small);
    REQUIRE(exact.is_best);
    // The same targets with a second place each that is worse: too many for the exact search.
    std::vector<std::size_t> target_of = one_place_each(12);
    for (std::size_t target = 0; target < 12; ++target) {
        target_of.push_back(target);
    }
    LegCosts large(target_of);
    for (std::size_t from = 0; from <= large.outside(); ++from) {
        for (std::size_t to = 0; to <= large.outside(); ++to) {
            const std::size_t a = from == large.outside() ? 12 : from % 12;
            const std::size_t b = to == large.outside() ? 12 : to % 12;
            const double extra = (to != large.outside() && to >= 12) ? 20 : 0;
            large.leg(from, to) = {small.leg(a, b).cost + extra, 0};
        }
    }
    const PlaceOrder kept = best_order(large, exact.places);
    CHECK_FALSE(kept.is_best);
    CHECK(kept.cost == Approx(exact.cost));
}
