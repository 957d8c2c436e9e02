// A path as a practitioner would plan it: OMPL's RRT-Connect over x, y, z, yaw and the joints of the level vehicle,
// shortened by OMPL's simplifier, then a reference from rest to rest along each of its lines, as fast as the problem's
// limits of motion allow. Prints it as a solution.json for `downwash validate`.

#include <fmt/core.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SO2StateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>

#include "../support/measuring.hpp"
#include "downwash/base/random.hpp"
#include "downwash/controllers/space_duration.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/simulation/space_configuration.hpp"
#include "downwash/simulation/space_goal_sampler.hpp"

using namespace downwash;
namespace ob = ompl::base;
namespace og = ompl::geometric;

namespace {

struct Options {
    std::string problem;
    std::uint32_t seed = 1;
    double time_limit_s = 20;
    double margin_m = 0.05;
    double resolution_m = 0.02;  ///< of the checks along a line
};

using Real = ob::RealVectorStateSpace::StateType;
using Angle = ob::SO2StateSpace::StateType;

/// Place, yaw and joints; one radian counts as a metre.
ob::StateSpacePtr make_space(const SpaceProblem& problem) {
    const auto joints = static_cast<unsigned int>(problem.robot.joints());
    const auto real = std::make_shared<ob::RealVectorStateSpace>(3 + joints);
    ob::RealVectorBounds bounds(3 + joints);
    for (unsigned int i = 0; i < 3; ++i) {
        bounds.setLow(i, problem.bounds.low_m[i]);
        bounds.setHigh(i, problem.bounds.high_m[i]);
    }
    for (unsigned int i = 0; i < joints; ++i) {
        const SpaceLinkLimits& link = problem.robot.links[i];
        bounds.setLow(3 + i, link.is_limited ? link.lower_limit_rad : -std::numbers::pi);
        bounds.setHigh(3 + i, link.is_limited ? link.upper_limit_rad : std::numbers::pi);
    }
    real->setBounds(bounds);
    const auto all = std::make_shared<ob::CompoundStateSpace>();
    all->addSubspace(real, 1);
    all->addSubspace(std::make_shared<ob::SO2StateSpace>(), 1);
    return all;
}

SpaceConfiguration read(const ob::State* state, int joints) {
    const double* real = state->as<ob::CompoundState>()->as<Real>(0)->values;
    SpaceConfiguration at{};
    std::copy_n(real, 3, at.begin());
    at[space::yaw] = state->as<ob::CompoundState>()->as<Angle>(1)->value;
    std::copy_n(real + 3, joints, at.begin() + space::first_joint);
    return at;
}

void write(const SpaceConfiguration& at, int joints, ob::State* state) {
    double* real = state->as<ob::CompoundState>()->as<Real>(0)->values;
    std::copy_n(at.begin(), 3, real);
    const double yaw = std::remainder(at[space::yaw], 2 * std::numbers::pi);
    state->as<ob::CompoundState>()->as<Angle>(1)->value = yaw < std::numbers::pi ? yaw : -yaw;  // pi is out of bounds
    std::copy_n(at.begin() + space::first_joint, joints, real + 3);
}

/// The goal, sampled by inverse kinematics in the middle of its tolerances.
class GoalRegion : public ob::GoalSampleableRegion {
 public:
    GoalRegion(const ob::SpaceInformationPtr& information, const SpaceProblemModel& model, const Options& options)
        : ob::GoalSampleableRegion(information),
          joints_(model.problem().robot.joints()),
          sampler_(model.problem().robot, model.problem().bounds, model.shared_scene(), model.collisions(),
                   options.margin_m, model.problem().goals.front()),
          random_(options.seed) {}
    double distanceGoal(const ob::State* /*state*/) const override { return std::numeric_limits<double>::infinity(); }
    void sampleGoal(ob::State* state) const override {
        for (int i = 0; i < 1000; ++i) {
            if (const auto drawn = sampler_.drawn(random_, 0.5);
                drawn && sampler_.flaw(*drawn) == SpaceGoalFlaw::none) {
                write(drawn->at, joints_, state);
                return;
            }
        }
        throw std::runtime_error("no configuration at the goal");
    }
    unsigned int maxSampleCount() const override { return std::numeric_limits<unsigned int>::max(); }

