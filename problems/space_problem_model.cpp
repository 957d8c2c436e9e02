#include "downwash/problems/space_problem_model.hpp"

#include <algorithm>
#include <utility>

#include "downwash/base/lane_math.hpp"
#include "downwash/simulation/space_effect.hpp"

namespace downwash {
namespace {

bool is_zero(const std::vector<double>& rates) {
    return std::ranges::all_of(rates, [](double rate) { return rate == 0; });
}

}  // namespace

SpaceMotion start_motion(const SpaceStart& start) noexcept {
    SpaceMotion motion;
    motion.position_m = start.position_m;
    if (start.attitude) {
        motion.attitude = normalised(*start.attitude);
    } else {
        const lane::SinCos half = lane::sin_cos(0.5 * start.yaw_rad);
        motion.attitude = {half.cosine, 0, 0, half.sine};
    }
    std::copy(start.joints_rad.begin(), start.joints_rad.end(), motion.joints_rad.begin());
    motion.velocity_m_s = start.velocity_m_s;
    motion.body_rates_rad_s = start.body_rates_rad_s;
    std::copy(start.joint_rates_rad_s.begin(), start.joint_rates_rad_s.end(), motion.joint_rates_rad_s.begin());
    return motion;
}

bool is_at_rest(const SpaceStart& start) noexcept {
    const bool is_level = !start.attitude || ((*start.attitude)[1] == 0 && (*start.attitude)[2] == 0);
    return is_level && start.velocity_m_s == Vector3{} && start.body_rates_rad_s == Vector3{} &&
           is_zero(start.joint_rates_rad_s);
}

SpaceProblemModel::SpaceProblemModel(SpaceProblem problem)
    : problem_(std::move(problem)),
      scene_(std::make_shared<const Scene>(problem_.obstacles)),
      checker_(scene_, shape_of(problem_.robot), problem_.planner.collision_checker),
      goals_(problem_.robot, scene_, goals_of(problem_), leaves_order_open(problem_)) {}

SpaceFlight SpaceProblemModel::execute(const SpacePlan& plan, const SpaceExecutionSettings& settings) const {
    const SpaceRobot& robot = problem_.robot;
    std::optional<simulation::DirectSpaceEffect> effect;
    SpaceFlightSettings flight;
    if (settings.aero && problem_.aero.enabled) {
        flight.effect = &effect.emplace(scene_, problem_.aero, robot);
        flight.aero = simulation::space_aero(problem_.aero, robot.rotor_radius_m);
    }
    flight.checker = &checker_;
    flight.world = settings.world.value_or(SpaceWorld{});
    flight.settles = settings.world.has_value() && !settings.start && is_at_rest(problem_.start);
    flight.goals = settings.goals != nullptr ? settings.goals : &goals_;
    flight.is_over = settings.is_over;
    flight.energy_budget_j = problem_.energy_budget_j;
    return fly(robot, plan, settings.start.value_or(start_motion(problem_.start)), flight);
}

}  // namespace downwash
