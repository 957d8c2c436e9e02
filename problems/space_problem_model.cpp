#include "downwash/problems/space_problem_model.hpp"

#include <algorithm>
#include <utility>

#include "downwash/base/lane_math.hpp"
#include "downwash/simulation/space_effect.hpp"
#include "downwash/simulation/space_place.hpp"
#include "downwash/simulation/space_pool.hpp"

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
    const bool is_in_flight =
        start.reference || !start.carry.rotor_thrust_n.empty() || !start.carry.controller_memory.empty();
    return is_level && !is_in_flight && start.velocity_m_s == Vector3{} && start.body_rates_rad_s == Vector3{} &&
           is_zero(start.joint_rates_rad_s);
}

SpacePoint reference_at(const SpaceStart& start) noexcept {
    SpacePoint point;
    if (start.reference) {
        std::ranges::copy(start.reference->position, point.position);
        std::ranges::copy(start.reference->velocity, point.velocity);
        std::ranges::copy(start.reference->acceleration, point.acceleration);
        return point;
    }
    const SpaceMotion motion = start_motion(start);
    point = at_rest(configuration_of(motion));
    if (!start.attitude) {
        point.position[space::yaw] = start.yaw_rad;
    }
    std::ranges::copy(motion.velocity_m_s, point.velocity);
    std::ranges::copy(motion.joint_rates_rad_s, point.velocity + space::first_joint);
    return point;
}

AnySpaceState start_state(const SpaceProblemModel& model, const SpaceStart& start) {
    return SpacePool(SpacePoolSetup{model.problem().robot}).state_at(start_motion(start), nullptr, start.carry);
}

SpaceStart start_of(const SpaceProblemModel& model, const AnySpaceState& state, const SpacePoint& reference) {
    const SpaceRobot& robot = model.problem().robot;
    const SpaceMotion motion = motion_of(state);
    const auto first = [](const auto& numbers, int count) {
        return std::vector<double>(std::begin(numbers), std::begin(numbers) + count);
    };
    const int joints = robot.joints(), axes = space::first_joint + joints;
    SpaceStart start;
    start.position_m = motion.position_m;
    start.yaw_rad = yaw_of(motion.attitude);
    start.joints_rad = first(motion.joints_rad, joints);
    start.velocity_m_s = motion.velocity_m_s;
    start.attitude = motion.attitude;
    start.body_rates_rad_s = motion.body_rates_rad_s;
    start.joint_rates_rad_s = first(motion.joint_rates_rad_s, joints);
    start.reference = SpaceStart::Reference{first(reference.position, axes), first(reference.velocity, axes),
                                            first(reference.acceleration, axes)};
    start.carry = carry_of(robot, state);
    return start;
}

SpaceProblemModel::SpaceProblemModel(SpaceProblem problem, const SpaceProblemModel& other)
    : problem_(std::move(problem)),
      scene_(other.scene_),
      checker_(other.checker_),
      goals_(problem_.robot, scene_, goals_of(problem_), leaves_order_open(problem_)) {}

SpaceProblemModel::SpaceProblemModel(SpaceProblem problem)
    : problem_(std::move(problem)),
      scene_(std::make_shared<const Scene>(problem_.obstacles)),
      checker_(scene_, shape_of(problem_.robot), problem_.planner.collision_checker),
      goals_(problem_.robot, scene_, goals_of(problem_), leaves_order_open(problem_)) {}

SpaceFlight SpaceProblemModel::execute(const SpacePlan& plan, const SpaceExecutionSettings& settings) const {
    return fly(plan, settings, settings.goals != nullptr ? settings.goals : &goals_);
}

SpaceFlight SpaceProblemModel::execute_part(const SpacePlan& plan) const {
    return fly(plan, {}, nullptr);
}

SpaceFlight SpaceProblemModel::fly(const SpacePlan& plan, const SpaceExecutionSettings& settings,
                                   const SpaceGoalRule* goals) const {
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
    flight.goals = goals;
    flight.measures_clearance = settings.measures_clearance;
    flight.is_over = settings.is_over;
    flight.energy_budget_j = problem_.energy_budget_j;
    flight.carry = settings.start ? carry_of(robot, *settings.start) : problem_.start.carry;
    return downwash::fly(robot, plan, settings.start ? motion_of(*settings.start) : start_motion(problem_.start),
                         flight);
}

}  // namespace downwash
