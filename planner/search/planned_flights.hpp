#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "downwash/search/edge_flights.hpp"
#include "downwash/search/flight_point.hpp"
#include "downwash/search/goal_region.hpp"
#include "downwash/search/search_objective.hpp"
#include "downwash/search/search_record.hpp"

namespace downwash::planning {

/// Counters of everything that was flown.
template <class Family>
struct FlightStatisticsOf {
    using Obstruction = typename Family::Obstruction;

    std::uint64_t edges = 0;
    std::uint64_t ticks = 0;
    std::uint64_t states_checked = 0;
    std::map<std::string, std::uint64_t> rejected;
    std::uint64_t rejections = 0;
    StoppedBy stopped_by;
    std::optional<Obstruction> obstruction;  ///< where the rejected way that came nearest to the goal was stopped

    FlightStatisticsOf& operator+=(const FlightStatisticsOf& other);
};
using FlightStatistics = FlightStatisticsOf<Plane>;

/// The rules of planned flights. In the nominal world a flight keeps margin and bounds; in other worlds it only has to
/// succeed, as when a plan is executed.
[[nodiscard]] FlightRules planning_rules(const Problem& problem, bool in_nominal_world, std::function<bool()> is_over);

/// How the flights of one search are flown, judged, paid for and counted.
template <class Family>
class PlannedFlightsOf {
 public:
    using Configuration = typename Family::Configuration;
    using ReferencePoint = typename Family::ReferencePoint;
    using ReferenceSegment = typename Family::ReferenceSegment;
    using MotionLimits = typename Family::MotionLimits;
    using FlightState = typename Family::FlightState;
    using FlightJob = typename Family::FlightJob;
    using FlightLeg = typename Family::FlightLeg;
    using FlightChain = typename Family::FlightChain;
    using SegmentFlight = typename Family::SegmentFlight;
    using FlownWorld = typename Family::FlownWorld;
    using Pose = typename Family::Pose;
    using Obstruction = typename Family::Obstruction;
    using Fleet = FleetOf<Family>;
    using FleetJob = FleetJobOf<Family>;
    using Counterexample = CounterexampleOf<Family>;
    using SearchTask = SearchTaskOf<Family>;
    using FlightPoint = FlightPointOf<Family>;
    using EdgeFlights = EdgeFlightsOf<Family>;
    using GoalRegion = GoalRegionOf<Family>;
    using ProblemGoal = ProblemGoalOf<Family>;
    using SearchObjective = SearchObjectiveOf<Family>;
    using ProblemObjective = ProblemObjectiveOf<Family>;
    using FlightStatistics = FlightStatisticsOf<Family>;

    /// @param task must outlive it
    /// @param is_over asked now and then within flights, from all threads; true ends them without a result
    /// @param threads at least 1; nothing but the time depends on it
    explicit PlannedFlightsOf(const SearchTask& task, std::function<bool()> is_over = {}, int threads = 1);

    /// From now on flights lead to another goal, or are paid for by another objective, than that of the problem;
    /// nullptr: the problem's. They must outlive the flights.
    void lead_to(const GoalRegion* goal) noexcept { other_goal_ = goal; }
    void pay_by(const SearchObjective* objective) noexcept { other_objective_ = objective; }
    [[nodiscard]] const GoalRegion& goal() const noexcept { return other_goal_ != nullptr ? *other_goal_ : goal_; }
    [[nodiscard]] const SearchObjective& objective() const noexcept {
        return other_objective_ != nullptr ? *other_objective_ : objective_;
    }

    /// From its next batch on flies with so many of its threads. May be called from any thread.
    void use_threads(int threads);

    /// Whether a reference is worth flying: no vehicle on it, level or, under a limit of thrust, tilted as the
    /// reference asks, collides or leaves the bounds, and a flight follows its reference to a few centimetres. Counts
    /// the rejection if it is not.
    [[nodiscard]] bool is_worth_flying(const ReferenceSegment& segment) {
        return is_worth_flying(segment, statistics_);
    }
    /// The same, counted elsewhere. May be called from any thread if can_fly_chains().
    [[nodiscard]] bool is_worth_flying(const ReferenceSegment& segment, FlightStatistics& counts) const;

    /// Flies jobs, and counts ticks and rejections.
    void fly(std::span<FlightJob> jobs);

    /// From now on fleets at the start fly in these worlds, too. Of more than most_counterexamples those go that have
    /// rejected the fewest flights, and of these the oldest. Fleets from before are not to be flown on.
    /// @pre the task has worlds, if only an empty list
    void join(const std::vector<Counterexample>& counterexamples);
    static constexpr std::size_t most_counterexamples = 32;
    [[nodiscard]] bool has_counterexamples() const noexcept { return !joined_.empty(); }

    /// The vehicle at the start in every world.
    [[nodiscard]] Fleet fleet_at_start(const FlightState& nominal) const;

    /// A flight of a fleet, yet to be flown.
    /// @param from one vehicle for each world   @param ticks_from_start at which it begins, from the search's start
    [[nodiscard]] FleetJob job(const Fleet& from, std::int64_t ticks_from_start, std::vector<FlightLeg> legs,
                               std::int64_t judged_ticks = 0) const;

    /// Flies the jobs in the nominal world, then those that were accepted there in all others. Counts ticks, and every
    /// rejected job once.
    void fly(std::span<FleetJob> jobs);
    /// Flies jobs in the nominal world alone.
    void fly_nominal(std::span<FleetJob> jobs);

