#include "downwash/planner/order_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "downwash/search/random.hpp"

namespace downwash::planning {
namespace {

/// A way from the start through a set of places to the last of them.
struct Label {
    double cost, energy_j;
    std::size_t place;
    std::size_t before;  ///< label of the way to the place before
    std::size_t count;   ///< number of places
};

constexpr std::size_t no_label = static_cast<std::size_t>(-1);

/// Whether dynamic programming takes milliseconds.
bool is_small(const LegCosts& costs) {
    constexpr double most_steps = 1e6;
    const auto places = static_cast<double>(costs.places());
    return std::ldexp(places * places, static_cast<int>(std::min<std::size_t>(costs.targets(), 63))) <= most_steps;
}

/// Dynamic programming over the sets of targets.
class ExactSearch {
 public:
    explicit ExactSearch(const LegCosts& costs)
        : costs_(costs), states_((std::size_t{1} << costs.targets()) * costs.places()) {}

    PlaceOrder run() {
        for (std::size_t place = 0; place < costs_.places(); ++place) {
            extend(0, costs_.outside(), {0, 0, 0, no_label, 0}, no_label, place);
        }
        const std::size_t sets = std::size_t{1} << costs_.targets();
        for (std::size_t set = 1; set < sets; ++set) {
            for (std::size_t last = 0; last < costs_.places(); ++last) {
                // What is appended to other states leaves this one as it is.
                for (const std::size_t label : states_[state(set, last)]) {
                    for (std::size_t next = 0; next < costs_.places(); ++next) {
                        extend(set, last, labels_[label], label, next);
                    }
                }
            }
        }
        return best();
    }

 private:
    [[nodiscard]] std::size_t state(std::size_t set, std::size_t last) const { return set * costs_.places() + last; }

    void extend(std::size_t set, std::size_t last, const Label& way, std::size_t label, std::size_t next) {
        const std::size_t bit = std::size_t{1} << costs_.target_of(next);
        const LegCost& leg = costs_.leg(last, next);
        const bool is_limited = std::isfinite(costs_.energy_budget_j);
        const Label longer{way.cost + leg.cost, is_limited ? way.energy_j + leg.energy_j : 0, next, label,
                           way.count + 1};
        if ((set & bit) != 0 || !std::isfinite(longer.cost) || longer.energy_j > costs_.energy_budget_j) {
            return;
        }
        std::vector<std::size_t>& known = states_[state(set | bit, next)];
        for (const std::size_t other : known) {
            if (labels_[other].cost <= longer.cost && labels_[other].energy_j <= longer.energy_j) {
                return;
            }
        }
        std::erase_if(known, [&](std::size_t other) {
            return labels_[other].cost >= longer.cost && labels_[other].energy_j >= longer.energy_j;
        });
        known.push_back(labels_.size());
        labels_.push_back(longer);
    }

    [[nodiscard]] PlaceOrder best() const {
        PlaceOrder best = order_of(costs_, {});
        for (std::size_t i = 0; i < labels_.size(); ++i) {
            const std::size_t count = labels_[i].count;
            const double cost = labels_[i].cost + costs_.leg(labels_[i].place, costs_.outside()).cost;
            if (count < best.places.size() || (count == best.places.size() && cost >= best.cost)) {
                continue;
            }
            std::vector<std::size_t> places;
            for (std::size_t at = i; at != no_label; at = labels_[at].before) {
                places.push_back(labels_[at].place);
            }
            std::reverse(places.begin(), places.end());
            PlaceOrder order = order_of(costs_, std::move(places));
            if (is_better(order, best)) {
                best = std::move(order);
            }
        }
        best.is_best = true;
        return best;
    }

    const LegCosts& costs_;
    std::vector<Label> labels_;
    std::vector<std::vector<std::size_t>> states_;  ///< labels of each set and last place
};

/// What moves of sections of an order do to its cost, in constant time each.
class SectionMoves {
 public:
    SectionMoves(const LegCosts& costs, const std::vector<std::size_t>& places)
        : costs_(costs),
          at_(places),
          forwards_(places.size() + 2),
          backwards_(places.size() + 2),
          closed_(places.size() + 2) {
        at_.insert(at_.begin(), costs.outside());
        at_.push_back(costs.outside());
        for (std::size_t i = 1; i < at_.size(); ++i) {
            forwards_[i] = forwards_[i - 1] + leg(i - 1, i);
            const double back = i > 1 && i < places.size() + 1 ? leg(i, i - 1) : 0;
            backwards_[i] = backwards_[i - 1] + (std::isfinite(back) ? back : 0);
            closed_[i] = closed_[i - 1] + (std::isfinite(back) ? 0 : 1);
        }
    }

