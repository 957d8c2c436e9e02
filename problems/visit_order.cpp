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

Problem in_order(Problem problem, const std::optional<VisitOrder>& order) {
    if (problem.targets.empty() || !order || (order->visits.empty() && !problem.return_to)) {
        return problem;
    }
    const std::vector<Goal> targets = std::exchange(problem.targets, {});
    problem.goals_before.clear();
    for (const Visit& visit : order->visits) {
        const Goal& target = targets[visit.target];
        problem.goals_before.push_back(visit.alternative ? target.any_of[*visit.alternative] : target);
    }
    if (problem.return_to) {
        problem.goals_before.push_back(*std::exchange(problem.return_to, std::nullopt));
    }
    problem.goal = problem.goals_before.back();
    problem.goals_before.pop_back();
    return problem;
}

std::vector<std::string> goal_names(const Problem& problem, const std::optional<VisitOrder>& order) {
    std::vector<std::string> names;
    if (problem.targets.empty()) {
        for (std::size_t i = 0; i <= problem.goals_before.size() && !problem.goals_before.empty(); ++i) {
            names.push_back("goal " + std::to_string(i + 1));
        }
        return names.empty() ? std::vector<std::string>{"goal"} : names;
    }
    const bool is_flown = order && (!order->visits.empty() || problem.return_to);
    for (const Visit& visit : (is_flown ? *order : given_order(problem)).visits) {
        names.push_back("target " + std::to_string(visit.target + 1));
    }
    if (problem.return_to) {
        names.emplace_back("the place to return to");
    }
    return names;
}

}  // namespace downwash
