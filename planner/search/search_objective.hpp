#pragma once

#include "downwash/search/free_air_cost.hpp"
#include "downwash/simulation/flight_job.hpp"

namespace downwash::planning {

/// What a search keeps small: the objective of its problem, or one that a user of OMPL has written. Costs of legs add
/// up, and less is better.
template <class Family>
class SearchObjectiveOf {
 public:
    using Configuration = typename Family::Configuration;
    using FlightState = typename Family::FlightState;
    using FlightLeg = typename Family::FlightLeg;

    SearchObjectiveOf() = default;
    virtual ~SearchObjectiveOf() = default;
    SearchObjectiveOf(const SearchObjectiveOf&) = delete;
    SearchObjectiveOf& operator=(const SearchObjectiveOf&) = delete;

    /// The cost of a leg that began with a vehicle and was flown to its end.
    [[nodiscard]] virtual double of_leg(const FlightState& from, const FlightLeg& leg) const = 0;
    /// What a motion costs far from all surfaces, without flying it.
    [[nodiscard]] virtual double estimate(const Configuration& from, const Configuration& to) const = 0;
    /// No way from a configuration to the goal, and hold there, costs less.
    [[nodiscard]] virtual double min_to_goal(const Configuration& from) const = 0;
};
using SearchObjective = SearchObjectiveOf<Plane>;

/// The objective of a problem.
template <class Family>
class ProblemObjectiveOf final : public SearchObjectiveOf<Family> {
 public:
    using Configuration = typename Family::Configuration;
    using FlightState = typename Family::FlightState;
    using FlightLeg = typename Family::FlightLeg;
    using SearchTask = SearchTaskOf<Family>;
    using FreeAirCost = FreeAirCostOf<Family>;

    /// @param task must outlive it
    explicit ProblemObjectiveOf(const SearchTask& task);

    [[nodiscard]] double of_leg(const FlightState& from, const FlightLeg& leg) const override;
    [[nodiscard]] double estimate(const Configuration& from, const Configuration& to) const override {
        return free_air_cost_.of_motion(from, to);
    }
    [[nodiscard]] double min_to_goal(const Configuration& from) const override {
        return free_air_cost_.min_cost_to_goal(from);
    }

 private:
    const CostFunction& objective_;
    double tick_s_;
    FreeAirCost free_air_cost_;
};
using ProblemObjective = ProblemObjectiveOf<Plane>;

}  // namespace downwash::planning
