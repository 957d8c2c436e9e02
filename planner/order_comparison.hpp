#pragma once

#include "downwash/base/export.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/planner/leg_table.hpp"

namespace downwash::planning {

/// Compares orders of targets by simulated legs, and simulates only legs that may belong to the best order.
template <class Family>
class DOWNWASH_EXPORT OrderComparisonOf {
 public:
    using LegTable = LegTableOf<Family>;

    /// @param is_stopped asked between legs   @pre table outlives it
    OrderComparisonOf(LegTable& table, StopCondition is_stopped)
        : energy_limit_j(table.estimates().energy_budget_j), table_(table), is_stopped_(std::move(is_stopped)) {}

    /// First simulates the legs of nearest_first(), so that no costlier order is chosen. Then it simulates those of the
    /// order that is best by simulated legs and lower bounds, until all legs of the best order are simulated. While the
    /// budget lasts it repeats this with twice the budget per leg; the cheapest flight of each leg counts.
    /// @return the work of all searches
    [[nodiscard]] SearchRecord compare(const SearchBudget& budget);

    /// The best order by the cheapest simulations of legs; where there is none of these alone, in the plane always,
    /// with estimates of the others.
    [[nodiscard]] PlaceOrder chosen() const;

    /// The best order by the simulations of this pass and, for the other legs, estimates.
    [[nodiscard]] PlaceOrder likely() const { return best_order(limited(table_.estimates())); }

    double energy_limit_j;  ///< for all legs of an order; callers adjust it, as legs only approximate a flight

 private:
    /// The costs with energy_limit_j as their budget.
    [[nodiscard]] LegCosts limited(LegCosts costs) const {
        costs.energy_budget_j = energy_limit_j;
        return costs;
    }
    /// What a comparison has left, and what it did.
    struct Work {
        SearchBudget left;
        SearchRecord done;
    };
    [[nodiscard]] bool is_over(const Work& work) const { return is_stopped_() || work.left.is_used_up(); }
    [[nodiscard]] bool converges(const SearchBudget& slice, Work& work);
    [[nodiscard]] bool fly_missing_legs(const PlaceOrder& order, const SearchBudget& slice, Work& work);

    LegTable& table_;
    StopCondition is_stopped_;
};

/// Whether an order was found and visits at least one place.
[[nodiscard]] DOWNWASH_EXPORT bool is_order(const PlaceOrder& order);

}  // namespace downwash::planning
