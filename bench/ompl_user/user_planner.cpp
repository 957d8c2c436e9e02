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
#include <utility>
#include <vector>

#include "downwash/simulation/execution.hpp"
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

/// One particle after the other. Distances count place, arm and speed of the first; what the controller remembers lies
/// beside them with a weight of 0.
class UserSpace : public ob::RealVectorStateSpace {
 public:
    UserSpace(double arm_weight_m, std::size_t particles)
        : ob::RealVectorStateSpace(static_cast<unsigned int>(Ode::size * particles)), arm_weight_m_(arm_weight_m) {}

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

/// What a state may be: every particle within the bounds, flyable by the map, free of collision, where its world has
/// the scene.
class Validity : public ob::StateValidityChecker {
 public:
    /// @param worlds of the particles; empty: one in the nominal world. They outlive this object
    Validity(const ob::SpaceInformationPtr& information, const Problem& problem, const FlightModel& model,
             const AeroMap* map, const std::vector<FlownWorld>& worlds)
        : ob::StateValidityChecker(information), model_(model), map_(map), worlds_(worlds), collisions_(problem) {}

    bool isValid(const ob::State* state) const override {
        const double* all = numbers(state);
        if (!si_->satisfiesBounds(state)) {
            return false;
        }
        if (worlds_.empty()) {
            return is_flyable(all) && collisions_.is_free(all);
        }
        for (std::size_t i = 0; i < worlds_.size(); ++i) {
            const World& world = worlds_[i].world;
            const double* q = all + i * Ode::size;
            const double seen[4] = {q[0] - world.scene_x_m, q[1] - world.scene_z_m, q[2], q[3]};
            if (!is_flyable(seen) || !collisions_.is_free(seen)) {
                return false;
            }
        }
        return true;
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
    const std::vector<FlownWorld>& worlds_;
    mutable PlainCollisions collisions_;
};

/// The tip of every particle within the goal's tolerance; samples by inverse kinematics.
class TipGoal : public ob::GoalSampleableRegion {
 public:
    TipGoal(const ob::SpaceInformationPtr& information, const Problem& problem, std::size_t particles)
        : ob::GoalSampleableRegion(information),
          particles_(particles),
          goal_(std::get<EndEffectorGoal>(problem.goal.kind)),
          length_m_(problem.robot.arm.length_m),
          joint_x_m_(problem.robot.arm.joint_x_m),
          joint_z_m_(problem.robot.arm.joint_z_m) {
        setThreshold(goal_.tolerance_m);
    }

    double distanceGoal(const ob::State* state) const override {
        double worst_m = 0;
        for (std::size_t i = 0; i < particles_; ++i) {
            worst_m = std::max(worst_m, distance_of(numbers(state) + i * Ode::size));
        }
        return worst_m;
    }
    void sampleGoal(ob::State* state) const override {
        const double arm = random_.uniformReal(-std::numbers::pi, std::numbers::pi);
        const std::vector<double> sample = Ode::resting_at(goal_.x_m - joint_x_m_ - length_m_ * std::cos(arm),
                                                           goal_.z_m - joint_z_m_ + length_m_ * std::sin(arm), arm);
        for (std::size_t i = 0; i < particles_; ++i) {
            std::copy(sample.begin(), sample.end(), numbers(state) + i * Ode::size);
        }
    }
    unsigned int maxSampleCount() const override { return std::numeric_limits<unsigned int>::max(); }

 private:
    [[nodiscard]] double distance_of(const double* q) const {
        const double direction = q[Ode::pitch] + q[Ode::arm];
        const double joint_x = std::cos(q[Ode::pitch]) * joint_x_m_ + std::sin(q[Ode::pitch]) * joint_z_m_;
        const double joint_z = std::cos(q[Ode::pitch]) * joint_z_m_ - std::sin(q[Ode::pitch]) * joint_x_m_;
        return std::hypot(q[Ode::x] + joint_x + length_m_ * std::cos(direction) - goal_.x_m,
                          q[Ode::z] + joint_z - length_m_ * std::sin(direction) - goal_.z_m);
    }

