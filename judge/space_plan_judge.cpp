#include "downwash/judge/space_plan_judge.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/parallel.hpp"
#include "downwash/judge/space_judge.hpp"
#include "downwash/simulation/space_world_parameters.hpp"

namespace downwash::judge {
namespace {

SpaceJudgedMotion motion_of(const SpaceStart& start) {
    SpaceJudgedMotion motion;
    motion.position_m = start.position_m;
    motion.attitude =
        start.attitude.value_or(std::array{std::cos(start.yaw_rad / 2), 0.0, 0.0, std::sin(start.yaw_rad / 2)});
    std::copy(start.joints_rad.begin(), start.joints_rad.end(), motion.joints_rad.begin());
    motion.velocity_m_s = start.velocity_m_s;
    motion.body_rates_rad_s = start.body_rates_rad_s;
    std::copy(start.joint_rates_rad_s.begin(), start.joint_rates_rad_s.end(), motion.joint_rates_rad_s.begin());
    return motion;
}

std::vector<DrawnValues> drawn_in(const std::vector<SpaceWorld>& worlds, const SpaceRobot& robot) {
    std::vector<DrawnValues> drawn;
    for (const SpaceWorldParameter* parameter : space_world_parameters_of(robot)) {
        DrawnValues& values = drawn.emplace_back(DrawnValues{parameter->name, {}});
        for (const SpaceWorld& world : worlds) {
            values.of_world.push_back(parameter->of(world));
        }
    }
    return drawn;
}

}  // namespace

struct SpacePlanJudge::Shared {
    SpaceProblem problem;
    SpaceJudge judge;
};

SpacePlanJudge::SpacePlanJudge(const SpaceProblem& problem)
    : shared_(new Shared{problem, {problem.robot, problem.obstacles, problem.aero}}) {}

SpacePlanJudge::~SpacePlanJudge() = default;

const SpaceProblem& SpacePlanJudge::problem() const noexcept {
    return shared_->problem;
}

SpaceJudgedFlight SpacePlanJudge::fly(const SpacePlan& plan, bool aero, const std::optional<SpaceWorld>& world) const {
    SpaceFlightConditions conditions;
    conditions.start = motion_of(problem().start);
    conditions.rotor_thrust_n = problem().start.carry.rotor_thrust_n;
    conditions.controller_memory = problem().start.carry.controller_memory;
    conditions.goals = goals_of(problem());
    conditions.in_any_order = leaves_order_open(problem());
    conditions.energy_budget_j = problem().energy_budget_j;
    conditions.aero = aero;
    conditions.world = world;
    return shared_->judge.fly(plan, conditions);
}

std::optional<WorldRuns> fly_in_worlds(const SpacePlanJudge& judge, const SpacePlan& plan,
                                       const WorldRunOptions& options) {
    const SpaceProblem& problem = judge.problem();
    std::vector<SpaceWorld> worlds;
    for (std::uint64_t i = 1; i <= options.runs; ++i) {
        worlds.push_back(draw_space_world(*problem.uncertainty, problem.robot, options.seed, i));
    }
    std::vector<WorldRun> runs(worlds.size());
    run_parallel(
        worlds.size(), options.threads,
        [&](std::size_t i) {
            if (options.stop.stop_requested()) {
                return;
            }
            const SpaceJudgedFlight flight = judge.fly(plan, true, worlds[i]);
            runs[i] = {i + 1,           flight.outcome, flight.min_clearance_m, flight.max_tracking_error_m,
                       flight.energy_j, false};
        },
        options.on_progress);
    if (options.stop.stop_requested()) {
        return std::nullopt;
    }
    return statistics_of(std::move(runs), drawn_in(worlds, problem.robot));
}

}  // namespace downwash::judge