    /// Whether an order in which a section stands elsewhere, or the other way round, is cheaper or, by rounding, may
    /// be. @param from,length of the section among the places   @param to where it begins among them then
    [[nodiscard]] bool may_help(std::size_t from, std::size_t length, std::size_t to, bool is_reversed) const {
        if (!std::isfinite(forwards_.back())) {
            return true;  // of an infinite order nothing is known
        }
        const std::size_t first = from + 1, last = from + length;
        if (is_reversed && closed_[last] > closed_[first]) {
            return false;
        }
        const std::size_t before = to <= from ? to : to + length;
        const std::size_t after = to < from ? to + 1 : to + length + 1;
        const double inner = forwards_[last] - forwards_[first];
        double gained = leg(first - 1, first) + inner + leg(last, last + 1);
        double paid = leg(before, is_reversed ? last : first) +
                      (is_reversed ? backwards_[last] - backwards_[first] : inner) +
                      leg(is_reversed ? first : last, after);
        if (to != from) {
            gained += leg(before, after);
            paid += leg(first - 1, last + 1);
        }
        constexpr double rounding = 1e-9;
        return paid - gained <= rounding * forwards_.back();
    }

 private:
    [[nodiscard]] double leg(std::size_t from, std::size_t to) const { return costs_.leg(at_[from], at_[to]).cost; }

    const LegCosts& costs_;
    std::vector<std::size_t> at_;               ///< the start, the places, the end
    std::vector<double> forwards_, backwards_;  ///< sums of the legs up to each of them; backwards of those that exist
    std::vector<int> closed_;                   ///< how many legs backwards do not
};

/// Improves an order by small changes until none helps.
class LocalSearch {
 public:
    explicit LocalSearch(const LegCosts& costs) : costs_(costs) {}

    PlaceOrder run(PlaceOrder order) const {
        while (improve(order)) {
        }
        return order;
    }

    /// Turns a random section around and moves it elsewhere.
    PlaceOrder shaken(const PlaceOrder& order, Random& random) const {
        std::vector<std::size_t> places = order.places;
        const auto below = [&](std::size_t end) {
            return static_cast<std::size_t>(random.uniform(0, static_cast<double>(end)));
        };
        for (int i = 0; i < 2 && places.size() > 3; ++i) {
            const std::size_t from = below(places.size() - 1);
            const std::size_t length = 1 + below(std::min<std::size_t>(places.size() - from, 4));
            places = moved(places, from, length, below(places.size() - length + 1), random.chance(0.5));
        }
        return order_of(costs_, std::move(places));
    }

 private:
    static std::vector<std::size_t> moved(std::vector<std::size_t> places, std::size_t from, std::size_t length,
                                          std::size_t to, bool is_reversed) {
        const auto begin = places.begin() + static_cast<std::ptrdiff_t>(from);
        std::vector<std::size_t> section(begin, begin + static_cast<std::ptrdiff_t>(length));
        places.erase(begin, begin + static_cast<std::ptrdiff_t>(length));
        if (is_reversed) {
            std::reverse(section.begin(), section.end());
        }
        places.insert(places.begin() + static_cast<std::ptrdiff_t>(to), section.begin(), section.end());
        return places;
    }

    bool keep_if_better(PlaceOrder& order, std::vector<std::size_t> places) const {
        PlaceOrder changed = order_of(costs_, std::move(places));
        if (!is_better(changed, order)) {
            return false;
        }
        order = std::move(changed);
        return true;
    }

    bool improve(PlaceOrder& order) const { return insert(order) || exchange(order) || move_sections(order); }

    [[nodiscard]] std::vector<bool> visited(const PlaceOrder& order) const {
        std::vector<bool> is_visited(costs_.targets());
        for (const std::size_t place : order.places) {
            is_visited[costs_.target_of(place)] = true;
        }
        return is_visited;
    }

    /// The cheapest visit more.
    bool insert(PlaceOrder& order) const {
        const std::vector<bool> is_visited = visited(order);
        PlaceOrder best = order;
        for (std::size_t place = 0; place < costs_.places(); ++place) {
            for (std::size_t at = 0; at <= order.places.size() && !is_visited[costs_.target_of(place)]; ++at) {
                std::vector<std::size_t> places = order.places;
                places.insert(places.begin() + static_cast<std::ptrdiff_t>(at), place);
                keep_if_better(best, std::move(places));
            }
        }
        const bool is_longer = best.places.size() > order.places.size();
        order = std::move(best);
        return is_longer;
    }

    /// Another place of a target, or another target, instead of one that is visited.
    bool exchange(PlaceOrder& order) const {
        const std::vector<bool> is_visited = visited(order);
        for (std::size_t at = 0; at < order.places.size(); ++at) {
            std::vector<std::size_t> others = order.places;
            others.erase(others.begin() + static_cast<std::ptrdiff_t>(at));
            for (std::size_t place = 0; place < costs_.places(); ++place) {
                const bool is_free = costs_.target_of(place) == costs_.target_of(order.places[at]) ||
                                     !is_visited[costs_.target_of(place)];
                for (std::size_t to = 0; to <= others.size() && is_free && place != order.places[at]; ++to) {
                    std::vector<std::size_t> places = others;
                    places.insert(places.begin() + static_cast<std::ptrdiff_t>(to), place);
                    if (keep_if_better(order, std::move(places))) {
                        return true;
                    }
                }
            }
        }
        return false;
    }

