#pragma once

#include <ompl/base/Path.h>
#include <ompl/control/SimpleSetup.h>

#include <cstdint>
#include <memory>
#include <optional>

#include "downwash/base/export.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash {

/// The closed-loop flights of a problem as OMPL knows motion: a space whose states are moments of a flight, and a
/// propagator that simulates vehicle, arm and controller. OMPL's planners over controls and ompl::tools::Benchmark run
/// on it, and so does our own planner. A control is a reference velocity of (x, z, arm) [m/s, m/s, rad/s], held over
/// steps of half a second. All random numbers of samplers come from the problem's seed; OMPL's planners have generators
/// of their own. For one thread at a time. All that it hands out must not outlive it.
class DOWNWASH_EXPORT FlightSetup {
 public:
    /// @param map surface effects of the planner's model, as FlightModel::make_map() gives it; empty: free air
    /// @throws InputError with every error when the problem cannot be planned, or has more than one goal in turn
    explicit FlightSetup(Problem problem, std::shared_ptr<const AeroMap> map = {});
    ~FlightSetup();
    FlightSetup(const FlightSetup&) = delete;
    FlightSetup& operator=(const FlightSetup&) = delete;

    /// States, controls, propagation, start, goal and objective: what a planner needs, and what Benchmark takes.
    [[nodiscard]] const ::ompl::control::SimpleSetupPtr& simple_setup() const noexcept;

    /// Our planner, RRT* of flights, on the same space. Its edges are smooth references from rest to rest, which it
    /// refines; its parameters are those that algorithms() lists for rrt-star. Ends early where the problem limits the
    /// iterations.
    [[nodiscard]] ::ompl::base::PlannerPtr make_flight_tree_planner() const;

    /// The plan of an exact solution, of OMPL's planners or ours: simulated once more, with the flight to rest at the
    /// goal and the hover there. Nothing when that breaks a rule, as it does for approximate solutions.
    [[nodiscard]] std::optional<Plan> plan_of(const ::ompl::base::Path& path) const;

    [[nodiscard]] const Problem& problem() const noexcept;
    [[nodiscard]] const FlightModel& model() const noexcept;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace downwash
