#include "downwash/search/flight_tree.hpp"

#include <algorithm>
#include <cmath>

namespace downwash::planning {

namespace {

/// The largest difference of a coordinate, angles taken as they stand [m or rad].
template <class Configuration>
double max_difference(const Configuration& a, const Configuration& b) {
    double largest = 0;
    for (std::size_t axis = 0; axis < a.coordinate.size(); ++axis) {
        largest = std::max(largest, std::abs(a[axis] - b[axis]));
    }
    return largest;
}

}  // namespace

template <class Family>
FlightTreeOf<Family>::FlightTreeOf(const FlightPoint& start, PlannedFlights& flights)
    : flights_(flights), space_(flights.task().space), nearest_(space_) {
    FlightNode root;
    root.configuration = configuration_of(start.reference);
    root.reference = start.reference;
    root.fleet = flights.task().fleet_from(start.vehicle);
    moving_.push_back(&nodes_.emplace_back(std::move(root)));
    nearest_.add(moving_.back()->configuration);
}

template <class Family>
auto FlightTreeOf<Family>::nearest(const Configuration& to, std::size_t count) const -> std::vector<FlightNode*> {
    std::vector<FlightNode*> nodes;
    for (const std::size_t number : nearest_.nearest(to, count)) {
        nodes.push_back(moving_[number]);
    }
    return nodes;
}

template <class Family>
double FlightTreeOf<Family>::estimated_cost(const FlightNode& from, const Configuration& to) const {
    return flights_.objective().estimate(from.configuration, to);
}

template <class Family>
double FlightTreeOf<Family>::min_cost_to_goal(const Configuration& from) const {
    return flights_.objective().min_to_goal(from);
}

template <class Family>
auto FlightTreeOf<Family>::segment_to(const FlightNode& from, const ReferencePoint& to, std::int64_t ticks) const
    -> ReferenceSegment {
    return {from.reference, to, ticks, flights_.task().tick_s};
}

template <class Family>
auto FlightTreeOf<Family>::promising_segment(const Edge& edge, FlightStatistics& counts) const
    -> std::optional<ReferenceSegment> {
    const ReferenceSegment segment = flights_.fastest_segment(edge.from->reference, edge.to);
    if (segment.ticks() > max_plan_ticks - edge.from->ticks_from_start) {
        PlannedFlights::count_rejection("too_long", counts);
        return std::nullopt;
    }
    // A passage may be out of reach at its speed.
    const bool begins_in_passage = edge.from->parent != nullptr && !is_at_rest(edge.from->reference);
    if ((begins_in_passage || !is_at_rest(edge.to)) && !keeps_limits(segment, flights_.limits())) {
        return std::nullopt;
    }
    return flights_.is_worth_flying(segment, counts) ? std::optional(segment) : std::nullopt;
}

template <class Family>
auto FlightTreeOf<Family>::flown(const FlightNode& from, const FleetJob& job) const -> std::optional<Flown> {
    if (!job.is_accepted()) {
        return std::nullopt;
    }
    const ReferenceSegment& segment = job.legs().back().segment;
    return Flown{segment.to(), segment.ticks(), job.end(),
                 flights_.cost_after(from.cost, from.fleet, job, job.legs().size() - 1)};
}

template <class Family>
auto FlightTreeOf<Family>::flown(std::span<const Edge> edges) -> std::vector<std::optional<Flown>> {
    std::vector<FleetJob> jobs;
    std::vector<std::size_t> edge_of;
    FlightStatistics counts;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (const auto segment = promising_segment(edges[i], counts)) {
            jobs.push_back(flights_.job(edges[i].from->fleet, edges[i].from->ticks_from_start, {{*segment}}));
            edge_of.push_back(i);
        }
    }
    flights_.add(counts);
    flights_.fly(jobs);
    std::vector<std::optional<Flown>> results(edges.size());
    for (std::size_t job = 0; job < jobs.size(); ++job) {
        results[edge_of[job]] = flown(*edges[edge_of[job]].from, jobs[job]);
    }
    return results;
}

/// A chain of edges as the jobs that a pool flies.
template <class Family>
class FlightTreeOf<Family>::JobChain final : public Family::FlightChain {
 public:
    JobChain(const FlightTree& tree, EdgeChain& edges) : tree_(tree), edges_(edges) {}