    std::size_t particles_;
    EndEffectorGoal goal_;
    double length_m_, joint_x_m_, joint_z_m_;
    mutable ompl::RNG random_;
};

ob::StateSpacePtr make_states(const Problem& problem, std::size_t particles) {
    // Bounds of what the controller remembers matter to samples only, and there to nothing.
    constexpr double unbounded = 1e9;
    constexpr double greatest_pitch_rad = 1.3;
    ob::RealVectorBounds bounds(static_cast<unsigned int>(Ode::size * particles));
    bounds.setLow(-unbounded);
    bounds.setHigh(unbounded);
    const auto set = [&](Ode::Index index, double low, double high) {
        for (std::size_t i = 0; i < particles; ++i) {
            bounds.setLow(static_cast<unsigned int>(i * Ode::size + index), low);
            bounds.setHigh(static_cast<unsigned int>(i * Ode::size + index), high);
        }
    };
    const ArmParameters& arm = problem.robot.arm;
    set(Ode::x, problem.bounds.x_low_m, problem.bounds.x_high_m);
    set(Ode::z, problem.bounds.z_low_m, problem.bounds.z_high_m);
    set(Ode::pitch, -greatest_pitch_rad, greatest_pitch_rad);
    set(Ode::arm, arm.is_limited ? arm.lower_limit_rad : -std::numbers::pi,
        arm.is_limited ? arm.upper_limit_rad : std::numbers::pi);
    set(Ode::vx, -2 * problem.motion.max_speed_m_s, 2 * problem.motion.max_speed_m_s);
    set(Ode::vz, -2 * problem.motion.max_speed_m_s, 2 * problem.motion.max_speed_m_s);
    const auto states = std::make_shared<UserSpace>(0.5 * arm.length_m, particles);
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
    Impl(const Problem& problem, const FlightModel& model, const AeroMap* map, std::vector<FlownWorld> of_particles)
        : worlds(std::move(of_particles)) {
        for (const FlownWorld& world : worlds) {
            odes.emplace_back(model, map, &world);
        }
        if (worlds.empty()) {
            odes.emplace_back(model, map);
        }
        const ob::StateSpacePtr states = make_states(problem, odes.size());
        information = std::make_shared<oc::SpaceInformation>(states, make_controls(states, problem));
        states->setup();  // ODESolver reads from a space that is set up
        const auto solver = std::make_shared<oc::ODEBasicSolver<>>(
            information,
            [this](const std::vector<double>& state, const oc::Control* control, std::vector<double>& rates) {
                const double* velocity = control->as<oc::RealVectorControlSpace::ControlType>()->values;
                rates.resize(state.size());
                for (std::size_t i = 0; i < odes.size(); ++i) {
                    odes[i](&state[i * Ode::size], velocity, &rates[i * Ode::size]);
                }
            },
            integration_s);
        information->setStatePropagator(oc::ODESolver::getStatePropagator(solver));
        information->setStateValidityChecker(std::make_shared<Validity>(information, problem, model, map, worlds));
        information->setPropagationStepSize(propagation_s);
        information->setMinMaxControlDuration(1, most_steps);
        information->setup();
        goal = std::make_shared<TipGoal>(information, problem, odes.size());
        for (const ClosedLoopOde& ode : odes) {
            std::vector<double> at =
                Ode::resting_at(problem.start.at[plane::x], problem.start.at[plane::z], problem.start.at[plane::arm]);
            if (!worlds.empty()) {
                at = ode.hovered(std::move(at), settling_before_start_s);
            }
            start.insert(start.end(), at.begin(), at.end());
        }
    }

    std::vector<FlownWorld> worlds;
    std::vector<ClosedLoopOde> odes;  ///< the equations of each particle
    oc::SpaceInformationPtr information;
    ob::GoalPtr goal;
    std::vector<double> start;
};

UserPlanner::UserPlanner(const Problem& problem, const FlightModel& model, const AeroMap* map,
                         std::vector<FlownWorld> worlds)
    : impl_(std::make_unique<Impl>(problem, model, map, std::move(worlds))) {}

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
