#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/problems/visit_order.hpp"
#include "downwash/search/family.hpp"

namespace downwash {

/// A moment of a plan from which another plan takes over.
template <class Family>
struct TakeoverOf {
    using Start = typename Family::Start;
    using Plan = typename Family::Plan;
    using Goal = typename Family::Goal;

    std::int64_t tick = 0;      ///< of the plan
    Start start;                ///< vehicle at that moment, with its reference, rotors and controller
    double energy_j = 0;        ///< spent until then
    Plan rest;                  ///< what is left of the plan, from that moment on
    std::vector<Goal> visited;  ///< goals whose hovers are over, in the order of the visits
    std::vector<Goal> left;     ///< the other goals of the plan
};
using Takeover = TakeoverOf<planning::Plane>;

/// The vehicle at a moment of a plan: in the nominal world, with surface effects evaluated directly.
/// @param flown the problem that the plan is for   @param order in which it visits targets, if there are any
/// @param tick of the plan, at least 0; after its end the vehicle hovers there
/// @throws InputError where the flight ends before that moment
[[nodiscard]] DOWNWASH_EXPORT Takeover take_over(const Problem& flown, const Plan& plan,
                                                 const std::optional<VisitOrder>& order, std::int64_t tick);
[[nodiscard]] DOWNWASH_EXPORT TakeoverOf<planning::Space> take_over(const SpaceProblem& flown, const SpacePlan& plan,
                                                                    const std::optional<VisitOrder>& order,
                                                                    std::int64_t tick);

/// What is left of a problem from a moment of a plan on: it starts there, the goals that were visited need no further
/// visit, and the energy that was spent is no longer in the budget. The goals are those of `changed`, which may be
/// others than those of the plan.
/// @throws InputError where no goal or no energy is left, or the controller has another rate
[[nodiscard]] DOWNWASH_EXPORT Problem remaining(const Takeover& from, Problem changed);
[[nodiscard]] DOWNWASH_EXPORT SpaceProblem remaining(const TakeoverOf<planning::Space>& from, SpaceProblem changed);

/// How long a plan's reference is that of another one, to the last bit, from the beginning of both [s].
[[nodiscard]] DOWNWASH_EXPORT double same_reference_s(const Plan& plan, const Plan& other);
[[nodiscard]] DOWNWASH_EXPORT double same_reference_s(const SpacePlan& plan, const SpacePlan& other);

}  // namespace downwash
