#pragma once

#include <ompl/base/Path.h>
#include <ompl/control/SimpleSetup.h>

#include <cstdint>
#include <memory>
#include <optional>

#include "downwash/base/export.hpp"
#include "downwash/controllers/configuration.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/planner/certificate.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash {

/// The closed-loop flights of a problem as OMPL knows motion: a space whose states are moments of a flight, and a
/// propagator that simulates vehicle, arm and controller. OMPL's planners over controls and ompl::tools::Benchmark run
/// on it, and so does our own planner. A control is a reference velocity of (x, z, arm) [m/s, m/s, rad/s], held over
/// steps of half a second. Where the problem has an uncertainty a state is the vehicle in each of its `planner.worlds`,
/// and a motion is valid if it is in all of them. All random numbers of samplers come from the problem's seed; OMPL's
/// planners have generators of their own. For one thread at a time. All that it hands out must not outlive it.
class DOWNWASH_EXPORT FlightSetup {
 public:
    /// @param map surface effects of the planner's model, as FlightModel::make_map() gives it; empty: free air
    /// @throws InputError with every error when the problem cannot be planned, has more than one goal in turn, or asks
    /// for mp-arm, which flies nothing
    explicit FlightSetup(Problem problem, std::shared_ptr<const AeroMap> map = {});
    ~FlightSetup();
    FlightSetup(const FlightSetup&) = delete;
    FlightSetup& operator=(const FlightSetup&) = delete;

    /// States, controls, propagation, start, goal and objective: what a planner needs, and what Benchmark takes.
    [[nodiscard]] const ::ompl::control::SimpleSetupPtr& simple_setup() const noexcept;

    /// Our planner, RRT* of flights, on the same space. Its edges are smooth references from rest to rest, which it
    /// refines; its parameters are those that algorithms() lists for rrt-star. Ends early where the problem limits the
    /// iterations. To the problem's own goal only plans count that are executed well and get their certificate, as far
    /// as `planner.check_execution` and `planner.certify` ask for it. A user's GoalSampleableRegion, additive
    /// OptimizationObjective and samplers are obeyed: docs/embedding.md.
    [[nodiscard]] ::ompl::base::PlannerPtr make_flight_tree_planner() const;

    /// The plan of an exact solution, of OMPL's planners or ours: simulated once more, with the flight to rest at the
    /// goal and the hover there. Nothing when that breaks a rule, as it does for approximate solutions.
    [[nodiscard]] std::optional<Plan> plan_of(const ::ompl::base::Path& path) const;

    /// Flies a plan through the problem's goal in worlds that no search has seen, until it is known whether it fails
    /// rarely enough. All plans that ask share the error that `planner.confidence` allows. @pre the problem has an
    /// uncertainty
    [[nodiscard]] Certificate certify(const Plan& plan);
    /// The certificate asked for last, of our planner's plans or by certify().
    [[nodiscard]] const std::optional<Certificate>& certificate() const noexcept;

    /// The space of places, a compound of the translations and each joint, in which the sampler of the states draws.
    [[nodiscard]] const ::ompl::base::StateSpacePtr& places() const noexcept;
    /// Where the vehicle of a state is, in the nominal world.
    [[nodiscard]] static Configuration place_of(const ::ompl::base::State* state);
    /// The energy that it has spent since the start [J].
    [[nodiscard]] static double energy_j_of(const ::ompl::base::State* state);
    /// Makes a state that of the vehicle at rest at a place, for goals and samplers.
    void rest_at(const Configuration& place, ::ompl::base::State* state) const;

    [[nodiscard]] const Problem& problem() const noexcept;
    [[nodiscard]] const FlightModel& model() const noexcept;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace downwash
