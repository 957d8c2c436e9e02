// OMPL's own kinodynamic planners on vehicles in space, as a user sets them up who writes down the equations of motion
// for ODESolver: the right-hand side is that of our plant, without surfaces, lag or drag; the controls are the lift,
// three torques and the torques of the joints, held for 0.1 to 1 s. The goal need not be held, and rotors need not be
// able to give the torques: both make it easier than ours. A line of JSON for each run; limits are processor time.

#include <fmt/core.h>
#include <ompl/base/ProjectionEvaluator.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SO3StateSpace.h>
#include <ompl/control/ODESolver.h>
#include <ompl/control/PathControl.h>
#include <ompl/control/planners/kpiece/KPIECE1.h>
#include <ompl/control/planners/rrt/RRT.h>
#include <ompl/control/planners/sst/SST.h>
#include <ompl/control/spaces/RealVectorControlSpace.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "../support/measuring.hpp"
#include "downwash/base/random.hpp"
#include "downwash/dynamics/space_step.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/simulation/space_goal_sampler.hpp"
#include "downwash/simulation/space_place.hpp"

using namespace downwash;
namespace ob = ompl::base;
namespace oc = ompl::control;

namespace {

constexpr double integration_s = 0.01;
constexpr double propagation_s = 0.02;
constexpr unsigned int min_steps = 5, max_steps = 50;
constexpr double goal_bias = 0.1;
/// Weights of place, attitude (half the angle), velocity, body rates, joints and their rates: dynobench's, and alike.
constexpr double weights[] = {1, 0.5, 0.1, 0.05, 0.5, 0.05};

struct Options {
    std::string problem, planner;
    std::uint32_t seeds = 3;
    double time_limit_s = 60;
    double goal_error = 0.03;  ///< dynobench's distance that counts as the goal where it is a configuration
    double max_speed_m_s = 4, max_rate_rad_s = 8, max_joint_rate_rad_s = 3;
    double turn_rad_s2 = 5;    ///< spread of the angular acceleration that a torque gives
    double joint_share = 0.2;  ///< spread of the torque of a joint, over its greatest
};

/// Where the parts of a state are in the compound state.
enum Part : unsigned int { place, attitude, velocity, rates, joints, joint_rates };

using Real = ob::RealVectorStateSpace::StateType;
using Turn = ob::SO3StateSpace::StateType;

SpaceMotion motion_of(const ob::State* state, int n) {
    const auto* all = state->as<ob::CompoundState>();
    const auto* turn = all->as<Turn>(attitude);
    SpaceMotion motion;
    std::copy_n(all->as<Real>(place)->values, 3, motion.position_m.begin());
    motion.attitude = {turn->w, turn->x, turn->y, turn->z};
    std::copy_n(all->as<Real>(velocity)->values, 3, motion.velocity_m_s.begin());
    std::copy_n(all->as<Real>(rates)->values, 3, motion.body_rates_rad_s.begin());
    if (n > 0) {
        std::copy_n(all->as<Real>(joints)->values, n, motion.joints_rad.begin());
        std::copy_n(all->as<Real>(joint_rates)->values, n, motion.joint_rates_rad_s.begin());
    }
    return motion;
}

void write(const SpaceMotion& motion, int n, ob::State* state) {
    auto* all = state->as<ob::CompoundState>();
    auto* turn = all->as<Turn>(attitude);
    std::copy_n(motion.position_m.begin(), 3, all->as<Real>(place)->values);
    const std::array<double, 4> q = normalised(motion.attitude);
    turn->w = q[0], turn->x = q[1], turn->y = q[2], turn->z = q[3];
    std::copy_n(motion.velocity_m_s.begin(), 3, all->as<Real>(velocity)->values);
    std::copy_n(motion.body_rates_rad_s.begin(), 3, all->as<Real>(rates)->values);
    if (n > 0) {
        std::copy_n(motion.joints_rad.begin(), n, all->as<Real>(joints)->values);
        std::copy_n(motion.joint_rates_rad_s.begin(), n, all->as<Real>(joint_rates)->values);
    }
}

/// Lift and torques as they are, whatever rotors can give.
struct Wrench : dynamics::CalmSpace {
    dynamics::LaneVector<double> torque_nm{0, 0, 0};
    double lift_n = 0;
    template <class T, int n>
    void add_load(const T* /*q*/, const T* /*u*/, const dynamics::SpacePlaces<T, n>& /*places*/,
                  dynamics::SpaceLoad<T, n>& load) const {
        load.wrench.force_n.z = load.wrench.force_n.z + lift_n;
        load.wrench.torque_nm = load.wrench.torque_nm + torque_nm;
    }
};

/// The right-hand side, in the order in which OMPL copies a state to numbers: place, quaternion (x, y, z, w), velocity,
/// body rates, joints and their rates. Controls: lift, torques about the body axes, torques of the joints.
template <int n>
void fly(const SpaceModel<n>& model, const oc::ODESolver::StateType& y, const oc::Control* control,
         oc::ODESolver::StateType& rate) {
    const double* c = control->as<oc::RealVectorControlSpace::ControlType>()->values;
    double q[7 + n] = {y[0], y[1], y[2], y[6], y[3], y[4], y[5]};
    double u[6 + n] = {y[7], y[8], y[9], y[10], y[11], y[12]};
    std::copy_n(y.begin() + 13, n, q + 7);
    std::copy_n(y.begin() + 13 + n, n, u + 6);
    double joint_torque_nm[room_for<n>] = {};
    std::copy_n(c + 4, n, joint_torque_nm);
    const double thrust_n[max_rotors] = {};
    Wrench wrench;
    wrench.lift_n = c[0];
    wrench.torque_nm = {c[1], c[2], c[3]};
    double dq[7 + n], du[6 + n];
    dynamics::coordinate_rates<double, n>(q, u, dq);
    dynamics::accelerations(model, q, u, thrust_n, {0, 0, 0}, joint_torque_nm, wrench, du);
    rate.resize(y.size());
    std::copy_n(dq, 3, rate.begin());
    std::copy_n(dq + 4, 3, rate.begin() + 3);
    rate[6] = dq[3];
    std::copy_n(du, 6, rate.begin() + 7);
    std::copy_n(dq + 7, n, rate.begin() + 13);
    std::copy_n(du + 6, n, rate.begin() + 13 + n);
}

std::shared_ptr<ob::RealVectorStateSpace> within(const std::vector<double>& low, const std::vector<double>& high) {
    auto space = std::make_shared<ob::RealVectorStateSpace>(static_cast<unsigned int>(low.size()));
    ob::RealVectorBounds bounds(static_cast<unsigned int>(low.size()));
    bounds.low = low;
    bounds.high = high;
    space->setBounds(bounds);
    return space;
}
std::shared_ptr<ob::RealVectorStateSpace> within(std::size_t dimension, double most) {
    return within(std::vector<double>(dimension, -most), std::vector<double>(dimension, most));
}

/// KPIECE's cells: the place.
class Place : public ob::ProjectionEvaluator {
 public:
    using ob::ProjectionEvaluator::ProjectionEvaluator;
    unsigned int getDimension() const override { return 3; }
    void defaultCellSizes() override { cellSizes_.assign(3, 0.5); }
    void project(const ob::State* state, Eigen::Ref<Eigen::VectorXd> projection) const override {
        const double* at = state->as<ob::CompoundState>()->as<Real>(place)->values;
        projection << at[0], at[1], at[2];
    }
};

ob::StateSpacePtr make_states(const SpaceProblem& problem, const Options& options) {
    const SpaceBounds& bounds = problem.bounds;
    const auto all = std::make_shared<ob::CompoundStateSpace>();
    all->addSubspace(within({bounds.low_m.begin(), bounds.low_m.end()}, {bounds.high_m.begin(), bounds.high_m.end()}),
                     weights[place]);
    all->addSubspace(std::make_shared<ob::SO3StateSpace>(), weights[attitude]);
    all->addSubspace(within(3, options.max_speed_m_s), weights[velocity]);
    all->addSubspace(within(3, options.max_rate_rad_s), weights[rates]);
    if (!problem.robot.links.empty()) {
        std::vector<double> low, high;
        for (const SpaceLinkLimits& link : problem.robot.links) {
            low.push_back(link.lower_limit_rad);
            high.push_back(link.upper_limit_rad);
        }
        all->addSubspace(within(low, high), weights[joints]);
        all->addSubspace(within(low.size(), options.max_joint_rate_rad_s), weights[joint_rates]);
    }
    all->registerDefaultProjection(std::make_shared<Place>(all.get()));
    return all;
}

/// A lift around the weight, torques that turn the vehicle by so much, and those of the joints around none.
class HoverSampler : public oc::ControlSampler {
 public:
    HoverSampler(const oc::ControlSpace* space, std::vector<double> middle, std::vector<double> spread)
        : oc::ControlSampler(space), middle_(std::move(middle)), spread_(std::move(spread)) {}