    /// Whether a flight in the nominal world asks nothing but the problem, and is counted by its ticks. Then chains may
    /// be flown, of which all threads ask.
    [[nodiscard]] bool can_fly_chains() const noexcept {
        return other_goal_ == nullptr && other_objective_ == nullptr && task_.flies();
    }
    /// Whether the nominal world is all that fleets at the start fly in.
    [[nodiscard]] bool is_one_world() const noexcept { return task_.worlds == nullptr && joined_.empty(); }
    /// Flies chains of jobs in the nominal world to their ends. Counts nothing. @pre can_fly_chains()
    void fly(std::span<FlightChain* const> chains) { nominal_->fly(chains); }
    /// Counts a job that a chain has flown in the nominal world, as fly_nominal() does.
    void count_nominal(const FleetJob& fleet, FlightStatistics& counts) const;
    /// Adds what was counted elsewhere.
    void add(const FlightStatistics& counts) { statistics_ += counts; }
    /// Flies those jobs in all other worlds that were accepted in the nominal one: first in the worlds that have
    /// rejected most flights so far, as many as fill the lanes, then in the rest.
    void fly_in_other_worlds(std::span<FleetJob> jobs);

    /// Flies a job again in all its worlds, by the plain loop over ticks: neither counted nor ended from outside. May
    /// be called from any thread.
    void fly_again(FleetJob& fleet) const;

    /// Flies from each moment to the next again through the planner's own model, by the plain loop over ticks. May be
    /// called from any thread.
    /// @throws std::logic_error when something is rejected, or a vehicle does not come out bit for bit
    void verify(std::span<const FlightPoint> moments) const;

    /// The hold at the goal as the last leg of a job; the job's judged_ticks have to be judged_ticks().
    [[nodiscard]] FlightLeg hold_leg(const ReferencePoint& at) const;
    [[nodiscard]] std::int64_t judged_ticks() const;

    /// The cost from the start up to the end of a leg that began with `from`.
    [[nodiscard]] double cost_after(double cost_before, const FlightState& from, const FlightLeg& leg) const {
        return cost_before + objective().of_leg(from, leg);
    }
    /// The mean of that cost over the worlds of the search, counterexamples apart.
    [[nodiscard]] double cost_after(double cost_before, const Fleet& from, const FleetJob& job, std::size_t leg) const;

    /// A segment between two points in as few ticks as the limits of motion allow.
    [[nodiscard]] ReferenceSegment fastest_segment(const ReferencePoint& from, const ReferencePoint& to) const;
    [[nodiscard]] const MotionLimits& limits() const noexcept { return limits_; }

    [[nodiscard]] const SearchTask& task() const noexcept { return task_; }
    /// What flights ask now and then; true ends them.
    [[nodiscard]] const std::function<bool()>& is_over() const noexcept { return is_over_; }
    [[nodiscard]] const FlightStatistics& statistics() const noexcept { return statistics_; }
    /// Forgets counterexamples and begins to count anew.
    void forget();
    void count_rejection(const std::string& cause) { count_rejection(cause, statistics_); }
    static void count_rejection(const std::string& cause, FlightStatistics& counts);
    /// An interrupted flight is none.
    void count_rejection(Rejection rejection) { count_rejection(rejection, statistics_); }
    static void count_rejection(Rejection rejection, FlightStatistics& counts);

 private:
    [[nodiscard]] bool leads_to_goal(const ReferenceSegment& segment) const;
    [[nodiscard]] std::size_t worlds_of_task() const noexcept;
    [[nodiscard]] const FlownWorld* world(std::size_t number) const;
    void fly_in(std::span<const std::size_t> worlds, std::span<FleetJob> jobs);
    void reject(const FleetJob& fleet, FlightStatistics& counts) const;
    /// @param world of its flight; nullptr: the nominal one
    void reject(const FlightLeg& leg, const FlownWorld* world, FlightStatistics& counts) const;
    static void count(const FlightJob& job, FlightStatistics& counts);
    /// Counts a rejection at a place of a segment.
    /// @param pose as the obstacles of its world see it
    void reject(const ReferenceSegment& segment, Rejection rejection, const Configuration& at, const Pose& pose,
                FlightStatistics& counts) const;

    const SearchTask& task_;
    std::function<bool()> is_over_;
    ProblemGoal goal_;
    ProblemObjective objective_;
    const GoalRegion* other_goal_ = nullptr;
    const SearchObjective* other_objective_ = nullptr;
    MotionLimits limits_;
    double tick_s_;
    std::unique_ptr<EdgeFlights> nominal_;       ///< flies in the nominal world
    std::unique_ptr<EdgeFlights> other_worlds_;  ///< flies in all others, if there are any
    FlightStatistics statistics_;
    std::vector<Counterexample> joined_;
    std::vector<std::uint64_t> rejected_in_;  ///< flights by world, the nominal one first
};
using PlannedFlights = PlannedFlightsOf<Plane>;

/// Whether moments end with the hover that the goal asks for: without it they are a way, not a plan.
[[nodiscard]] bool ends_with_hover(std::span<const FlightPoint> moments, const PlannedFlights& flights);

/// A count of nothing for every cause of rejection.
[[nodiscard]] std::map<std::string, std::uint64_t> no_rejections();

/// The name under which a rejection is counted.
[[nodiscard]] std::string cause_of(Rejection rejection);

}  // namespace downwash::planning
