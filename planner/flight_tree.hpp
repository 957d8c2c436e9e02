#pragma once

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "downwash/planner/free_air_cost.hpp"
#include "downwash/planner/problem.hpp"
#include "downwash/planner/search_space.hpp"
#include "downwash/planner/solution.hpp"
#include "downwash/simulation/flight.hpp"

namespace downwash::planning {

/// A vehicle that arrived somewhere, and how.
struct FlightNode {
    Configuration configuration;  ///< the reference point at which the edge to this node ends, at rest
    ReferencePoint reference;     ///< the same with its derivatives; only the root may move
    FlightState state;            ///< the whole vehicle there, integrators included
    double cost = 0;              ///< of the flight from the start, in the objective's unit
    FlightNode* parent = nullptr;
    std::int64_t ticks = 0;  ///< length of the edge from the parent
    std::int64_t ticks_from_start = 0;
    std::vector<FlightNode*> children;
    bool is_hold = false;       ///< the edge is the hold at the goal; such a node has no children
    bool is_discarded = false;  ///< a hold whose direct flight failed
};

/// Counters of everything that was flown.
struct FlightStatistics {
    std::uint64_t edges = 0;
    std::uint64_t ticks = 0;
    std::uint64_t states_checked = 0;
    std::map<std::string, std::uint64_t> rejected;
    std::uint64_t rejections = 0;
};

/// The tree of closed-loop flights: every edge is a flight from the parent's whole vehicle state along a reference
/// segment that starts at the parent's reference point. Holds at the goal are edges as well. Knows no search strategy.
class FlightTree {
 public:
    /// @param map surface effects of the planner's own model; nullptr for none
    /// @param is_over asked now and then within a flight; true ends it without a result
    FlightTree(const Problem& problem, const FlightModel& model, const SearchSpace& space, const AeroMap* map,
               std::function<bool()> is_over = {});

    [[nodiscard]] FlightNode& root() noexcept { return nodes_.front(); }
    [[nodiscard]] std::size_t size() const noexcept { return moving_.size(); }
    /// The nodes that edges may start from, oldest first; holds are not among them.
    [[nodiscard]] const std::vector<FlightNode*>& nodes() const noexcept { return moving_; }
    [[nodiscard]] const std::vector<FlightNode*>& holds() const noexcept { return holds_; }
    [[nodiscard]] const FlightStatistics& statistics() const noexcept { return statistics_; }
    void count_rejection(const std::string& cause);

    /// The `count` nodes nearest to a configuration, nearest first; ties by age.
    [[nodiscard]] std::vector<FlightNode*> nearest(const Configuration& to, std::size_t count) const;

    /// What the flight of an edge would cost far from all surfaces, without flying it.
    [[nodiscard]] double estimated_cost(const FlightNode& from, const Configuration& to) const;

    /// A flight that was accepted but belongs to no tree yet.
    struct Flown {
        Configuration to;
        std::int64_t ticks;
        FlightState state;
        double cost;  ///< from the start
    };

    /// Flies from a node to rest at a configuration (arm angle unwrapped as seen from the node). Nothing when refused.
    [[nodiscard]] std::optional<Flown> flown(const FlightNode& from, const Configuration& to);

    /// Adds what was flown below its parent.
    FlightNode& add(FlightNode& parent, const Flown& flight);

    /// Flies the hold at a node and adds it when the goal is met over its last second. nullptr when refused.
    FlightNode* add_hold(FlightNode& parent);

    /// Puts `node` below `parent` by an accepted flight, if that is cheaper, and flies its whole subtree again from the
    /// new state. Everything stays as it was when a descendant fails or some cost would not fall.
    bool rewire(FlightNode& node, FlightNode& parent);

    /// The plan that leads to a node (for a hold: to its parent).
    [[nodiscard]] Plan plan_to(const FlightNode& node) const;

    /// Flies the plan to a node again from the start through the planner's own model.
    /// @throws std::logic_error when some node's state does not come out bit for bit
    void verify(const FlightNode& node) const;

 private:
    [[nodiscard]] ReferenceSegment segment_to(const FlightNode& from, const ReferencePoint& to,
                                              std::int64_t ticks) const;
    [[nodiscard]] FlightFault reference_fault(const ReferenceSegment& segment);
    [[nodiscard]] std::optional<Flown> fly_to(const FlightNode& from, const Configuration& to, std::int64_t ticks);
    [[nodiscard]] std::optional<Flown> fly_hold(const FlightNode& from);
    [[nodiscard]] bool accepted(const SegmentFlight& flight);
    [[nodiscard]] double cost_after(double cost_before, const SegmentFlight& flight, const FlightState& state) const;

    const Problem& problem_;
    const FlightModel& model_;
    const SearchSpace& space_;
    const AeroMap* map_;
    FlightRules rules_;
    ReferenceLimits limits_;
    FreeAirCost free_air_cost_;
    std::deque<FlightNode> nodes_;
    std::vector<FlightNode*> moving_;
    std::vector<FlightNode*> holds_;
    FlightStatistics statistics_;
};

/// A count of nothing for every cause of refusal.
[[nodiscard]] std::map<std::string, std::uint64_t> no_rejections();

/// The name under which a refusal is counted.
[[nodiscard]] std::string cause_of(FlightFault fault);

}  // namespace downwash::planning