 private:
    int joints_;
    SpaceGoalSampler sampler_;
    mutable Random random_;
};

void print_knot(double t_s, const SpacePoint& point, int joints, bool is_first) {
    fmt::print(R"({}{{"t_s": {:.10g}, "x_m": {}, "y_m": {}, "z_m": {}, "yaw_rad": {})", is_first ? "" : ", ", t_s,
               point.position[0], point.position[1], point.position[2], point.position[space::yaw]);
    for (int i = 0; i < joints; ++i) {
        fmt::print(R"(, "joint_{}_rad": {})", i + 1, point.position[space::first_joint + static_cast<std::size_t>(i)]);
    }
    fmt::print("}}");
}

/// From rest to rest along each line.
void print_reference(const og::PathGeometric& path, const SpaceProblem& problem) {
    const int joints = problem.robot.joints();
    const double tick_s = 1 / problem.robot.controller.rate_hz;
    std::int64_t tick = 0;
    SpacePoint before{};
    fmt::print(R"({{"schema": "downwash/solution/v1", "plan": {{"reference": [)");
    for (unsigned int i = 0; i < path.getStateCount(); ++i) {
        SpaceConfiguration at = read(path.getState(i), joints);
        SpacePoint point{};
        if (i > 0) {
            const double yaw = before.position[space::yaw];
            at[space::yaw] = yaw + std::remainder(at[space::yaw] - yaw, 2 * std::numbers::pi);
        }
        std::copy(at.begin(), at.end(), point.position);
        if (i > 0) {
            tick += shortest_ticks(before, point, problem.motion, tick_s);
        }
        print_knot(static_cast<double>(tick) * tick_s, point, joints, i == 0);
        before = point;
    }
    fmt::print("]}}}}\n");
}

void plan(const Options& options) {
    const SpaceProblemModel model(read_space_problem(options.problem));
    const SpaceProblem& problem = model.problem();
    const int joints = problem.robot.joints();
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    ompl::RNG::setSeed(options.seed);
    const ob::StateSpacePtr space = make_space(problem);
    const auto information = std::make_shared<ob::SpaceInformation>(space);
    information->setStateValidityChecker([&](const ob::State* state) {
        return information->satisfiesBounds(state) &&
               !model.collisions().is_nearer_than(level_at(read(state, joints)), options.margin_m);
    });
    space->setup();
    information->setStateValidityCheckingResolution(options.resolution_m / space->getMaximumExtent());
    information->setup();
    const auto definition = std::make_shared<ob::ProblemDefinition>(information);
    ob::ScopedState<> start(space);
    SpaceConfiguration from{};
    std::copy_n(reference_at(problem.start).position, from.size(), from.begin());
    write(from, joints, start.get());
    definition->addStartState(start);
    definition->setGoal(std::make_shared<GoalRegion>(information, model, options));
    og::RRTConnect planner(information);
    planner.setProblemDefinition(definition);
    planner.setup();
    const double begin_s = bench::processor_time_s();
    const ob::PlannerStatus status = planner.solve(
        ob::PlannerTerminationCondition([&] { return bench::processor_time_s() - begin_s > options.time_limit_s; }));
    if (!definition->hasExactSolution()) {
        throw std::runtime_error(
            fmt::format("no path after {:.1f} s: {}", bench::processor_time_s() - begin_s, status.asString()));
    }
    auto& path = *definition->getSolutionPath()->as<og::PathGeometric>();
    og::PathSimplifier(information).simplifyMax(path);
    print_reference(path, problem);
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App program("A path of RRT-Connect, shortened, as a reference from rest to rest along its lines");
    program.add_option("PROBLEM", options.problem, "problem file in space, of one goal")->required();
    program.add_option("--seed", options.seed, "of all random numbers")->check(CLI::Range(1, 1000000));
    program.add_option("--time-limit", options.time_limit_s, "processor time of the search [s]")
        ->check(CLI::Range(0.01, 3600.0));
    return downwash::bench::run_program(program, argc, argv, [&options] { plan(options); });
}
