#include "downwash/results/order_reader.hpp"

#include <string>
#include <vector>

namespace downwash::problems {
namespace {

/// A number from 1 to `most`, as one from 0; nothing where it is something else.
std::optional<std::size_t> read_number(JsonReader& reader, const Node& group, const char* name, std::size_t most,
                                       const char* what) {
    const auto node = reader.required(group, name);
    if (!node || node->json->is_null()) {
        return std::nullopt;
    }
    std::size_t number = 0;
    if (node->json->is_number_unsigned()) {
        number = node->json->get<std::size_t>();
    }
    if (number < 1 || number > most) {
        reader.report(*node, "expected the number of " + std::string(what) + ", 1 to " + std::to_string(most));
        return std::nullopt;
    }
    return number - 1;
}

/// Reads the number of a target that was not read before.
std::optional<std::size_t> read_target(JsonReader& reader, const Node& group, std::vector<bool>& is_known) {
    const auto target = read_number(reader, group, "target", is_known.size(), "a target of the problem");
    if (target && is_known[*target]) {
        reader.report(group, "target " + std::to_string(*target + 1) + " stands here twice");
        return std::nullopt;
    }
    if (target) {
        is_known[*target] = true;
    }
    return target;
}

/// Reads the order in a node. @param problem with targets
template <class AnyProblem>
VisitOrder read_order_in(JsonReader& reader, const Node& node, const AnyProblem& problem) {
    const auto targets = targets_of(problem);
    VisitOrder order;
    if (!node.json->is_object()) {
        reader.report(node, "expected a group of keys or null");
        return order;
    }
    std::vector<bool> is_known(targets.size());
    for (const Node& each : reader.groups(reader.required(node, "visits"))) {
        if (const auto target = read_target(reader, each, is_known)) {
            const std::size_t alternatives = targets[*target].any_of.size();
            const auto alternative = JsonReader::member(each, "alternative");
            Visit visit{*target, std::nullopt};
            if (alternative && !alternative->json->is_null() && alternatives == 0) {
                reader.report(*alternative, "this target has no alternatives: expected null");
            } else if (alternative) {
                visit.alternative =
                    read_number(reader, each, "alternative", alternatives, "an alternative of this target");
            }
            order.visits.push_back(visit);
        }
    }
    for (const Node& each : reader.groups(JsonReader::member(node, "left_out"))) {
        if (const auto target = read_target(reader, each, is_known)) {
            LeftOutTarget& left_out = order.left_out.emplace_back();
            left_out.target = *target;
            reader.read_choice(each, "reason", all_left_out_reasons, left_out.reason);
            left_out.energy_j = reader.optional_amount(each, "energy_j");
        }
    }
    reader.read_flag(node, "is_best", order.is_best);
    reader.read_count(node, "legs", order.legs);
    order.cost_of_legs = reader.amount(node, "cost_of_legs", 0);
    for (std::size_t target = 0; target < is_known.size() && reader.errors().empty(); ++target) {
        if (!is_known[target]) {
            reader.report(node, "target " + std::to_string(target + 1) +
                                    " is missing here: expected it among the visits or left out");
        }
    }
    if (order.visits.empty() && !problem.return_to && reader.errors().empty()) {
        reader.report(node, "there is a plan, but it visits no target");
    }
    return order;
}

/// The node of an order. @return nothing without one
template <class AnyProblem>
std::optional<Node> node_of_order(JsonReader& reader, const Node& root, const AnyProblem& problem) {
    auto node = JsonReader::member(root, "order");
    if (!node || node->json->is_null()) {
        return std::nullopt;
    }
    if (targets_of(problem).empty()) {
        reader.report(*node, "the problem has no targets in any order; is it the plan of another problem?");
        return std::nullopt;
    }
    return node;
}

}  // namespace

std::optional<VisitOrder> read_order(JsonReader& reader, const Node& root, const Problem& problem) {
    const auto node = node_of_order(reader, root, problem);
    if (node) {
        return read_order_in(reader, *node, problem);
    }
    return targets_of(problem).empty() ? std::nullopt : std::optional(given_order(problem));
}

std::optional<VisitOrder> read_order(JsonReader& reader, const Node& root, const SpaceProblem& problem) {
    const auto node = node_of_order(reader, root, problem);
    if (node) {
        return read_order_in(reader, *node, problem);
    }
    return targets_of(problem).empty() || leaves_order_open(problem) ? std::nullopt
                                                                     : std::optional(given_order(problem));
}

}  // namespace downwash::problems
