#include "downwash/planner/flight_tree.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "downwash/base/lane_math.hpp"
#include "downwash/planner/solve.hpp"

namespace downwash::planning {
namespace {

bool is_at_rest(const ReferencePoint& point) {
    return point == at_rest({point.position[0], point.position[1], point.position[2]});
}

bool same_bytes(const FlightState& a, const FlightState& b) {
    static_assert(std::is_trivially_copyable_v<FlightState> && sizeof(FlightState) % sizeof(double) == 0);
    return std::memcmp(&a, &b, sizeof(FlightState)) == 0;
}

}  // namespace

std::string cause_of(FlightFault fault) {
    switch (fault) {
        case FlightFault::collision:
            return "collision";
        case FlightFault::flyable_area:
            return "flyable_area";
        case FlightFault::saturation:
            return "saturation";
        case FlightFault::tracking:
            return "tracking";
        case FlightFault::unstable:
            return "unstable";
        case FlightFault::bounds:
            return "bounds";
        case FlightFault::goal_missed:
            return "goal_missed";
        case FlightFault::none:
        case FlightFault::interrupted:
            break;
    }
    throw std::logic_error("a flight that was not refused has no cause of refusal");
}

std::map<std::string, std::uint64_t> no_rejections() {
    return {{"collision", 0}, {"flyable_area", 0}, {"saturation", 0},    {"tracking", 0}, {"unstable", 0},
            {"bounds", 0},    {"goal_missed", 0},  {"direct_flight", 0}, {"too_long", 0}};
}

FlightTree::FlightTree(const Problem& problem, const FlightModel& model, const SearchSpace& space, const AeroMap* map,
                       std::function<bool()> is_over)
    : problem_(problem),
      model_(model),
      space_(space),
      map_(map),
      limits_(reference_limits(problem.motion)),
      free_air_cost_(problem, model, space) {
    rules_.margin_m = problem.planner.safety_margin_m;
    rules_.bounds = problem.bounds;
    rules_.is_over = std::move(is_over);
    rules_.measures_clearance = problem.planner.objective == Objective::clearance;
    statistics_.rejected = no_rejections();
    FlightNode root;
    const Start& start = problem.start;
    root.configuration = {start.x_m, start.z_m, start.arm_rad};
    root.reference = reference_at(start);
    root.state = start_state(model, start);
    moving_.push_back(&nodes_.emplace_back(std::move(root)));
}

void FlightTree::count_rejection(const std::string& cause) {
    ++statistics_.rejected[cause];
    ++statistics_.rejections;
}

std::vector<FlightNode*> FlightTree::nearest(const Configuration& to, std::size_t count) const {
    // A plain scan: beside edges of a millisecond it does not show below a hundred thousand nodes.
    std::vector<std::pair<double, std::size_t>> by_distance(moving_.size());
    for (std::size_t i = 0; i < moving_.size(); ++i) {
        by_distance[i] = {space_.distance_m(moving_[i]->configuration, to), i};
    }
    const std::size_t kept = std::min(count, by_distance.size());
    std::partial_sort(by_distance.begin(), by_distance.begin() + static_cast<std::ptrdiff_t>(kept), by_distance.end());
    std::vector<FlightNode*> result(kept);
    for (std::size_t i = 0; i < kept; ++i) {
        result[i] = moving_[by_distance[i].second];
    }
    return result;
}

double FlightTree::estimated_cost(const FlightNode& from, const Configuration& to) const {
    return free_air_cost_.of_motion(from.configuration, to);
}

ReferenceSegment FlightTree::segment_to(const FlightNode& from, const ReferencePoint& to, std::int64_t ticks) const {
    return {from.reference, to, ticks, model_.tick().tick_s};
}

FlightFault FlightTree::reference_fault(const ReferenceSegment& segment) {
    // A flight follows its reference to a few centimetres, so a reference that collides is not worth flying.
    constexpr double spacing_m = 0.1;
    const ReferencePoint& a = segment.from();
    const ReferencePoint& b = segment.to();
    const double end_to_end_m = std::abs(b.position[0] - a.position[0]) + std::abs(b.position[1] - a.position[1]) +
                                problem_.robot.arm.length_m * std::abs(b.position[2] - a.position[2]);
    const double by_speed_m =
        (std::abs(a.velocity[0]) + std::abs(a.velocity[1]) + problem_.robot.arm.length_m * std::abs(a.velocity[2])) *
        segment.duration_s();  // a moving start may overshoot the line
    const double motion_m = end_to_end_m + by_speed_m;
    const auto samples = static_cast<std::int64_t>(std::ceil(motion_m / spacing_m)) + 1;
    for (std::int64_t i = samples; i >= 1; --i) {  // from the new end, where obstacles are likelier
        const ReferencePoint p = segment.at_tick(segment.ticks() * i / samples);
        ++statistics_.states_checked;
        const FlightFault fault = space_.fault_at({p.position[0], p.position[1], p.position[2]});
        if (fault != FlightFault::none) {
            return fault;
        }
    }
    return FlightFault::none;
}

bool FlightTree::accepted(const SegmentFlight& flight) {
    statistics_.ticks += static_cast<std::uint64_t>(flight.ticks);
    statistics_.states_checked += static_cast<std::uint64_t>(flight.ticks);
    if (flight.fault == FlightFault::interrupted) {
        return false;
    }
    if (flight.fault != FlightFault::none) {
        count_rejection(cause_of(flight.fault));
        return false;
    }
    return true;
}

double FlightTree::cost_after(double cost_before, const SegmentFlight& flight, const FlightState& state) const {
    switch (problem_.planner.objective) {
        case Objective::energy:
            break;
        case Objective::time:
            return cost_before + static_cast<double>(flight.ticks) * model_.tick().tick_s;
        case Objective::length:
            return cost_before + flight.length_m;
        case Objective::clearance:
            return cost_before + flight.clearance_integral;
    }
    return state.plant.energy_j;
}

std::optional<FlightTree::Flown> FlightTree::fly_to(const FlightNode& from, const Configuration& to,
                                                    std::int64_t ticks) {
    const ReferenceSegment segment = segment_to(from, at_rest(to), ticks);
    Flown result{to, ticks, from.state, 0};
    ++statistics_.edges;
    const SegmentFlight flight = fly(model_, map_, rules_, segment, result.state);
    if (!accepted(flight)) {
        return std::nullopt;
    }
    result.cost = cost_after(from.cost, flight, result.state);
    return result;
}

std::optional<FlightTree::Flown> FlightTree::flown(const FlightNode& from, const Configuration& to) {
    const std::int64_t ticks = shortest_ticks(from.reference, at_rest(to), limits_, model_.tick().tick_s);
    if (ticks > most_plan_ticks - from.ticks_from_start) {
        count_rejection("too_long");
        return std::nullopt;
    }
    const FlightFault fault = reference_fault(segment_to(from, at_rest(to), ticks));
    if (fault != FlightFault::none) {
        count_rejection(cause_of(fault));
        return std::nullopt;
    }
    return fly_to(from, to, ticks);
}

FlightNode& FlightTree::add(FlightNode& parent, const Flown& flight) {
    FlightNode& node = nodes_.emplace_back();
    node.configuration = flight.to;
    node.reference = at_rest(flight.to);
    node.state = flight.state;
    node.cost = flight.cost;
    node.parent = &parent;
    node.ticks = flight.ticks;
    node.ticks_from_start = parent.ticks_from_start + flight.ticks;
    parent.children.push_back(&node);
    moving_.push_back(&node);
    return node;
}

std::optional<FlightTree::Flown> FlightTree::fly_hold(const FlightNode& from) {
    const double tick_s = model_.tick().tick_s;
    const std::int64_t ticks = hold_ticks(problem_.goal, tick_s);
    const std::int64_t judged = std::min<std::int64_t>(ticks, std::llround(goal_settling_s / tick_s));
    const PlantModel& plant = model_.tick().plant;
    Flown result{from.configuration, ticks, from.state, from.cost};
    if (ticks <= judged && !meets_goal(problem_.goal, plant, result.state)) {
        count_rejection("goal_missed");
        return std::nullopt;
    }
    // The last second is flown tick by tick, as the goal has to be met in each of them.
    std::int64_t remaining = ticks;
    ++statistics_.edges;
    while (remaining > 0) {
        const std::int64_t piece = remaining > judged ? remaining - judged : 1;
        const SegmentFlight flight = fly(model_, map_, rules_, segment_to(from, from.reference, piece), result.state);
        if (!accepted(flight)) {
            return std::nullopt;
        }
        result.cost = cost_after(result.cost, flight, result.state);
        remaining -= piece;
        if (remaining <= judged && !meets_goal(problem_.goal, plant, result.state)) {
            count_rejection("goal_missed");
            return std::nullopt;
        }
    }
    return result;
}

FlightNode* FlightTree::add_hold(FlightNode& parent) {
    if (!is_at_rest(parent.reference)) {
        return nullptr;
    }
    const std::optional<Flown> flight = fly_hold(parent);
    if (!flight) {
        return nullptr;
    }
    FlightNode& hold = add(parent, *flight);
    moving_.pop_back();
    holds_.push_back(&hold);
    hold.is_hold = true;
    return &hold;
}

bool FlightTree::rewire(FlightNode& node, FlightNode& parent) {
    const Configuration& to = node.configuration;
    if (std::abs(space_.seen_from(parent.configuration, to).arm_rad - to.arm_rad) > 1e-9) {
        return false;  // the arm would arrive a whole turn away
    }
    const std::optional<Flown> flight = flown(parent, to);
    if (!flight || flight->cost >= node.cost) {
        return false;
    }
    struct Before {
        FlightNode* node;
        FlightState state;
        double cost;
        std::int64_t ticks;
        std::int64_t ticks_from_start;
        bool is_discarded;
    };
    std::vector<Before> changed;
    const auto replace = [&changed](FlightNode& n, const FlightNode& from, const Flown& by) {
        changed.push_back({&n, n.state, n.cost, n.ticks, n.ticks_from_start, n.is_discarded});
        n.state = by.state;
        n.cost = by.cost;
        n.ticks = by.ticks;
        n.ticks_from_start = from.ticks_from_start + by.ticks;
        n.is_discarded = false;  // a new flight, a new chance
    };
    replace(node, parent, *flight);
    for (std::size_t i = 0; i < changed.size(); ++i) {
        for (FlightNode* child : changed[i].node->children) {
            const FlightNode& from = *changed[i].node;
            const std::optional<Flown> again =
                child->is_hold ? fly_hold(from) : fly_to(from, child->configuration, child->ticks);
            if (!again || again->cost >= child->cost) {
                for (const Before& before : changed) {
                    before.node->state = before.state;
                    before.node->cost = before.cost;
                    before.node->ticks = before.ticks;
                    before.node->ticks_from_start = before.ticks_from_start;
                    before.node->is_discarded = before.is_discarded;
                }
                return false;
            }
            replace(*child, from, *again);
        }
    }
    std::erase(node.parent->children, &node);
    node.parent = &parent;
    parent.children.push_back(&node);
    return true;
}

Plan FlightTree::plan_to(const FlightNode& node) const {
    std::vector<const FlightNode*> way;
    for (const FlightNode* n = node.is_hold ? node.parent : &node; n != nullptr; n = n->parent) {
        way.push_back(n);
    }
    Plan plan;
    plan.tick_s = model_.tick().tick_s;
    std::reverse(way.begin(), way.end());
    std::int64_t tick = 0;
    for (const FlightNode* n : way) {
        tick += n->ticks;
        plan.waypoints.push_back({n->configuration.x_m, n->configuration.z_m, n->configuration.arm_rad});
        plan.reference.push_back({tick, n->reference});
    }
    return plan;
}

void FlightTree::verify(const FlightNode& node) const {
    std::vector<const FlightNode*> way;
    for (const FlightNode* n = &node; n->parent != nullptr; n = n->parent) {
        way.push_back(n);
    }
    std::reverse(way.begin(), way.end());
    FlightState state = nodes_.front().state;
    for (const FlightNode* n : way) {
        const ReferenceSegment segment = segment_to(*n->parent, n->reference, n->ticks);
        const SegmentFlight flight = fly(model_, map_, rules_, segment, state);
        if (flight.fault != FlightFault::none || !same_bytes(state, n->state)) {
            throw std::logic_error("re-flying a plan did not reproduce the search tree bit for bit");
        }
    }
}

}  // namespace downwash::planning
