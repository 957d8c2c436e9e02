#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "downwash/controllers/plan.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/search/nearest_places.hpp"
#include "downwash/search/planned_flights.hpp"
#include "downwash/search/search_record.hpp"
#include "downwash/search/search_space.hpp"
#include "downwash/simulation/flight.hpp"

namespace downwash::planning {

/// A vehicle that arrived somewhere, and how.
template <class Family>
struct FlightNodeOf {
    using Configuration = typename Family::Configuration;
    using ReferencePoint = typename Family::ReferencePoint;
    using Fleet = FleetOf<Family>;

    Configuration configuration;  ///< the reference point at which the edge to this node ends
    ReferencePoint reference;     ///< that point with its derivatives; only the root and passages may move
    Fleet fleet;                  ///< the whole vehicle there in every world, integrators included
    double cost = 0;              ///< cost of the flight from the start, in the objective's unit
    FlightNodeOf* parent = nullptr;
    std::int64_t ticks = 0;  ///< length of the edge from the parent
    std::int64_t ticks_from_start = 0;
    std::vector<FlightNodeOf*> children;
    bool is_hold = false;       ///< the edge is the hold at the goal; such a node has no children
    bool is_discarded = false;  ///< a hold whose direct flight failed
};
using FlightNode = FlightNodeOf<Plane>;

/// The moment at which a vehicle is at a node.
template <class Family>
[[nodiscard]] FlightPointOf<Family> moment_at(const FlightNodeOf<Family>& node) {
    return {node.fleet.front(), {node.fleet.begin() + 1, node.fleet.end()},
            node.reference,     node.configuration,
            node.cost,          node.ticks_from_start};
}

/// The tree of closed-loop flights: every edge is a flight from the parent's whole vehicle state along a reference
/// segment that starts at the parent's reference point. Holds at the goal are edges as well. Knows no search strategy.
template <class Family>
class FlightTreeOf {
 public:
    using FlightTree = FlightTreeOf;
    using Configuration = typename Family::Configuration;
    using ReferencePoint = typename Family::ReferencePoint;
    using ReferenceSegment = typename Family::ReferenceSegment;
    using Plan = typename Family::Plan;
    using FlightJob = typename Family::FlightJob;
    using FlightChain = typename Family::FlightChain;
    using SearchSpace = typename Family::SearchSpace;
    using Fleet = FleetOf<Family>;
    using FleetJob = FleetJobOf<Family>;
    using FlightPoint = FlightPointOf<Family>;
    using PlannedFlights = PlannedFlightsOf<Family>;
    using FlightNode = FlightNodeOf<Family>;
    using NearestPlaces = NearestPlacesOf<Family>;
    using FlightStatistics = FlightStatisticsOf<Family>;

    /// @param start the moment that becomes the root   @param flights must outlive it
    FlightTreeOf(const FlightPoint& start, PlannedFlights& flights);

    [[nodiscard]] FlightNode& root() noexcept { return nodes_.front(); }
    [[nodiscard]] std::size_t size() const noexcept { return moving_.size(); }
    /// The nodes that edges may start from, oldest first; holds are not among them.
    [[nodiscard]] const std::vector<FlightNode*>& nodes() const noexcept { return moving_; }
    [[nodiscard]] const std::vector<FlightNode*>& holds() const noexcept { return holds_; }

    /// The `count` nodes nearest to a configuration, nearest first; ties by age.
    [[nodiscard]] std::vector<FlightNode*> nearest(const Configuration& to, std::size_t count) const;

    /// What the flight of an edge would cost far from all surfaces, without flying it.
    [[nodiscard]] double estimated_cost(const FlightNode& from, const Configuration& to) const;

    /// No chain of edges from a configuration to the goal, and hold there, costs less, far from all surfaces.
    [[nodiscard]] double min_cost_to_goal(const Configuration& from) const;

    /// An edge that may be worth flying: from a node to a reference point (arm angle unwrapped as seen from it).
    struct Edge {
        const FlightNode* from;
        ReferencePoint to;
    };
    /// A flight that was accepted but belongs to no tree yet.
    struct Flown {
        ReferencePoint to;
        std::int64_t ticks;
        Fleet fleet;
        double cost;  ///< from the start, mean over all worlds
    };

    /// Flies edges side by side; nothing for those that are rejected.
    [[nodiscard]] std::vector<std::optional<Flown>> flown(std::span<const Edge> edges);

    /// Edges that are flown one after the other, of which each is chosen when the one before was flown. All threads of
    /// the flights may ask, one at a time for one chain and several at once for several chains.
    class EdgeChain {
     public:
        EdgeChain() = default;
        virtual ~EdgeChain() = default;
        EdgeChain(const EdgeChain&) = delete;
        EdgeChain& operator=(const EdgeChain&) = delete;

        /// The edge to fly now; nothing at the end of the chain.
        [[nodiscard]] virtual std::optional<Edge> next() = 0;
        /// What became of it; nothing if it was rejected.
        virtual void note(std::optional<Flown> flight) = 0;
    };
    /// Flies chains to their ends, side by side.
    void fly(std::span<EdgeChain* const> chains);

    /// Adds what was flown below its parent.
    FlightNode& add(FlightNode& parent, const Flown& flight);

    /// Flies holds at nodes, and adds those that meet the goal over their last second.
    void add_holds(std::span<FlightNode* const> nodes);

    /// A node, and another that might be its cheaper parent.
    struct Rewiring {
        FlightNode* node;
        FlightNode* parent;
    };
    /// Tries them in their order: puts the node below the parent by an accepted flight, if that is cheaper, and flies
    /// its whole subtree again from the new state. Everything stays as it was when a descendant fails or some cost
    /// would not fall. Returns how many were done.
    std::size_t rewire(std::span<const Rewiring> rewirings);

    /// The moments from the root to a node, at the end of each edge; the last is moment_at(node).
    [[nodiscard]] static std::vector<FlightPoint> moments_to(const FlightNode& node);

    /// The plan that leads to a node (for a hold: to its parent).
    [[nodiscard]] Plan plan_to(const FlightNode& node) const;

 private:
    [[nodiscard]] ReferenceSegment segment_to(const FlightNode& from, const ReferencePoint& to,
                                              std::int64_t ticks) const;
    class JobChain;
    void fly_in_rounds(std::span<EdgeChain* const> chains);
    [[nodiscard]] std::optional<ReferenceSegment> promising_segment(const Edge& edge, FlightStatistics& counts) const;
    [[nodiscard]] std::optional<Flown> flown(const FlightNode& from, const FleetJob& job) const;
    [[nodiscard]] FleetJob hold_job(const FlightNode& at) const;
    [[nodiscard]] FleetJob edge_job(const FlightNode& from, const FlightNode& to) const;
    FlightNode& attach(FlightNode& parent, const Flown& flight);
    bool move_below(FlightNode& node, FlightNode& parent, const Flown& flight);

    PlannedFlights& flights_;
    const SearchSpace& space_;
    std::deque<FlightNode> nodes_;
    std::vector<FlightNode*> moving_;
    NearestPlaces nearest_;
    std::vector<FlightNode*> holds_;
};
using FlightTree = FlightTreeOf<Plane>;

}  // namespace downwash::planning
