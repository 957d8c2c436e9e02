#pragma once

#include <ompl/control/SpaceInformation.h>

#include <memory>
#include <optional>
#include <vector>

#include "closed_loop_ode.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash::bench {

/// A planner as a practitioner builds it from OMPL's tutorial: control::RRT, an ODESolver (RK4, 10 ms) for the closed
/// loop, propagation by 0.1 s, and plain FCL between every body and every obstacle at the end of each.
///
/// Written to be quick where a user is free to choose: collisions without a margin, once in 0.1 s; no rule on
/// saturation or tracking; the tip at the goal is enough, neither at rest nor held; goals sampled by inverse
/// kinematics.
///
/// With worlds it is an RRT over RandUP (T. Lew and M. Pavone 2020, "Sampling-based Reachability Analysis: A Random Set
/// Theory Approach with Adversarial Sampling"), without its padding: a state holds one particle for each world. An edge
/// moves all of them by the same control, and is valid if all are; the goal is reached when all are in it. Distances
/// are those of the first particle.
class UserPlanner {
 public:
    /// @pre obstacles are boxes, cylinders and spheres   @param map as for ClosedLoopOde
    /// @param worlds of the particles, as far as ClosedLoopOde knows them; they begin after a hover there. Empty: one
    /// particle in the nominal world
    UserPlanner(const Problem& problem, const FlightModel& model, const AeroMap* map,
                std::vector<FlownWorld> worlds = {});
    ~UserPlanner();

    /// Time to the first solution [s]; nothing within the limit. OMPL's global generator is the source of chance.
    [[nodiscard]] std::optional<double> time_to_first_solution_s(double limit_s) const;

    [[nodiscard]] const ompl::control::SpaceInformationPtr& information() const;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace downwash::bench
