#include "downwash/problems/visit_order.hpp"

namespace downwash {
namespace {

VisitOrder order_of_file(std::size_t targets) {
    VisitOrder order;
    for (std::size_t i = 0; i < targets; ++i) {
        order.visits.push_back({i, std::nullopt});
    }
    return order;
}

/// Whether an order says in which one goals are visited.
template <class AnyProblem>
bool is_flown(const AnyProblem& problem, const std::optional<VisitOrder>& order) {
    return !targets_of(problem).empty() && order && (!order->visits.empty() || problem.return_to);
}

/// The goals that are visited, and the place to return to.
template <class AnyProblem>
auto goals_in(const AnyProblem& problem, const VisitOrder& order) {
    const auto targets = targets_of(problem);
    std::vector<typename decltype(targets)::value_type> goals;
    for (const Visit& visit : order.visits) {
        const auto& target = targets[visit.target];
        goals.push_back(visit.alternative ? target.any_of[*visit.alternative] : target);
    }
    if (problem.return_to) {
        goals.push_back(*problem.return_to);
    }
    return goals;
}

template <class AnyProblem>
std::vector<std::string> names_in(const AnyProblem& problem, const std::optional<VisitOrder>& order) {
    std::vector<std::string> names;
    if (targets_of(problem).empty()) {
        const std::size_t goals = goals_of(problem).size();
        for (std::size_t i = 0; i < goals && goals > 1; ++i) {
            names.push_back("goal " + std::to_string(i + 1));
        }
        return names.empty() ? std::vector<std::string>{"goal"} : names;
    }
    for (const Visit& visit : (is_flown(problem, order) ? *order : given_order(problem)).visits) {
        names.push_back("target " + std::to_string(visit.target + 1));
    }
    if (problem.return_to) {
        names.emplace_back("the place to return to");
    }
    return names;
}

}  // namespace

std::string_view name_of(LeftOutReason reason) {
    return reason == LeftOutReason::energy_budget ? "energy_budget" : "no_flight";
}

VisitOrder given_order(const Problem& problem) {
    return order_of_file(problem.targets.size());
}

VisitOrder given_order(const SpaceProblem& problem) {
    return order_of_file(problem.goals.size());
}

Problem in_order(Problem problem, const std::optional<VisitOrder>& order) {
    if (!is_flown(problem, order)) {
        return problem;
    }
    problem.goals_before = goals_in(problem, *order);
    problem.goal = problem.goals_before.back();
    problem.goals_before.pop_back();
    problem.targets.clear();
    problem.return_to.reset();
    return problem;
}

SpaceProblem in_order(SpaceProblem problem, const std::optional<VisitOrder>& order) {
    if (!is_flown(problem, order)) {
        return problem;
    }
    problem.goals = goals_in(problem, *order);
    problem.in_any_order = false;
    problem.return_to.reset();
    return problem;
}

std::vector<std::string> goal_names(const Problem& problem, const std::optional<VisitOrder>& order) {
    return names_in(problem, order);
}

std::vector<std::string> goal_names(const SpaceProblem& problem, const std::optional<VisitOrder>& order) {
    return names_in(problem, order);
}

}  // namespace downwash
