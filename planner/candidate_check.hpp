#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "downwash/planner/course.hpp"
#include "downwash/planner/direct_flight.hpp"
#include "downwash/planner/planner_model.hpp"
#include "downwash/planner/safe_stops.hpp"
#include "downwash/planner/search_clock.hpp"
#include "downwash/planner/search_result.hpp"
#include "downwash/planner/worlds.hpp"
#include "downwash/search/planned_flights.hpp"
#include "downwash/search/search_task.hpp"

namespace downwash::planning {

template <class Family>
class StopFinderOf;

/// What plans have to pass beside the rules of the search itself. Without one they need not.
template <class Family>
struct PlanChecksOf {
    using ProblemWorlds = typename Family::ProblemWorlds;
    using StopFinder = StopFinderOf<Family>;

    ProblemWorlds* worlds = nullptr;    ///< in which edges are flown and plans certified
    StopFinder* stop_finder = nullptr;  ///< by which a plan must not become clearly worse
    /// Of a search that is one of several: how long after its beginning the check of its first plan may end [s], even
    /// if its own limit is over. A search that is cut off there would have to begin anew.
    double time_s = 0;
};
using PlanChecks = PlanChecksOf<Plane>;

/// A plan that comes near the goal only.
template <class Family>
struct ApproachOf {
    using Plan = typename Family::Plan;

    Status status = Status::none;
    std::optional<Plan> plan;
    double cost = 0;
    std::optional<double> nearest_m;
};
using Approach = ApproachOf<Plane>;

/// Decides which plans of one search count, whatever its level of awareness and its algorithm, and keeps the best. A
/// candidate is a plan that the planner's own model accepts; it is executed with direct aerodynamics, flown for its
/// certificate and asked for its stops, as far as the problem wants that.
template <class Family>
class CandidateCheckOf {
 public:
    using Plan = typename Family::Plan;
    using FlightState = typename Family::FlightState;
    using Problem = typename Family::Problem;
    using Goal = typename Family::Goal;
    using Obstruction = typename Family::Obstruction;
    using TreeNode = typename Family::TreeNode;
    using Counterexample = CounterexampleOf<Family>;
    using SearchWorlds = SearchWorldsOf<Family>;
    using SearchTask = SearchTaskOf<Family>;
    using FlightStatistics = FlightStatisticsOf<Family>;
    using Found = FoundOf<Family>;
    using SearchResult = SearchResultOf<Family>;
    using Course = CourseOf<Family>;
    using PlannerModel = PlannerModelOf<Family>;
    using PlanChecks = PlanChecksOf<Family>;
    using Approach = ApproachOf<Family>;
    using SolveOptions = SolveOptionsOf<Family>;
    using DirectFlight = DirectFlightOf<Family>;

    /// As for search_goal(). All arguments must outlive it.
    CandidateCheckOf(const Problem& part, const Problem& whole, const PlannerModel& model, const Course& before,
                     const PlanChecks& checks, const SolveOptions& options);

    /// What is searched for, from the end of the course on.
    [[nodiscard]] const SearchTask& task() const noexcept { return task_; }
    [[nodiscard]] SearchClock& clock() noexcept { return clock_; }
    /// Whether the search has to end.
    [[nodiscard]] bool is_over() { return result_.weak_goal || clock_.is_over(); }
    /// Whether a check that has begun has to end, too.
    [[nodiscard]] bool check_is_over() { return result_.weak_goal || clock_.is_over_for_checks(); }

    /// Whether a candidate counts. The search may go on meanwhile on other threads.
    [[nodiscard]] bool counts(const Plan& plan, double cost);
    /// Takes on the candidate that counted last.
    void accept(const Plan& plan, double cost, std::uint64_t iteration);
    /// Worlds in which the last candidate failed, for a search in worlds to learn from between two of its rounds. If
    /// an earlier part of the flight is to blame, the search ends, unless it has shown that these parts can be good
    /// enough.
    [[nodiscard]] std::vector<Counterexample> new_counterexamples();

    /// What the search came to; called last.
    /// @param tree what it has grown, if it was to be kept   @param nearest in place of a plan, if there is none
    [[nodiscard]] SearchResult result(std::uint64_t iterations, const FlightStatistics& statistics,
                                      std::vector<TreeNode> tree, const Approach& nearest);

 private:
    [[nodiscard]] bool has_plan() const { return result_.found.status == Status::solved; }
    [[nodiscard]] bool is_too_late();
    [[nodiscard]] bool flies_well(const Plan& plan, double cost);
    [[nodiscard]] bool needs_certificate() const { return certifies() && goals_.size() == checks_.worlds->goals(); }
    [[nodiscard]] bool certifies() const { return checks_.worlds != nullptr && task_.problem.planner.certify; }
    [[nodiscard]] WorldCounter world_counter() {
        return [this](std::uint64_t worlds, std::uint64_t failures) { clock_.certifies(worlds, failures); };
    }
    void certify(const Plan& flown, const StopCondition& is_over);
    [[nodiscard]] bool is_certified(const Plan& plan, double cost);
    [[nodiscard]] bool can_stop(const Plan& plan);
    void report_failure(const FlightStatistics& statistics, const Approach& nearest);

    const SolveOptions& options_;
    const Course& before_;
    PlanChecks checks_;        ///< the finder of stops is asked for plans to the last goal alone
    std::vector<Goal> goals_;  ///< up to the one that is searched for
    SearchResult result_;      ///< with the best plan so far
    SearchClock clock_;
    SearchWorlds search_worlds_;
    SearchTask task_;
    bool is_executed_alone_;                       ///< what is executed begins at the end of the course
    FlightState start_;                            ///< where that begins
    std::optional<DirectFlight> flight_;           ///< made last
    std::optional<Obstruction> discarded_;         ///< what discarded the last plan that was
    std::optional<Certificate> certificate_;       ///< certificate of the plan that was executed last
    std::optional<SafeStopsOf<Family>> stops_;     ///< along that plan
    std::vector<Counterexample> counterexamples_;  ///< in which that plan failed
    std::optional<std::size_t> weakest_;           ///< part of that plan
    /// The plan without a certificate that has the lowest bound of its failure probability: one that was
    /// interrupted after a few worlds says little.
    struct Uncertified {
        Plan plan;
        double cost;
        Certificate certificate;
    };
    std::optional<Uncertified> uncertified_;
    /// The plan that was discarded last, if its direct flight was cut off.
    struct Unfinished {
        Plan plan;
        double cost;
    };
    std::optional<Unfinished> unfinished_;
    double known_at_s_ = 0;  ///< when it was known whether the last plan counts
};
using CandidateCheck = CandidateCheckOf<Plane>;

}  // namespace downwash::planning
