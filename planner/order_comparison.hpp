#pragma once

#include "downwash/base/export.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/planner/leg_table.hpp"

namespace downwash::planning {

/// Compares orders of targets by flown legs, of which it flies only those that may belong to the best order.
class DOWNWASH_EXPORT OrderComparison {
 public:
    /// @param is_stopped asked between legs   @pre table outlives it
    OrderComparison(LegTable& table, StopCondition is_stopped)
        : energy_limit_j(table.estimates().energy_budget_j), table_(table), is_stopped_(std::move(is_stopped)) {}

    /// Flies the legs of nearest_first() by flown costs, so that no order is chosen that costs more; then those of the
    /// order that is the best by what is known, again and again, until it consists of flown legs. As long as the budget
    /// allows it does so anew, each time with twice as much for a leg, of which the cheapest flight counts.
    /// @return the work of all searches
    [[nodiscard]] SearchRecord compare(const SearchBudget& budget);

    /// The best order of flown legs or, where others may visit more, of those.
    [[nodiscard]] PlaceOrder chosen() const;

    /// The best order by lower bounds and the legs that were flown.
    [[nodiscard]] PlaceOrder likely() const { return best_order(limited(table_.estimates())); }

    double energy_limit_j;  ///< budget for the legs of an order together: what they say of a whole flight is not exact

 private:
    /// With the limit of energy.
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

/// Whether an order exists and visits a place.
[[nodiscard]] DOWNWASH_EXPORT bool is_order(const PlaceOrder& order);

}  // namespace downwash::planning