    void sample(oc::Control* control) override {
        double* values = control->as<oc::RealVectorControlSpace::ControlType>()->values;
        const ob::RealVectorBounds& bounds = space_->as<oc::RealVectorControlSpace>()->getBounds();
        for (std::size_t i = 0; i < middle_.size(); ++i) {
            values[i] = std::clamp(rng_.gaussian(middle_[i], spread_[i]), bounds.low[i], bounds.high[i]);
        }
    }

 private:
    std::vector<double> middle_, spread_;
};

std::shared_ptr<oc::RealVectorControlSpace> make_controls(const SpaceProblem& problem, const ob::StateSpacePtr& states,
                                                          const Options& options) {
    const SpaceRobot& robot = problem.robot;
    double most_n = 0;
    for (std::size_t i = 0; i < robot.plant.rotors.size(); ++i) {
        most_n += robot.plant.rotors[i].axis[2] * robot.max_thrust_n[i];
    }
    const double weight_n = robot.mass_kg() * standard_gravity_m_s2;
    std::vector<double> low{0}, high{most_n}, middle{weight_n}, spread{0.4 * weight_n};
    const auto& inertia = robot.plant.multirotor.inertia_kg_m2;
    for (std::size_t i = 0; i < 3; ++i) {
        constexpr double most_rad_s2 = 40;
        low.push_back(-most_rad_s2 * inertia[i][i]);
        high.push_back(most_rad_s2 * inertia[i][i]);
        middle.push_back(0);
        spread.push_back(options.turn_rad_s2 * inertia[i][i]);
    }
    for (const SpaceLinkLimits& link : robot.links) {
        low.push_back(-link.max_torque_nm);
        high.push_back(link.max_torque_nm);
        middle.push_back(0);
        spread.push_back(options.joint_share * link.max_torque_nm);
    }
    const auto controls = std::make_shared<oc::RealVectorControlSpace>(states, static_cast<unsigned int>(low.size()));
    ob::RealVectorBounds bounds(static_cast<unsigned int>(low.size()));
    bounds.low = low;
    bounds.high = high;
    controls->setBounds(bounds);
    controls->setControlSamplerAllocator([middle, spread](const oc::ControlSpace* space) {
        return std::make_shared<HoverSampler>(space, middle, spread);
    });
    return controls;
}

/// What a run comes to.
struct Progress {
    double nearest = std::numeric_limits<double>::infinity();
};

/// Of a configuration: at rest there, to within dynobench's distance. Of any other goal: within its tolerances, at any
/// speed; the distance is that of the end effector, and what its direction lacks.
class SpaceGoalRegion : public ob::GoalSampleableRegion {
 public:
    SpaceGoalRegion(const ob::SpaceInformationPtr& information, const SpaceProblemModel& model, double error,
                    std::uint64_t seed, Progress& progress)
        : ob::GoalSampleableRegion(information),
          model_(model),
          n_(model.problem().robot.joints()),
          is_exact_(std::holds_alternative<SpaceConfigurationGoal>(model.problem().goals.front().kind)),
          sampler_(model.problem().robot, model.problem().bounds, model.shared_scene(), model.collisions(),
                   model.problem().planner.safety_margin_m, model.problem().goals.front()),
          random_(seed),
          at_goal_(information),
          progress_(progress) {
        setThreshold(is_exact_ ? error : 1);
        sampleGoal(at_goal_.get());
    }
    bool isSatisfied(const ob::State* state, double* distance) const override {
        *distance = distanceGoal(state);
        return *distance <= threshold_;
    }
    double distanceGoal(const ob::State* state) const override {
        double distance = 0;
        if (is_exact_) {
            distance = si_->distance(state, at_goal_.get());
            progress_.nearest = std::min(progress_.nearest, distance);
            return distance;
        }
        const SpaceGoalError error = model_.goals().error({}, motion_of(state, n_));
        progress_.nearest = std::min(progress_.nearest, error.distance_m);
        return error.used_share;
    }
    void sampleGoal(ob::State* state) const override {
        constexpr int tries = 1000;
        const double share = is_exact_ ? 0 : 0.5;
        for (int i = 0; i < tries; ++i) {
            if (const auto drawn = sampler_.drawn(random_, share);
                drawn && sampler_.flaw(*drawn) == SpaceGoalFlaw::none) {
                write(resting_at(drawn->at), n_, state);
                return;
            }
        }
    }
    unsigned int maxSampleCount() const override { return std::numeric_limits<unsigned int>::max(); }

