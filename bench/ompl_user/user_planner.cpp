#include "user_planner.hpp"

#include <ompl/base/ScopedState.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/control/ODESolver.h>
#include <ompl/control/planners/rrt/RRT.h>
#include <ompl/control/spaces/RealVectorControlSpace.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "plain_collisions.hpp"

namespace downwash::bench {
namespace {

namespace ob = ompl::base;
namespace oc = ompl::control;
using Ode = ClosedLoopOde;

constexpr double propagation_s = 0.1;
constexpr double integration_s = 0.01;
constexpr unsigned int most_steps = 20;

/// The numbers of a state, in the order of ClosedLoopOde.
double* numbers(ob::State* state) {
    return state->as<ob::RealVectorStateSpace::StateType>()->values;
}
const double* numbers(const ob::State* state) {
    return state->as<ob::RealVectorStateSpace::StateType>()->values;
}

/// Distances count place, arm and speed; what the controller remembers lies beside them with a weight of 0.
class UserSpace : public ob::RealVectorStateSpace {
 public:
    explicit UserSpace(double arm_weight_m)
        : ob::RealVectorStateSpace(static_cast<unsigned int>(Ode::size)), arm_weight_m_(arm_weight_m) {}

    double distance(const ob::State* first, const ob::State* second) const override {
        const double* a = first->as<StateType>()->values;
        const double* b = second->as<StateType>()->values;
        const double arm = arm_weight_m_ * (a[Ode::arm] - b[Ode::arm]);
        const double vx = speed_weight_s * (a[Ode::vx] - b[Ode::vx]);
        const double vz = speed_weight_s * (a[Ode::vz] - b[Ode::vz]);
        const double dx = a[Ode::x] - b[Ode::x];
        const double dz = a[Ode::z] - b[Ode::z];
        return std::sqrt(dx * dx + dz * dz + arm * arm + vx * vx + vz * vz);
    }

 private:
    static constexpr double speed_weight_s = 0.5;

    double arm_weight_m_;
};

/// What a state may be: within the bounds, flyable by the map, free of collision.
class Validity : public ob::StateValidityChecker {
 public:
    Validity(const ob::SpaceInformationPtr& information, const Problem& problem, const FlightModel& model,
             const AeroMap* map)
        : ob::StateValidityChecker(information), model_(model), map_(map), collisions_(problem) {}

    bool isValid(const ob::State* state) const override {
        const double* q = numbers(state);
        return si_->satisfiesBounds(state) && is_flyable(q) && collisions_.is_free(q);
    }

 private:
    [[nodiscard]] bool is_flyable(const double* q) const {
        const PlantModel& p = model_.tick().plant;
        for (int i = 0; map_ != nullptr && i < p.rotor_count; ++i) {
            const double hub_x = q[0] + std::cos(q[2]) * p.rotor_x_m[i] + std::sin(q[2]) * p.rotor_z_m[i];
            const double hub_z = q[1] - std::sin(q[2]) * p.rotor_x_m[i] + std::cos(q[2]) * p.rotor_z_m[i];
            if (!map_->is_flyable(model_.rotor_layer(i), hub_x, hub_z)) {
                return false;
            }
        }
        return true;
    }

    const FlightModel& model_;
    const AeroMap* map_;
    mutable PlainCollisions collisions_;
};

/// The tip within the goal's tolerance; samples by inverse kinematics.
class TipGoal : public ob::GoalSampleableRegion {
 public:
    TipGoal(const ob::SpaceInformationPtr& information, const Problem& problem)
        : ob::GoalSampleableRegion(information),
          goal_(problem.goal.end_effector.value()),
          length_m_(problem.robot.arm.length_m),
          joint_x_m_(problem.robot.arm.joint_x_m),
          joint_z_m_(problem.robot.arm.joint_z_m) {
        setThreshold(goal_.tolerance_m);
    }

    double distanceGoal(const ob::State* state) const override {
        const double* q = numbers(state);
        const double direction = q[Ode::pitch] + q[Ode::arm];
        const double joint_x = std::cos(q[Ode::pitch]) * joint_x_m_ + std::sin(q[Ode::pitch]) * joint_z_m_;
        const double joint_z = std::cos(q[Ode::pitch]) * joint_z_m_ - std::sin(q[Ode::pitch]) * joint_x_m_;
        return std::hypot(q[Ode::x] + joint_x + length_m_ * std::cos(direction) - goal_.x_m,
                          q[Ode::z] + joint_z - length_m_ * std::sin(direction) - goal_.z_m);
    }
    void sampleGoal(ob::State* state) const override {
        const double arm = random_.uniformReal(-std::numbers::pi, std::numbers::pi);
        const std::vector<double> sample = Ode::resting_at(goal_.x_m - joint_x_m_ - length_m_ * std::cos(arm),
                                                           goal_.z_m - joint_z_m_ + length_m_ * std::sin(arm), arm);
        std::copy(sample.begin(), sample.end(), numbers(state));
    }
    unsigned int maxSampleCount() const override { return std::numeric_limits<unsigned int>::max(); }

