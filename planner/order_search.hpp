#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "downwash/base/export.hpp"

namespace downwash::planning {

/// What the way from one place to another costs, the hold there included.
struct LegCost {
    double cost = std::numeric_limits<double>::infinity();  ///< infinite: there is no way
    double energy_j = 0;
};

/// Places to be visited in any order, of each target one place at most, and the costs between them.
class DOWNWASH_EXPORT LegCosts {
 public:
    /// @param target_of the target of each place, from 0
    explicit LegCosts(std::vector<std::size_t> target_of);

    [[nodiscard]] std::size_t places() const noexcept { return target_of_.size(); }
    [[nodiscard]] std::size_t targets() const noexcept { return targets_; }
    [[nodiscard]] std::size_t target_of(std::size_t place) const { return target_of_[place]; }
    /// As the first end of a leg the start, as the second one the place to return to, or wherever the flight may end.
    [[nodiscard]] std::size_t outside() const noexcept { return places(); }
    [[nodiscard]] LegCost& leg(std::size_t from, std::size_t to) { return legs_[from * (places() + 1) + to]; }
    [[nodiscard]] const LegCost& leg(std::size_t from, std::size_t to) const {
        return legs_[from * (places() + 1) + to];
    }

    double energy_budget_j = std::numeric_limits<double>::infinity();  ///< energy that all legs together may take

 private:
    std::vector<std::size_t> target_of_;
    std::size_t targets_ = 0;
    std::vector<LegCost> legs_;
};

/// Places in the order of their visits.
struct PlaceOrder {
    std::vector<std::size_t> places;
    double cost = std::numeric_limits<double>::infinity();  ///< infinite: there is no such order, not even an empty one
    double energy_j = 0;
    bool is_best = false;  ///< proven: no order visits more targets, or as many for less
};

/// What an order costs; infinite where a leg does not exist or the energy is not enough.
[[nodiscard]] DOWNWASH_EXPORT PlaceOrder order_of(const LegCosts& costs, std::vector<std::size_t> places);

/// Whether an order visits more targets than another, or as many for less.
[[nodiscard]] DOWNWASH_EXPORT bool is_better(const PlaceOrder& a, const PlaceOrder& b);

/// The order that visits most targets within the budget and of those the cheapest. Up to about 12 places it is the best
/// one: dynamic programming over the sets of targets (Bellman 1962; Held and Karp 1962), of each set and last place all
/// (cost, energy) of which no other is better in both. Beyond, a local search: insertion, exchange, and moves and
/// reversals of sections (Or-opt and 2-opt), from the given order and from nearest_first(), then from random changes of
/// the best so far. The same numbers give the same order.
/// @param hint to begin with; may be empty
[[nodiscard]] DOWNWASH_EXPORT PlaceOrder best_order(const LegCosts& costs, const std::vector<std::size_t>& hint = {});

/// What a flight to some places takes with a target more, in the order that takes least [J]; infinite where there is no
/// leg to it.
[[nodiscard]] DOWNWASH_EXPORT double energy_with(const LegCosts& costs, const std::vector<std::size_t>& visited,
                                                 std::size_t target);

/// Each time to the cheapest place that is left, as long as the energy is enough, return included.
[[nodiscard]] DOWNWASH_EXPORT PlaceOrder nearest_first(const LegCosts& costs);

}  // namespace downwash::planning