 private:
    const SpaceProblemModel& model_;
    int n_;
    bool is_exact_;
    SpaceGoalSampler sampler_;
    mutable Random random_;
    ob::ScopedState<> at_goal_;
    Progress& progress_;
};

bool is_valid(const oc::SpaceInformation& information, const SpaceProblemModel& model, const ob::State* state) {
    if (!information.satisfiesBounds(state)) {
        return false;
    }
    const SpaceMotion motion = motion_of(state, model.problem().robot.joints());
    return !model.collisions().is_nearer_than({motion.position_m, motion.attitude, motion.joints_rad}, 0);
}

template <int n>
oc::SpaceInformationPtr make_information(const SpaceProblemModel& model, const Options& options) {
    const SpaceProblem& problem = model.problem();
    const ob::StateSpacePtr states = make_states(problem, options);
    const auto information = std::make_shared<oc::SpaceInformation>(states, make_controls(problem, states, options));
    states->setup();  // ODESolver reads from a space that is set up
    const auto solver = std::make_shared<oc::ODEBasicSolver<>>(
        information,
        [plant = make_space_model<n>(problem.robot.plant)](const oc::ODESolver::StateType& y,
                                                           const oc::Control* control, oc::ODESolver::StateType& rate) {
            fly<n>(plant, y, control, rate);
        },
        integration_s);
    const auto to_length_1 = [](const ob::State*, const oc::Control*, double, ob::State* result) {
        ob::SO3StateSpace().enforceBounds(result->as<ob::CompoundState>()->as<Turn>(attitude));
    };
    information->setStatePropagator(oc::ODESolver::getStatePropagator(solver, to_length_1));
    information->setStateValidityChecker(
        [raw = information.get(), &model](const ob::State* state) { return is_valid(*raw, model, state); });
    information->setPropagationStepSize(propagation_s);
    information->setMinMaxControlDuration(min_steps, max_steps);
    information->setup();
    return information;
}

std::shared_ptr<ob::Planner> make_planner(const Options& options, const oc::SpaceInformationPtr& information) {
    if (options.planner == "rrt") {
        auto planner = std::make_shared<oc::RRT>(information);
        planner->setGoalBias(goal_bias);
        planner->setIntermediateStates(true);
        return planner;
    }
    if (options.planner == "kpiece") {
        auto planner = std::make_shared<oc::KPIECE1>(information);
        planner->setGoalBias(goal_bias);
        return planner;
    }
    auto planner = std::make_shared<oc::SST>(information);
    planner->setGoalBias(goal_bias);
    planner->setSelectionRadius(0.2);
    planner->setPruningRadius(0.1);
    return planner;
}

template <int n>
void run(const Options& options, const SpaceProblemModel& model, std::uint32_t seed) {
    const oc::SpaceInformationPtr information = make_information<n>(model, options);
    const auto definition = std::make_shared<ob::ProblemDefinition>(information);
    ob::ScopedState<> start(information);
    write(start_motion(model.problem().start), n, start.get());
    definition->addStartState(start);
    Progress progress;
    definition->setGoal(std::make_shared<SpaceGoalRegion>(information, model, options.goal_error, seed, progress));
    const auto objective = std::make_shared<ob::PathLengthOptimizationObjective>(information);
    objective->setCostThreshold(objective->infiniteCost());  // the first solution will do
    definition->setOptimizationObjective(objective);
    const auto planner = make_planner(options, information);
    planner->setProblemDefinition(definition);
    planner->setup();
    const double begin_s = bench::processor_time_s();
    planner->solve(
        ob::PlannerTerminationCondition([&] { return bench::processor_time_s() - begin_s > options.time_limit_s; }));
    std::string first = "null", cost = "null";
    if (definition->hasExactSolution()) {
        first = fmt::format("{:.3f}", bench::processor_time_s() - begin_s);
        cost = fmt::format("{:.2f}", definition->getSolutionPath()->as<oc::PathControl>()->length());
    }
    fmt::print(
        R"({{"problem": "{}", "planner": "{}", "seed": {}, "limit_s": {}, "nearest": {:.4f}, "first_s": {}, "cost_s": {}}})"
        "\n",
        model.problem().name, options.planner, seed, options.time_limit_s, progress.nearest, first, cost);
    std::fflush(stdout);
}

void run_all(const Options& options) {
    const SpaceProblemModel model(read_space_problem(options.problem));
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    ompl::RNG::setSeed(1);  // once: OMPL takes no other
    for (std::uint32_t seed = 1; seed <= options.seeds; ++seed) {
        switch (model.problem().robot.joints()) {
            case 0:
                run<0>(options, model, seed);
                break;
            case 2:
                run<2>(options, model, seed);
                break;
            default:
                throw std::invalid_argument("a robot without joints or with two of them");
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App program("OMPL's RRT, SST and KPIECE on a vehicle in space, as lines of JSON");
    program.add_option("PROBLEM", options.problem, "problem file in space, of one goal")->required();
    program.add_option("PLANNER", options.planner)->required()->check(CLI::IsMember({"rrt", "sst", "kpiece"}));
    program.add_option("--seeds", options.seeds, "runs")->check(CLI::Range(1, 10000));
    program.add_option("--time-limit", options.time_limit_s, "processor time of each run [s]")
        ->check(CLI::Range(0.01, 3600.0));
    return downwash::bench::run_program(program, argc, argv, [&options] { run_all(options); });
}
