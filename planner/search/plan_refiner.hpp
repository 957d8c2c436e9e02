#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "downwash/controllers/plan.hpp"
#include "downwash/search/change_flights.hpp"
#include "downwash/search/plan_changes.hpp"
#include "downwash/search/planned_flights.hpp"
#include "downwash/search/random.hpp"
#include "downwash/search/search_record.hpp"

namespace downwash::planning {

/// A plan, and before it those from which it came, each a little cheaper than the one before.
template <class Family>
using LineageOf = std::vector<typename Family::Plan>;
using Lineage = LineageOf<Plane>;

/// Makes plans fly like a good pilot: fewer corners, passed without a stop. Every change (a corner moved, left out, put
/// in or flown through, another place at the goal) is flown in closed loop under all rules, hold included, and kept
/// only when that is cheaper (what gets back to the old way for more is not flown on): an evolution strategy with
/// success-driven step length (Rechenberg 1973), several changes side by side. Of two plans that it works on the
/// cheaper one is the best; the other one is given a chance to overtake it before it is dropped.
template <class Family>
class PlanRefinerOf {
 public:
    using Configuration = typename Family::Configuration;
    using ReferencePoint = typename Family::ReferencePoint;
    using Plan = typename Family::Plan;
    using Fleet = FleetOf<Family>;
    using FleetJob = FleetJobOf<Family>;
    using SearchWorlds = SearchWorldsOf<Family>;
    using FlightPoint = FlightPointOf<Family>;
    using PlannedFlights = PlannedFlightsOf<Family>;
    using PlanChanges = PlanChangesOf<Family>;
    using ChangeFlights = ChangeFlightsOf<Family>;
    using ChangedPlan = ChangedPlanOf<Family>;
    using ChangeBatch = ChangeBatchOf<Family>;
    using FlownPlan = FlownPlanOf<Family>;
    using Lineage = LineageOf<Family>;
    using FlightStatistics = FlightStatisticsOf<Family>;

    /// @param start the moment at which all plans begin   @param flights and `random` must outlive it
    PlanRefinerOf(FlightPoint start, PlannedFlights& flights, Random& random);

    /// Whether there is room for another plan to work on.
    [[nodiscard]] bool wants_plan() const noexcept { return tracks_.size() < max_tracks; }
    /// Flies a plan and takes it on, if nothing rejects it. Far more expensive ones than the best plan are not wanted.
    /// If counterexamples reject the plan, two others are tried: the last plan of its lineage that they do not reject,
    /// and changes of the plan. The cheaper one is taken on.
    /// @param lineage not empty
    /// @param steps_back how many of its last plans are known to fail, or supposed to; after more than one, changes are
    /// tried only if no other plan flies
    void work_on(Lineage lineage, std::size_t steps_back = 0);
    /// Gives up its plans, the best first, to be taken on anew when counterexamples have joined.
    [[nodiscard]] std::vector<Lineage> release();

    /// Tries some changes of one of its plans, as many as are flown side by side.
    void improve();

    [[nodiscard]] const FlownPlan* best() const noexcept;
    /// Number, in the order in which plans were taken on, of the one that became the best; the first is 1.
    /// @pre there is a best plan
    [[nodiscard]] int best_number() const noexcept { return tracks_.front().number; }
    /// Forgets what became of a plan that was taken on, which flies in the planner's model only.
    void drop(int number);
    /// The moments at the knots of a plan; then the one after the hold.
    [[nodiscard]] std::vector<FlightPoint> moments_of(const FlownPlan& flown) const;

 private:
    static constexpr std::size_t max_tracks = 2;
    /// How large the changes of a plan are.
    struct Pace {
        double step = 1;   ///< as a share of the largest
        int failures = 0;  ///< batches since the last success, or since steps became large again

        void succeed() noexcept;
        void fail() noexcept;
    };
    struct Track {
        FlownPlan plan;
        std::uint64_t version;  ///< of the plan: no two plans have the same
        Lineage lineage;        ///< up to the plan, or to one that it has become a little cheaper than
        double kept_cost;       ///< cost of the last of them
        int number;             ///< number of the plan that was taken on
        Pace pace = {};
        int batches = 0;  ///< batches in which it was worked on
    };
    /// A batch of changes that was drawn, and flown in the nominal world. Its results are those of whenever its turn
    /// comes, if nothing has changed that it was drawn from: improve() draws and flies some batches at once, as if none
    /// of them found a better plan, and throws away those that were drawn in vain.
    struct Batch {
        // What it was drawn from.
        std::size_t turn = 0;
        std::size_t tracks = 0;
        std::uint64_t version = 0;
        double step = 0;
        Random before;

        Random after;  ///< the random numbers that follow
        ChangeBatch flights;
    };
    [[nodiscard]] Batch next_batch();
    [[nodiscard]] bool is_due(const Batch& batch) const;
    void draw_batches();

    [[nodiscard]] std::optional<ChangedPlan> changed(const std::vector<ReferencePoint>& points,
                                                     const std::vector<std::int64_t>& ticks, double step,
                                                     FlightStatistics& counts);
    /// A change that the plan's end is moved into the goal, so far that it uses up at most this share of the tolerance.
    [[nodiscard]] std::optional<ChangedPlan> moved_into_goal(const ChangedPlan& plan, double share,
                                                             FlightStatistics& counts) const;
    [[nodiscard]] std::optional<FlownPlan> repaired(const ChangedPlan& plan);
    [[nodiscard]] std::optional<FlownPlan> last_that_flies(Lineage& lineage);
    void add(FlownPlan plan, Lineage lineage);
    [[nodiscard]] Plan plan_of(const FlownPlan& flown) const;
    [[nodiscard]] static ChangedPlan as_change(const Plan& plan);

    PlannedFlights& flights_;
    Random& random_;
    PlanChanges changes_;
    ChangeFlights change_flights_;
    std::vector<Track> tracks_;  ///< the best first
    int taken_ = 0;
    std::size_t turn_ = 0;
    std::uint64_t versions_ = 0;         ///< of plans so far
    std::deque<Batch> batches_;          ///< drawn ahead, the next one first
    std::size_t failures_in_a_row_ = 0;  ///< batches without a better plan, of whichever track
};
using PlanRefiner = PlanRefinerOf<Plane>;

}  // namespace downwash::planning
