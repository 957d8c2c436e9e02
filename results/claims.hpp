#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/problems/visit_order.hpp"

namespace downwash {

/// What a solution file says about the flight of its plan.
struct FlightClaims {
    bool aero = true;
    /// Which world of which seed.
    struct WorldIndex {
        std::uint64_t index = 0, seed = 0;
    };
    std::optional<WorldIndex> world;  ///< empty: the nominal one
    std::string outcome;
    std::optional<double> min_clearance_m;  ///< empty without obstacles
    double energy_j = 0, duration_s = 0, cost = 0, goal_error_m = 0;
};

/// What a solution file says, contradictions included: for those who judge it.
struct Claims {
    CostFunction objective;
    std::uint64_t seed = 1;
    Plan plan;                        ///< the reference
    std::optional<VisitOrder> order;  ///< order in which it visits the targets of the problem, if that has some
    std::vector<Configuration> waypoints;
    std::optional<FlightClaims> flight;
    std::optional<double> certified_share;  ///< the failure probability that a given certificate promises at most
};

/// Reads a solution file without comparing its parts. What a plan written by hand leaves out is taken from the
/// problem's settings.
/// @throws ProblemFileError with every error: no solution file, no plan in it, a reference off the grid of control
/// ticks
[[nodiscard]] DOWNWASH_EXPORT Claims read_claims(const std::string& path, const Problem& problem);

/// The same of a plan in space.
struct SpaceClaims {
    CostFunction objective;
    std::uint64_t seed = 1;
    SpacePlan plan;
    std::optional<VisitOrder> order;    ///< as of Claims; also empty where the plan shows it
    std::vector<SpacePoint> waypoints;  ///< at rest
    bool has_waypoints = false;         ///< a plan written by hand need not have any
    std::optional<FlightClaims> flight;
    bool has_cost = false;  ///< whether the file says what the flight costs
};

/// Reads a solution file in space without comparing its parts. @throws ProblemFileError as above
[[nodiscard]] DOWNWASH_EXPORT SpaceClaims read_claims(const std::string& path, const SpaceProblem& problem);

}  // namespace downwash