    FlightJob* next() override {
        if (from_ != nullptr) {
            tree_.flights_.count_nominal(job_, steps_.back().flown);
            if (job_.jobs.front().rejection() == Rejection::interrupted) {
                return nullptr;
            }
            edges_.note(tree_.flown(*from_, job_));
            from_ = nullptr;
        }
        while (const std::optional<Edge> edge = edges_.next()) {
            Step& step = steps_.emplace_back();
            if (const auto segment = tree_.promising_segment(*edge, step.promised)) {
                from_ = edge->from;
                job_ = tree_.flights_.job(from_->fleet, from_->ticks_from_start, {{*segment}});
                return &job_.jobs.front();
            }
            edges_.note(std::nullopt);
        }
        return nullptr;
    }

    /// What is to be counted of each edge: before it was flown, and then.
    struct Step {
        FlightStatistics promised, flown;
    };
    [[nodiscard]] const std::vector<Step>& steps() const noexcept { return steps_; }

 private:
    const FlightTree& tree_;
    EdgeChain& edges_;
    std::vector<Step> steps_;
    const FlightNode* from_ = nullptr;  ///< of the edge under way
    FleetJob job_;
};

template <class Family>
void FlightTreeOf<Family>::fly(std::span<EdgeChain* const> chains) {
    if (!flights_.can_fly_chains() || !flights_.is_one_world()) {
        fly_in_rounds(chains);
        return;
    }
    std::deque<JobChain> jobs;
    std::vector<FlightChain*> all;
    for (EdgeChain* chain : chains) {
        all.push_back(&jobs.emplace_back(*this, *chain));
    }
    flights_.fly(all);
    // Counted as in rounds, whatever ended first: of two obstructions as near to the goal the first one stays.
    std::size_t rounds = 0;
    for (const JobChain& chain : jobs) {
        rounds = std::max(rounds, chain.steps().size());
    }
    for (std::size_t round = 0; round < rounds; ++round) {
        for (const auto counts : {&JobChain::Step::promised, &JobChain::Step::flown}) {
            for (const JobChain& chain : jobs) {
                if (round < chain.steps().size()) {
                    flights_.add(chain.steps()[round].*counts);
                }
            }
        }
    }
}

/// In many worlds it is known after every round which of them reject most, and are to be flown in first.
template <class Family>
void FlightTreeOf<Family>::fly_in_rounds(std::span<EdgeChain* const> chains) {
    for (;;) {
        std::vector<Edge> edges;
        std::vector<EdgeChain*> owners;
        for (EdgeChain* chain : chains) {
            if (const std::optional<Edge> edge = chain->next()) {
                edges.push_back(*edge);
                owners.push_back(chain);
            }
        }
        if (edges.empty()) {
            return;
        }
        auto flights = flown(edges);
        for (std::size_t i = 0; i < flights.size(); ++i) {
            owners[i]->note(std::move(flights[i]));
        }
    }
}

template <class Family>
auto FlightTreeOf<Family>::add(FlightNode& parent, const Flown& flight) -> FlightNode& {
    FlightNode& node = attach(parent, flight);
    moving_.push_back(&node);
    nearest_.add(node.configuration);
    return node;
}

/// Makes a node at the end of an edge; nothing starts from it yet.
template <class Family>
auto FlightTreeOf<Family>::attach(FlightNode& parent, const Flown& flight) -> FlightNode& {
    FlightNode& node = nodes_.emplace_back();
    node.configuration = configuration_of(flight.to);
    node.reference = flight.to;
    node.fleet = flight.fleet;
    node.cost = flight.cost;
    node.parent = &parent;
    node.ticks = flight.ticks;
    node.ticks_from_start = parent.ticks_from_start + flight.ticks;
    parent.children.push_back(&node);
    return node;
}

template <class Family>
void FlightTreeOf<Family>::add_holds(std::span<FlightNode* const> nodes) {
    std::vector<FleetJob> jobs;
    std::vector<FlightNode*> held;
    for (FlightNode* node : nodes) {
        if (is_at_rest(node->reference)) {
            jobs.push_back(hold_job(*node));
            held.push_back(node);
        }
    }
    flights_.fly(jobs);
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        if (const auto flight = flown(*held[i], jobs[i])) {
            FlightNode& hold = attach(*held[i], *flight);
            holds_.push_back(&hold);
            hold.is_hold = true;
        }
    }
}

template <class Family>
auto FlightTreeOf<Family>::hold_job(const FlightNode& at) const -> FleetJob {
    return flights_.job(at.fleet, at.ticks_from_start, {flights_.hold_leg(at.reference)}, flights_.judged_ticks());
}

template <class Family>
auto FlightTreeOf<Family>::edge_job(const FlightNode& from, const FlightNode& to) const -> FleetJob {
    return to.is_hold ? hold_job(from)
                      : flights_.job(from.fleet, from.ticks_from_start, {{segment_to(from, to.reference, to.ticks)}});
}

