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
    const std::vector<Goal> goals = goals_of(problem);
    const std::vector<std::int64_t> hovers = hover_ends(plan, goals, problem.robot.arm);
    std::vector<Umpire::Stay> stays(goals.size());
    Reference reference(plan);
    ReferencePoint now = reference.at(0);
    bool goes_on = umpire.sees(loop, now) && vehicle.has_begun();
    std::size_t goal = 0;    // that the vehicle is on the way to
    std::int64_t flown = 0;  // ticks, touches included
    for (std::int64_t tick = 0; tick < hovers.back() && goes_on; ++tick) {
        loop.next(flown++, now);
        now = reference.at(tick + 1);
        goes_on = umpire.sees(loop, now);
        if (tick + 1 != hovers[goal]) {
            continue;
        }
        Umpire::Stay& stay = stays[goal];
        if (const auto row = static_cast<std::size_t>(flown); row < vehicle.flight().rows.size()) {
            stay.row = row;
        }
        const bool is_end = goal + 1 == hovers.size() && hovers.size() < goals.size();  // no hover at a goal
        const PlanarPose pose{now.position[0], now.position[1], 0, now.position[2]};
        const Touch* const touch = goes_on && !is_end ? touch_after(goals[goal], problem.robot.arm, pose) : nullptr;
        ++goal;
        if (touch == nullptr) {
            continue;
        }
        const TouchSurface surface(*touch, vehicle.world());
        const Plant touched = vehicle.touching(surface);
        const Plant& free = loop.plant();
        loop.fly_with(touched);
        TouchCourse course = course_of(*touch, problem.robot);
        while (goes_on && !course.is_over()) {
            loop.next(flown++, reference_of(course, *touch, now), course.is_at_surface());
            course.next(loop.state().contact_n);
            goes_on = umpire.sees_touch(loop, reference_of(course, *touch, now), surface);
        }
        loop.fly_with(free);
        stay.touch_force_n = umpire.sees_hold(*touch, course.hold());
        stay.row_after = vehicle.flight().rows.size() - 1;  // back where it touched from
        goes_on = vehicle.flight().outcome == Outcome::ok;
        stay.is_touch_met = goes_on;
    }
    umpire.sees_goals(goals, stays);
    return std::move(vehicle.flight());
}

}  // namespace downwash::judge