    /// 2-opt is a section that is turned where it stands.
    bool move_sections(PlaceOrder& order) const {
        constexpr std::size_t longest_moved = 3;
        const SectionMoves moves(costs_, order.places);
        const std::size_t count = order.places.size();
        for (std::size_t length = 1; length <= count; ++length) {
            for (std::size_t from = 0; from + length <= count; ++from) {
                const std::size_t first = length > longest_moved ? from : 0;
                const std::size_t last = length > longest_moved ? from : count - length;
                for (std::size_t to = first; to <= last; ++to) {
                    for (const bool is_reversed : {false, true}) {
                        if (moves.may_help(from, length, to, is_reversed) &&
                            keep_if_better(order, moved(order.places, from, length, to, is_reversed))) {
                            return true;
                        }
                    }
                }
            }
        }
        return false;
    }

    const LegCosts& costs_;
};

}  // namespace

LegCosts::LegCosts(std::vector<std::size_t> target_of)
    : target_of_(std::move(target_of)), legs_((target_of_.size() + 1) * (target_of_.size() + 1)) {
    for (const std::size_t target : target_of_) {
        targets_ = std::max(targets_, target + 1);
    }
}

PlaceOrder order_of(const LegCosts& costs, std::vector<std::size_t> places) {
    PlaceOrder order;
    order.cost = 0;
    std::size_t at = costs.outside();
    const auto go = [&](std::size_t to) {
        const LegCost& leg = costs.leg(std::exchange(at, to), to);
        order.cost += leg.cost;
        order.energy_j += leg.energy_j;
    };
    for (const std::size_t place : places) {
        go(place);
    }
    go(costs.outside());
    if (order.energy_j > costs.energy_budget_j) {
        order.cost = std::numeric_limits<double>::infinity();
    }
    order.places = std::move(places);
    return order;
}

bool is_better(const PlaceOrder& a, const PlaceOrder& b) {
    if (std::isfinite(a.cost) != std::isfinite(b.cost)) {
        return std::isfinite(a.cost);
    }
    return a.places.size() != b.places.size() ? a.places.size() > b.places.size() && std::isfinite(a.cost)
                                              : a.cost < b.cost;
}

PlaceOrder nearest_first(const LegCosts& costs) {
    std::vector<bool> is_visited(costs.targets());
    PlaceOrder order = order_of(costs, {});
    for (;;) {
        const std::size_t at = order.places.empty() ? costs.outside() : order.places.back();
        std::vector<std::size_t> left;
        for (std::size_t place = 0; place < costs.places(); ++place) {
            if (!is_visited[costs.target_of(place)]) {
                left.push_back(place);
            }
        }
        const auto nearest = std::ranges::min_element(
            left, [&](std::size_t a, std::size_t b) { return costs.leg(at, a).cost < costs.leg(at, b).cost; });
        if (nearest == left.end()) {
            return order;
        }
        std::vector<std::size_t> longer = order.places;
        longer.push_back(*nearest);
        PlaceOrder next = order_of(costs, std::move(longer));
        if (!std::isfinite(next.cost)) {
            return order;
        }
        order = std::move(next);
        is_visited[costs.target_of(*nearest)] = true;
    }
}

PlaceOrder best_order(const LegCosts& costs, const std::vector<std::size_t>& hint) {
    if (is_small(costs)) {
        return ExactSearch(costs).run();
    }
    constexpr int shakes = 10;
    const LocalSearch local(costs);
    PlaceOrder best = local.run(nearest_first(costs));
    if (PlaceOrder other = local.run(order_of(costs, hint)); is_better(other, best)) {
        best = std::move(other);
    }
    Random random(costs.places());
    for (int i = 0; i < shakes; ++i) {
        PlaceOrder other = local.run(local.shaken(best, random));
        if (is_better(other, best)) {
            best = std::move(other);
        }
    }
    return best;
}

double energy_with(const LegCosts& costs, const std::vector<std::size_t>& visited, std::size_t target) {
    std::vector<std::size_t> places;
    std::vector<std::size_t> target_of;
    std::vector<std::size_t> numbers(costs.targets(), costs.targets());
    std::size_t count = 0;
    for (std::size_t place = 0; place < costs.places(); ++place) {
        const std::size_t of = costs.target_of(place);
        if (of == target || std::ranges::find(visited, place) != visited.end()) {
            numbers[of] = numbers[of] == costs.targets() ? count++ : numbers[of];
            places.push_back(place);
            target_of.push_back(numbers[of]);
        }
    }
    LegCosts energies(std::move(target_of));
    places.push_back(costs.outside());
    for (std::size_t from = 0; from < places.size(); ++from) {
        for (std::size_t to = 0; to < places.size(); ++to) {
            const LegCost& leg = costs.leg(places[from], places[to]);
            energies.leg(from, to) = {std::isfinite(leg.cost) ? leg.energy_j : leg.cost, leg.energy_j};
        }
    }
    const PlaceOrder order = best_order(energies);
    return order.places.size() == count ? order.cost : std::numeric_limits<double>::infinity();
}

}  // namespace downwash::planning
