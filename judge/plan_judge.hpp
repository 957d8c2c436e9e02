#pragma once

#include <memory>

#include "downwash/base/export.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/judge/judged_flight.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash::judge {

/// Flies plans of a problem and says how they end. It shares parameters, shapes and the formulas of surface effects
/// with the planner, and nothing that computes a flight (judge/README.md). Safe to share between threads.
class DOWNWASH_EXPORT PlanJudge {
 public:
    /// @pre problem_errors(problem) is empty
    explicit PlanJudge(const Problem& problem);
    ~PlanJudge();
    PlanJudge(const PlanJudge&) = delete;
    PlanJudge& operator=(const PlanJudge&) = delete;

    [[nodiscard]] const Problem& problem() const noexcept;

    /// @pre the plan has a knot, the first at tick 0
    [[nodiscard]] JudgedFlight fly(const Plan& plan, const FlightConditions& conditions) const;

 private:
    struct Shared;
    std::unique_ptr<const Shared> setting_;
};

}  // namespace downwash::judge
