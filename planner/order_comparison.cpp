#include "downwash/planner/order_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "downwash/planner/stopwatch.hpp"

namespace downwash::planning {

bool is_order(const PlaceOrder& order) {
    return std::isfinite(order.cost) && !order.places.empty();
}

template <class Family>
SearchRecord OrderComparisonOf<Family>::compare(const SearchBudget& budget) {
    const auto targets = static_cast<double>(table_.estimates().targets());
    const double legs = std::min(targets * (targets + 1), 6 * (targets + 1));
    constexpr double least_s = 0.1;  // of less nobody learns whether there is a way
    SearchBudget slice = budget.part(1 / legs).at_least_s(least_s);
    Work work{budget, {}};
    for (;;) {
        const SearchBudget before = work.left;
        if (!converges(slice, work)) {
            return work.done;
        }
        // The next pass takes about twice as much.
        constexpr double most = 0.33;
        const double share = before.share_between(work.left);
        if (share > most || share <= 0) {
            return work.done;
        }
        slice = slice.part(2);
        table_.begin_pass();
    }
}

/// Flies the legs of one order after the other, until one consists of flown legs that is the best.
/// @return false if the budget was used up before
template <class Family>
bool OrderComparisonOf<Family>::converges(const SearchBudget& slice, Work& work) {
    bool is_nearest_first = true;
    std::vector<std::size_t> hint;
    while (!is_over(work)) {
        const PlaceOrder order =
            is_nearest_first ? nearest_first(limited(table_.at_least())) : best_order(limited(table_.at_least()), hint);
        const bool is_flown = !is_order(order) || !fly_missing_legs(order, slice, work);
        if (is_flown && !std::exchange(is_nearest_first, false)) {
            return true;
        }
        hint = order.places;
    }
    return false;
}

/// Flies the legs of an order that are not flown yet. One to which no flight is found ends it: another order may be
/// better then. @return false if none was missing
template <class Family>
bool OrderComparisonOf<Family>::fly_missing_legs(const PlaceOrder& order, const SearchBudget& slice, Work& work) {
    bool was_missing = false;
    std::size_t from = table_.estimates().outside();
    std::vector<std::size_t> stations = order.places;
    stations.push_back(from);
    for (const std::size_t to : stations) {
        if (is_over(work)) {
            break;
        }
        if (!table_.is_known(from, to)) {
            was_missing = true;
            const Stopwatch clock;
            SearchRecord spent = table_.fly(from, to, slice.at_most(work.left), work.left.time_s());
            add_work(work.done, spent);
            spent.wall_s = clock.seconds();
            work.left.spend(spent);
            if (!table_.is_known(from, to)) {
                break;
            }
        }
        from = to;
    }
    return was_missing;
}

template <class Family>
PlaceOrder OrderComparisonOf<Family>::chosen() const {
    // What ways around obstacles take from corner to corner is more than what flights take: estimates in space are not
    // weighed against flights. Lower bounds in the plane are.
    constexpr bool weighs_estimates = std::is_same_v<Family, Plane>;
    PlaceOrder chosen = best_order(limited(weighs_estimates ? table_.likely_costs() : table_.flown_costs()));
    if (PlaceOrder other = best_order(limited(table_.likely_costs()), chosen.places);
        !is_order(chosen) || other.places.size() > chosen.places.size()) {
        chosen = std::move(other);
    }
    // What is expected of legs proves nothing.
    const PlaceOrder least = best_order(limited(table_.lower_bounds()), chosen.places);
    chosen.is_best = least.is_best && is_order(chosen) && chosen.cost <= least.cost * (1 + 1e-9);
    return chosen;
}

template class OrderComparisonOf<Plane>;
template class OrderComparisonOf<Space>;

}  // namespace downwash::planning