template <class Family>
std::size_t FlightTreeOf<Family>::rewire(std::span<const Rewiring> rewirings) {
    std::vector<Rewiring> open;
    std::vector<Edge> edges;
    for (const Rewiring& r : rewirings) {
        const Configuration& to = r.node->configuration;
        // Otherwise a joint would arrive a whole turn away, or the vehicle would look another way.
        const ReferencePoint looking = space_.looking(r.parent->reference, r.node->reference);
        if (max_difference(space_.seen_from(r.parent->configuration, to), to) <= 1e-9 &&
            max_difference(configuration_of(looking), to) <= 1e-9) {
            open.push_back(r);
            edges.push_back({r.parent, r.node->reference});
        }
    }
    const std::vector<double> cost_before = [&] {
        std::vector<double> costs(open.size());
        std::transform(open.begin(), open.end(), costs.begin(), [](const Rewiring& r) { return r.parent->cost; });
        return costs;
    }();
    const auto flights = flown(edges);
    std::size_t done = 0;
    for (std::size_t i = 0; i < open.size(); ++i) {
        // A parent that an earlier rewiring moved would have to be flown from anew.
        const bool is_current = open[i].parent->cost == cost_before[i];
        if (flights[i] && is_current && flights[i]->cost < open[i].node->cost) {
            done += move_below(*open[i].node, *open[i].parent, *flights[i]) ? 1 : 0;
        }
    }
    return done;
}

template <class Family>
bool FlightTreeOf<Family>::move_below(FlightNode& node, FlightNode& parent, const Flown& flight) {
    for (const FlightNode* n = &parent; n != nullptr; n = n->parent) {
        if (n == &node) {
            return false;  // an earlier rewiring has put the parent below the node
        }
    }
    struct Before {
        FlightNode* node;
        Fleet fleet;
        double cost;
        std::int64_t ticks;
        std::int64_t ticks_from_start;
        bool is_discarded;
    };
    std::vector<Before> changed;
    const auto replace = [&changed](FlightNode& n, const FlightNode& from, const Flown& by) {
        changed.push_back({&n, n.fleet, n.cost, n.ticks, n.ticks_from_start, n.is_discarded});
        n.fleet = by.fleet;
        n.cost = by.cost;
        n.ticks = by.ticks;
        n.ticks_from_start = from.ticks_from_start + by.ticks;
        n.is_discarded = false;  // a new flight, a new chance
    };
    const auto undo = [&changed] {
        for (const Before& before : changed) {
            before.node->fleet = before.fleet;
            before.node->cost = before.cost;
            before.node->ticks = before.ticks;
            before.node->ticks_from_start = before.ticks_from_start;
            before.node->is_discarded = before.is_discarded;
        }
        return false;
    };
    replace(node, parent, flight);
    std::vector<FlightNode*> generation{&node};
    while (!generation.empty()) {
        std::vector<FlightNode*> children;
        std::vector<FleetJob> jobs;
        for (const FlightNode* n : generation) {
            for (FlightNode* child : n->children) {
                children.push_back(child);
                jobs.push_back(edge_job(*n, *child));
            }
        }
        flights_.fly(jobs);
        for (std::size_t i = 0; i < children.size(); ++i) {
            const FlightNode& from = *children[i]->parent;
            const auto again = flown(from, jobs[i]);
            const bool is_too_long =
                !children[i]->is_hold && again && from.ticks_from_start + again->ticks > max_plan_ticks;
            if (!again || is_too_long || again->cost >= children[i]->cost) {
                return undo();
            }
            replace(*children[i], from, *again);
        }
        generation = std::move(children);
    }
    std::erase(node.parent->children, &node);
    node.parent = &parent;
    parent.children.push_back(&node);
    return true;
}

template <class Family>
auto FlightTreeOf<Family>::moments_to(const FlightNode& node) -> std::vector<FlightPoint> {
    std::vector<FlightPoint> moments;
    for (const FlightNode* n = &node; n != nullptr; n = n->parent) {
        moments.push_back(moment_at(*n));
    }
    std::reverse(moments.begin(), moments.end());
    return moments;
}

template <class Family>
auto FlightTreeOf<Family>::plan_to(const FlightNode& node) const -> Plan {
    std::vector<FlightPoint> moments = moments_to(node);
    if (!node.is_hold) {
        moments.push_back(moments.back());  // a plan leaves out what comes after its last knot
    }
    return plan_through(moments, flights_.task().blank_plan);
}

template class FlightTreeOf<Plane>;
template class FlightTreeOf<Space>;

}  // namespace downwash::planning
