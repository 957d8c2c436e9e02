#include "downwash/cli/order_rows.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "downwash/cli/output.hpp"

namespace downwash::cli {

std::string goal_name(const std::optional<VisitOrder>& order, std::size_t number) {
    if (!order) {
        return fmt::format("goal {}", number);
    }
    const std::vector<Visit>& visits = order->visits;
    return number <= visits.size() ? fmt::format("target {}", visits[number - 1].target + 1) : "the place to return to";
}

std::string order_rows(const VisitOrder& order, bool has_plan, const std::optional<double>& energy_budget_j) {
    std::string visits;
    for (const Visit& visit : order.visits) {
        visits += (visits.empty() ? "" : ", ") + std::to_string(visit.target + 1);
        visits += visit.alternative ? fmt::format(" (alternative {})", *visit.alternative + 1) : "";
    }
    std::string text = table_row("order", visits.empty() ? "none: no target is visited" : "targets " + visits);
    if (!visits.empty()) {
        text +=
            table_row("", !has_plan ? "no plan in that order was found"
                          : order.is_best
                              ? fmt::format("the cheapest by {} flown legs and lower bounds of the others", order.legs)
                              : fmt::format("the cheapest that was found by {} flown legs", order.legs));
    }
    for (const LeftOutTarget& each : order.left_out) {
        std::string why = "no flight to it was found";
        if (each.energy_j) {
            why = fmt::format("with it the flight takes about {:.6g} J of {:.6g} J", *each.energy_j,
                              energy_budget_j.value_or(0));
        }
        text += table_row(&each == &order.left_out.front() ? "left out" : "",
                          fmt::format("target {}: {}", each.target + 1, why));
    }
    return text;
}

std::string met_goals_text(const std::optional<VisitOrder>& order, const std::vector<bool>& met) {
    const std::size_t flown = order ? std::min(order->visits.size(), met.size()) : met.size();
    const auto end = met.begin() + static_cast<std::ptrdiff_t>(flown);
    const auto count = std::count(met.begin(), end, true);
    if (!order) {
        return fmt::format("{} of {} met", count, met.size());
    }
    const std::size_t targets = order->visits.size() + order->left_out.size();
    const char* way_back = end == met.end() ? "" : *end ? ", and the return" : ", but not the return";
    return fmt::format("{} of {} targets met{}", count, targets, way_back);
}

std::string left_out_text(const VisitOrder& order) {
    return fmt::format("{} of {} targets are visited; to the others no flight was found.", order.visits.size(),
                       order.visits.size() + order.left_out.size());
}

bool lacks_energy_for_all(const std::optional<VisitOrder>& order) {
    return order && order->visits.empty() && std::ranges::all_of(order->left_out, [](const LeftOutTarget& each) {
               return each.reason == LeftOutReason::energy_budget;
           });
}

}  // namespace downwash::cli
