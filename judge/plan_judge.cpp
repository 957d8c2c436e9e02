#include "downwash/judge/plan_judge.hpp"

#include <cmath>
#include <cstddef>

#include "downwash/judge/goals.hpp"
#include "downwash/judge/loop.hpp"
#include "downwash/judge/obstacles.hpp"
#include "downwash/judge/reference.hpp"
#include "downwash/judge/touching.hpp"
#include "downwash/judge/umpire.hpp"
#include "downwash/problems/problem_model.hpp"

namespace downwash::judge {
namespace {

constexpr std::string_view outcome_names[] = {"ok",          "collision",  "unstable", "left_flyable_area",
                                              "goal_missed", "over_budget"};

/// Of a vehicle in a world, docs/model.md 9.
constexpr double hover_before_start_s = 20;

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

/// What all flights share.
struct PlanJudge::Setting {
    Problem problem;
    SurfaceEffects effects;
    Obstacles obstacles;
    ControlLaw law;

    explicit Setting(const Problem& of)
        : problem(of), obstacles(of.obstacles, of.plane, of.robot.shape(), of.robot.rotors.radius_m), law(of.robot) {
        if (of.aero.enabled) {
            effects.all = make_flight_model(of);
            effects.has_fountain = !of.aero.map && of.aero.ground.model == EffectModel::multirotor_body;
            effects.wall_force = of.aero.wall.force;
            effects.wall_moment_m = of.aero.wall.moment * of.robot.rotors.radius_m;
            if (!of.aero.map) {
                effects.ground_tilt_loss = of.aero.tilt_loss.ground;
                effects.ceiling_tilt_loss = of.aero.tilt_loss.ceiling;
            }
        }
    }
};

PlanJudge::PlanJudge(const Problem& problem) : setting_(std::make_unique<const Setting>(problem)) {}
PlanJudge::~PlanJudge() = default;

const Problem& PlanJudge::problem() const noexcept {
    return setting_->problem;
}

JudgedFlight PlanJudge::fly(const Plan& plan, const FlightConditions& conditions) const {
    const Setting& setting = *setting_;
    const Problem& problem = setting.problem;
    const World world = conditions.world.value_or(World{});
    const SurfaceEffects* effects = conditions.aero && problem.aero.enabled ? &setting.effects : nullptr;
    const Vehicle vehicle = vehicle_in(world, problem.robot);
    const Surroundings surroundings(effects, world);
    const World nominal;
    const Surroundings believed(effects, nominal);
    const Plant plant(vehicle, surroundings);
    PlantState state = start_of(problem.start, setting.law, vehicle);
    ControlMemory memory = problem.start.controller_memory.empty()
                               ? setting.law.memory_at_start(motion_of(problem.start))
                               : setting.law.memory_of(problem.start.controller_memory);
    JudgedFlight flight;

    // In a world a vehicle at rest has hovered at its start, in calm air and with quiet sensors.
    if (conditions.world && is_at_rest(problem.start)) {
        const World quiet = without_noise(world);
        const ReferencePoint here = at_rest(problem.start.configuration());
        Loop hover(setting.law, believed, plant, quiet, problem.robot, state, memory);
        const std::int64_t ticks = std::llround(hover_before_start_s / setting.law.tick_s());
        for (std::int64_t tick = 0; tick < ticks; ++tick) {
            hover.next(tick, here);
            if (!is_stable(hover.motion(), here)) {
                flight.outcome = Outcome::unstable;
                break;
            }
        }
        if (flight.outcome == Outcome::ok) {
            state = hover.state();
            state.energy_j = 0;
            memory = hover.memory();
        }
    }

    Loop loop(setting.law, believed, plant, world, problem.robot, state, memory);
    Umpire umpire(problem, effects, setting.obstacles, world, flight);
    Reference reference(plan);
    const std::vector<Goal> goals = goals_of(problem);
    const std::vector<std::int64_t> hovers = hover_ends(plan, goals, problem.robot.arm);
    const std::int64_t end = hovers.back();
    ReferencePoint now = reference.at(0);
    bool goes_on = flight.outcome == Outcome::ok;
    goes_on = umpire.sees(loop, now) && goes_on;
    for (std::int64_t tick = 0; tick < end && goes_on; ++tick) {
        loop.next(tick, now);
        now = reference.at(tick + 1);
        goes_on = umpire.sees(loop, now);
    }
    std::vector<std::int64_t> ends = hovers;
    const Goal* const touching =
        goes_on && hovers.size() == goals.size() ? touching_goal(goals.back(), plan, problem) : nullptr;
    if (touching != nullptr) {
        const TouchSurface surface(*touching->touch, world);
        const Plant touched(vehicle, surroundings, &surface);
        loop.fly_with(touched);
        TouchCourse course(*touching->touch, now, problem.robot);
        std::int64_t tick = end;
        for (; goes_on && !course.is_over(); ++tick) {
            loop.next(tick, course.reference());
            course.next(loop.state().contact_n);
            goes_on = umpire.sees_touch(loop, course.reference(), surface);
        }
        umpire.sees_hold(*touching->touch, course.hold());
        umpire.sees_goals(goals, hovers);
        ends.back() = tick;  // back where it touched from
    }
    umpire.sees_goals(goals, ends);
    return flight;
}

}  // namespace downwash::judge