 private:
    EndEffectorGoal goal_;
    double length_m_, joint_x_m_, joint_z_m_;
    mutable ompl::RNG random_;
};

ob::StateSpacePtr make_states(const Problem& problem) {
    // Bounds of what the controller remembers matter to samples only, and there to nothing.
    constexpr double unbounded = 1e9;
    constexpr double greatest_pitch_rad = 1.3;
    ob::RealVectorBounds bounds(static_cast<unsigned int>(Ode::size));
    bounds.setLow(-unbounded);
    bounds.setHigh(unbounded);
    const auto set = [&bounds](Ode::Index index, double low, double high) {
        bounds.setLow(static_cast<unsigned int>(index), low);
        bounds.setHigh(static_cast<unsigned int>(index), high);
    };
    const ArmParameters& arm = problem.robot.arm;
    set(Ode::x, problem.bounds.x_low_m, problem.bounds.x_high_m);
    set(Ode::z, problem.bounds.z_low_m, problem.bounds.z_high_m);
    set(Ode::pitch, -greatest_pitch_rad, greatest_pitch_rad);
    set(Ode::arm, arm.is_limited ? arm.lower_limit_rad : -std::numbers::pi,
        arm.is_limited ? arm.upper_limit_rad : std::numbers::pi);
    set(Ode::vx, -2 * problem.motion.max_speed_m_s, 2 * problem.motion.max_speed_m_s);
    set(Ode::vz, -2 * problem.motion.max_speed_m_s, 2 * problem.motion.max_speed_m_s);
    const auto states = std::make_shared<UserSpace>(0.5 * arm.length_m);
    states->setBounds(bounds);
    return states;
}

oc::ControlSpacePtr make_controls(const ob::StateSpacePtr& states, const Problem& problem) {
    const auto controls = std::make_shared<oc::RealVectorControlSpace>(states, 3);
    ob::RealVectorBounds bounds(3);
    const double most[3] = {problem.motion.max_speed_m_s, problem.motion.max_speed_m_s,
                            problem.motion.max_arm_rate_rad_s};
    for (unsigned int i = 0; i < 3; ++i) {
        bounds.setLow(i, -most[i]);
        bounds.setHigh(i, most[i]);
    }
    controls->setBounds(bounds);
    return controls;
}

}  // namespace

struct UserPlanner::Impl {
    Impl(const Problem& problem, const FlightModel& model, const AeroMap* map) : ode(model, map) {
        const ob::StateSpacePtr states = make_states(problem);
        information = std::make_shared<oc::SpaceInformation>(states, make_controls(states, problem));
        states->setup();  // ODESolver reads from a space that is set up
        const auto solver = std::make_shared<oc::ODEBasicSolver<>>(
            information,
            [this](const std::vector<double>& state, const oc::Control* control, std::vector<double>& rates) {
                ode(state, control->as<oc::RealVectorControlSpace::ControlType>()->values, rates);
            },
            integration_s);
        information->setStatePropagator(oc::ODESolver::getStatePropagator(solver));
        information->setStateValidityChecker(std::make_shared<Validity>(information, problem, model, map));
        information->setPropagationStepSize(propagation_s);
        information->setMinMaxControlDuration(1, most_steps);
        information->setup();
        goal = std::make_shared<TipGoal>(information, problem);
        start = Ode::resting_at(problem.start.x_m, problem.start.z_m, problem.start.arm_rad);
    }

    ClosedLoopOde ode;
    oc::SpaceInformationPtr information;
    ob::GoalPtr goal;
    std::vector<double> start;
};

UserPlanner::UserPlanner(const Problem& problem, const FlightModel& model, const AeroMap* map)
    : impl_(std::make_unique<Impl>(problem, model, map)) {}

UserPlanner::~UserPlanner() = default;

const oc::SpaceInformationPtr& UserPlanner::information() const {
    return impl_->information;
}

std::optional<double> UserPlanner::time_to_first_solution_s(double limit_s) const {
    const auto definition = std::make_shared<ob::ProblemDefinition>(impl_->information);
    ob::ScopedState<> start(impl_->information);
    std::copy(impl_->start.begin(), impl_->start.end(), numbers(start.get()));
    definition->addStartState(start);
    definition->setGoal(impl_->goal);
    oc::RRT planner(impl_->information);
    planner.setProblemDefinition(definition);
    planner.setup();
    const auto begin = std::chrono::steady_clock::now();
    const ob::PlannerStatus status = planner.solve(ob::timedPlannerTerminationCondition(limit_s));
    const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return status == ob::PlannerStatus::EXACT_SOLUTION ? std::optional(wall_s) : std::nullopt;
}

}  // namespace downwash::bench
