#include "downwash/judge/plan_judge.hpp"

#include <cstddef>
#include <utility>

#include "downwash/judge/flown_vehicle.hpp"
#include "downwash/judge/goals.hpp"
#include "downwash/judge/reference.hpp"
#include "downwash/judge/touching.hpp"

namespace downwash::judge {
namespace {

constexpr std::string_view outcome_names[] = {"ok",          "collision",  "unstable", "left_flyable_area",
                                              "goal_missed", "over_budget"};

/// The alternative at which a plan ends, if a touch follows there.
const Goal* touching_goal(const Goal& goal, const Plan& plan, const Problem& problem) {
    const ReferencePoint& last = plan.reference.back().point;
    const PlanarPose level{last.position[0], last.position[1], 0, last.position[2]};
    const Goal* nearest = nullptr;
    double least = 0;
    for (const Goal& each : goal.any_of) {
        const double share = goal_distance(each, problem.robot.arm, level).used_share;
        if (each.touch && (nearest == nullptr || share < least)) {
            nearest = &each;
            least = share;
        }
    }
    return nearest;
}

}  // namespace

std::string_view name_of(Outcome outcome) noexcept {
    return outcome_names[static_cast<std::size_t>(outcome)];
}

struct PlanJudge::Shared : Setting {
    using Setting::Setting;
};

PlanJudge::PlanJudge(const Problem& problem) : setting_(std::make_unique<const Shared>(problem)) {}
PlanJudge::~PlanJudge() = default;

const Problem& PlanJudge::problem() const noexcept {
    return setting_->problem;
}

JudgedFlight PlanJudge::fly(const Plan& plan, const FlightConditions& conditions) const {
    const Problem& problem = setting_->problem;
    FlownVehicle vehicle(*setting_, conditions);
    Loop& loop = vehicle.loop();
    Umpire& umpire = vehicle.umpire();
    Reference reference(plan);
    const std::vector<Goal> goals = goals_of(problem);
    const std::vector<std::int64_t> hovers = hover_ends(plan, goals, problem.robot.arm);
    const std::int64_t end = hovers.back();
    ReferencePoint now = reference.at(0);
    bool goes_on = umpire.sees(loop, now) && vehicle.has_begun();
    for (std::int64_t tick = 0; tick < end && goes_on; ++tick) {
        loop.next(tick, now);
        now = reference.at(tick + 1);
        goes_on = umpire.sees(loop, now);
    }
    std::vector<std::int64_t> ends = hovers;
    const Goal* const touching =
        goes_on && hovers.size() == goals.size() ? touching_goal(goals.back(), plan, problem) : nullptr;
    if (touching != nullptr) {
        const TouchSurface surface(*touching->touch, vehicle.world());
        const Plant touched = vehicle.touching(surface);
        loop.fly_with(touched);
        TouchCourse course = course_of(*touching->touch, problem.robot);
        std::int64_t tick = end;
        for (; goes_on && !course.is_over(); ++tick) {
            loop.next(tick, reference_of(course, *touching->touch, now), course.is_at_surface());
            course.next(loop.state().contact_n);
            goes_on = umpire.sees_touch(loop, reference_of(course, *touching->touch, now), surface);
        }
        umpire.sees_hold(*touching->touch, course.hold());
        umpire.sees_goals(goals, hovers);
        ends.back() = tick;  // back where it touched from
    }
    umpire.sees_goals(goals, ends);
    return std::move(vehicle.flight());
}

}  // namespace downwash::judge
