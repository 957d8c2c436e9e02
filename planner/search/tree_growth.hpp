#pragma once

#include <cmath>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "downwash/search/flight_tree.hpp"
#include "downwash/search/flight_tree_parameters.hpp"
#include "downwash/search/level_ways.hpp"
#include "downwash/search/passage_sampler.hpp"
#include "downwash/search/place_sampler.hpp"
#include "downwash/search/random.hpp"

namespace downwash::planning {

/// How the tree of flights grows: RRT* in batches of samples, whose edges are simulated side by side. Parents are
/// chosen and nodes rewired by simulated cost; nodes within the goal's tolerances get holds.
template <class Family>
class TreeGrowthOf {
 public:
    using TreeGrowth = TreeGrowthOf;
    using Configuration = typename Family::Configuration;
    using ReferencePoint = typename Family::ReferencePoint;
    using SearchSpace = typename Family::SearchSpace;
    using FlightPoint = FlightPointOf<Family>;
    using PlannedFlights = PlannedFlightsOf<Family>;
    using FlightNode = FlightNodeOf<Family>;
    using FlightTree = FlightTreeOf<Family>;
    using PlaceSampler = PlaceSamplerOf<Family>;
    using Edge = typename FlightTree::Edge;
    using Flown = typename FlightTree::Flown;
    using EdgeChain = typename FlightTree::EdgeChain;
    using Rewiring = typename FlightTree::Rewiring;

    /// All arguments must outlive the growth. @param sampler may draw from `random`, too
    TreeGrowthOf(const FlightPoint& start, const SearchSpace& space, const FlightTreeParameters& parameters,
                 PlannedFlights& flights, Random& random, PlaceSampler& sampler);

    /// One batch. @return the samples drawn: `max_samples`, or as many as make a batch
    std::uint64_t grow(std::optional<std::uint64_t> max_samples);
    /// Samples are drawn beside this plan too from now on. @param moments as in Candidate
    void know_plan(const std::vector<FlightPoint>& moments) { known_plan_ = moments; }
    /// These places are tried first, in their order.
    void try_first(std::vector<Configuration> places);
    /// The tree grows along this way first; in space only. @param corners as of LevelWaysOf::find()
    void follow(std::vector<Configuration> corners);
    /// The plan that ends with this hold does not count: no direct flight confirms it.
    void discard(FlightNode& hold);

    /// Whether there is a plan, of the tree or one that it was told of.
    [[nodiscard]] bool has_plan() const noexcept { return known_plan_ || best_hold_cost_ < HUGE_VAL; }
    /// The cheapest hold that was not discarded; nullptr when there is none.
    [[nodiscard]] FlightNode* best_hold() const;
    /// The hold with this rank by cost among all, discarded ones too, modulo their number; nullptr without any.
    [[nodiscard]] const FlightNode* hold_by_rank(std::size_t rank) const;
    /// The hold whose way leads farthest from a plan, among some drawn at random; nullptr when all follow it.
    [[nodiscard]] const FlightNode* hold_away_from(const std::vector<ReferencePoint>& way);

    [[nodiscard]] const FlightTree& tree() const noexcept { return tree_; }
    /// The node whose reference comes nearest to the goal.
    [[nodiscard]] const FlightNode& nearest_to_goal() const noexcept { return *nearest_to_goal_; }
    /// How near that is [m]; 0 within the goal region.
    [[nodiscard]] double nearest_distance_m() const noexcept { return nearest_distance_m_; }

 private:
    /// A sample on its way to become a node.
    struct Growth {
        ReferencePoint to;
        std::vector<FlightNode*> neighbours;
        struct Parent {
            FlightNode* node;
            double estimate;
        };
        std::vector<Parent> parents;  ///< by estimate
        std::size_t next_parent = 0;
        std::optional<Flown> best;
        FlightNode* best_parent = nullptr;
    };

    class ParentChoice;

    [[nodiscard]] std::optional<ReferencePoint> aim();
    [[nodiscard]] std::optional<ReferencePoint> point_of_passage();
    [[nodiscard]] std::optional<ReferencePoint> point_of_way();
    [[nodiscard]] Configuration beside_corner(std::size_t corner);
    [[nodiscard]] bool find_way();
    [[nodiscard]] std::optional<Configuration> target();
    [[nodiscard]] std::optional<Configuration> target_beside_plan();
    [[nodiscard]] std::size_t neighbour_count() const;
    [[nodiscard]] std::optional<Growth> sampled();
    void choose_parents(std::vector<Growth>& batch);
    [[nodiscard]] std::vector<FlightNode*> add(const std::vector<Growth>& batch);
    void add_holds(const std::vector<FlightNode*>& added);
    void rewire_through(const std::vector<Growth>& batch, const std::vector<FlightNode*>& added);
    void note_best_hold();

    const SearchSpace& space_;
    const FlightTreeParameters& parameters_;
    PlannedFlights& flights_;
    Random& random_;
    PlaceSampler& sampler_;
    typename Family::NarrowWays narrow_ways_;
    /// Points on the way through a passage, each to be tried in a later batch than the one before.
    struct Due {
        std::uint64_t batch;
        ReferencePoint point;
    };
    std::deque<Due> due_;
    std::uint64_t batch_ = 0;  ///< number of the batch under way
    /// The way of the level vehicle along which samples are drawn.
    struct LevelWay {
        std::vector<Configuration> corners;
        std::size_t samples = 0;          ///< that have been drawn along it
        std::size_t samples_to_wait = 0;  ///< of the others, until another one is looked for
        std::size_t failures = 0;         ///< in a row
    };
    LevelWay way_;
    FlightTree tree_;
    std::vector<Configuration> first_places_;  ///< yet to be tried, the next one last
    std::optional<std::vector<FlightPoint>> known_plan_;
    double best_hold_cost_ = HUGE_VAL;  ///< lowest cost of the holds that were not discarded
    const FlightNode* nearest_to_goal_;
    double nearest_distance_m_;
};
using TreeGrowth = TreeGrowthOf<Plane>;

}  // namespace downwash::planning
