#include "downwash/problems/visit_order.hpp"

#include <utility>

namespace downwash {

std::string_view name_of(LeftOutReason reason) {
    return reason == LeftOutReason::energy_budget ? "energy_budget" : "no_flight";
}

VisitOrder given_order(const Problem& problem) {
    VisitOrder order;
    for (std::size_t i = 0; i < problem.targets.size(); ++i) {
        order.visits.push_back({i, std::nullopt});
    }
    return order;
}

Problem in_order(Problem problem, const VisitOrder& order) {
    if (problem.targets.empty()) {
        return problem;
    }
    const std::vector<Goal> targets = std::exchange(problem.targets, {});
    problem.stops.clear();
    for (const Visit& visit : order.visits) {
        const Goal& target = targets[visit.target];
        problem.stops.push_back(visit.alternative ? target.any_of[*visit.alternative] : target);
    }
    if (problem.return_to) {
        problem.stops.push_back(*std::exchange(problem.return_to, std::nullopt));
    }
    problem.goal = problem.stops.back();
    problem.stops.pop_back();
    return problem;
}

}  // namespace downwash
