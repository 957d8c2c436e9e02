// Debian's OMPL on dynobench's planar rotor, set up as a practitioner does: control::RRT or control::SST, an ODESolver
// (Runge-Kutta, 10 ms), thrusts held for 0.1 to 1 s and drawn around a hover. Prints one line of JSON with the
// solutions of each run: wall time and flight time, both in seconds.

#include <fmt/core.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SO2StateSpace.h>
#include <ompl/control/ODESolver.h>
#include <ompl/control/SimpleDirectedControlSampler.h>
#include <ompl/control/planners/rrt/RRT.h>
#include <ompl/control/planners/sst/SST.h>
#include <ompl/control/spaces/RealVectorControlSpace.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "../support/measuring.hpp"
#include "downwash/problems/problem_reader.hpp"

using namespace downwash;
namespace ob = ompl::base;
namespace oc = ompl::control;

namespace {

// Dynobench's planar rotor (quad2d_v0).
constexpr double gravity_m_s2 = 9.81;
constexpr double mass_kg = 0.034;
constexpr double inertia_kg_m2 = 1e-4;
constexpr double lever_m = 0.1;
constexpr double max_thrust_n = 1.3 * mass_kg * gravity_m_s2 / 2;
constexpr double max_speed_m_s = 4;
constexpr double max_pitch_rate_rad_s = 8;
constexpr double half_length_m = 0.3;
constexpr double half_height_m = 0.1;
/// Weights of place, pitch, speed, pitch rate, and time.
constexpr double weights[] = {1, 0.5, 0.2, 0.2, 0};

constexpr double integration_s = 0.01;
constexpr double propagation_s = 0.02;
constexpr unsigned int min_steps = 5;
constexpr unsigned int max_steps = 50;

struct Options {
    std::string problem;
    std::string planner;
    std::uint32_t seeds = 5;
    double time_limit_s = 60;
    double goal_error = 0.03;
    double selection_radius = 0.2;
    double pruning_radius = 0.1;
    double goal_bias = 0.1;
    double turn_rad_s2 = 5;
    unsigned int directed = 1;
};

/// A state as numbers, in the order of ODESolver.
struct Numbers {
    double x, z, pitch, vx, vz, rate, time;
};

using Real = ob::RealVectorStateSpace::StateType;

Numbers numbers_of(const ob::State* state) {
    const auto* all = state->as<ob::CompoundState>();
    const double* place = all->as<Real>(0)->values;
    const double* speed = all->as<Real>(2)->values;
    return {place[0],
            place[1],
            all->as<ob::SO2StateSpace::StateType>(1)->value,
            speed[0],
            speed[1],
            all->as<Real>(3)->values[0],
            all->as<Real>(4)->values[0]};
}

void write(ob::State* state, double x_m, double z_m) {
    auto* all = state->as<ob::CompoundState>();
    all->as<Real>(0)->values[0] = x_m;
    all->as<Real>(0)->values[1] = z_m;
    all->as<ob::SO2StateSpace::StateType>(1)->value = 0;
    std::fill_n(all->as<Real>(2)->values, 2, 0.0);
    all->as<Real>(3)->values[0] = 0;
    all->as<Real>(4)->values[0] = 0;
}

std::shared_ptr<ob::RealVectorStateSpace> interval(unsigned int dimension, double low, double high) {
    auto space = std::make_shared<ob::RealVectorStateSpace>(dimension);
    ob::RealVectorBounds bounds(dimension);
    bounds.setLow(low);
    bounds.setHigh(high);
    space->setBounds(bounds);
    return space;
}

/// Distances are dynobench's: a weighted sum.
ob::StateSpacePtr make_states(const Problem& problem) {
    const auto place = std::make_shared<ob::RealVectorStateSpace>(2);
    ob::RealVectorBounds bounds(2);
    bounds.setLow(0, problem.bounds.x_low_m);
    bounds.setHigh(0, problem.bounds.x_high_m);
    bounds.setLow(1, problem.bounds.z_low_m);
    bounds.setHigh(1, problem.bounds.z_high_m);
    place->setBounds(bounds);
    const auto all = std::make_shared<ob::CompoundStateSpace>();
    all->addSubspace(place, weights[0]);
    all->addSubspace(std::make_shared<ob::SO2StateSpace>(), weights[1]);
    all->addSubspace(interval(2, -max_speed_m_s, max_speed_m_s), weights[2]);
    all->addSubspace(interval(1, -max_pitch_rate_rad_s, max_pitch_rate_rad_s), weights[3]);
    all->addSubspace(interval(1, 0, 1e6), weights[4]);  // the time so far, which SST can add up
    return all;
}

/// Both thrusts around those of a hover; a difference between them turns the vehicle, and it may turn by 8 rad/s only.
class HoverSampler : public oc::ControlSampler {
 public:
    HoverSampler(const oc::ControlSpace* space, double turn_rad_s2)
        : oc::ControlSampler(space), turn_rad_s2_(turn_rad_s2) {}

    void sample(oc::Control* control) override {
        constexpr double thrust_spread = 0.4;
        const double hover_n = 0.5 * mass_kg * gravity_m_s2;
        const double mean = std::clamp(rng_.gaussian(hover_n, thrust_spread * hover_n), 0.0, max_thrust_n);
        const double turn = rng_.gaussian(0, turn_rad_s2_);
        const double half_n = 0.5 * turn * inertia_kg_m2 / lever_m;
        double* thrust_n = control->as<oc::RealVectorControlSpace::ControlType>()->values;
        thrust_n[0] = std::clamp(mean + half_n, 0.0, max_thrust_n);
        thrust_n[1] = std::clamp(mean - half_n, 0.0, max_thrust_n);
    }

 private:
    double turn_rad_s2_;
};

void fly(const oc::ODESolver::StateType& state, const oc::Control* control, oc::ODESolver::StateType& rates) {
    const double* thrust_n = control->as<oc::RealVectorControlSpace::ControlType>()->values;
    const double lift = (thrust_n[0] + thrust_n[1]) / mass_kg;
    rates = {state[3],
             state[4],
             state[5],
             lift * std::sin(state[2]),
             lift * std::cos(state[2]) - gravity_m_s2,
             lever_m * (thrust_n[1] - thrust_n[0]) / inertia_kg_m2,
             1};
}

/// Whether the turned body and an upright box overlap.
bool touches(const Numbers& body, const Obstacle& obstacle) {
    const auto& box = std::get<Box>(obstacle.shape);
    const double c = std::cos(body.pitch);
    const double s = std::sin(body.pitch);
    const double dx = obstacle.center_world_m[0] - body.x;
    const double dz = obstacle.center_world_m[2] - body.z;
    const double axes[4][2] = {{1, 0}, {0, 1}, {c, -s}, {s, c}};
    return std::all_of(std::begin(axes), std::end(axes), [&](const double* axis) {
        const double reach = half_length_m * std::abs(axis[0] * c - axis[1] * s) +
                             half_height_m * std::abs(axis[0] * s + axis[1] * c) +
                             0.5 * box.size_m[0] * std::abs(axis[0]) + 0.5 * box.size_m[2] * std::abs(axis[1]);
        return std::abs(axis[0] * dx + axis[1] * dz) <= reach;
    });
}

bool is_valid(const oc::SpaceInformation& information, const Problem& problem, const ob::State* state) {
    const Numbers body = numbers_of(state);
    return information.satisfiesBounds(state) && std::hypot(body.vx, body.vz) <= max_speed_m_s &&
           std::none_of(problem.obstacles.begin(), problem.obstacles.end(),
                        [&](const Obstacle& obstacle) { return touches(body, obstacle); });
}

/// When a goal was reached, each time sooner in flight than before; both in seconds.
struct Arrivals {
    double error = 0;  ///< that counts as the goal
    double best_s = std::numeric_limits<double>::infinity();
    std::string text{};

    void note(double wall_s, double flight_s) {
        if (flight_s < best_s) {
            best_s = flight_s;
            text += fmt::format("{}[{:.4f}, {:.2f}]", text.empty() ? "" : ", ", wall_s, flight_s);
        }
    }
};

/// What a search comes to: at the goal, and at a goal ten times as wide.
struct Progress {
    using Clock = std::chrono::steady_clock;

    explicit Progress(double error) {
        exact.error = error;
        wide.error = 10 * error;
    }

    void see(double error, double flight_s) {
        nearest = std::min(nearest, error);
        const double wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
        for (Arrivals* arrivals : {&exact, &wide}) {
            if (error <= arrivals->error) {
                arrivals->note(wall_s, flight_s);
            }
        }
    }

    Clock::time_point begin = Clock::now();
    double nearest = std::numeric_limits<double>::infinity();
    Arrivals exact, wide;
};

/// At rest at the goal, to within dynobench's distance. Planners ask it about every new state.
class RestGoal : public ob::GoalSampleableRegion {
 public:
    RestGoal(const ob::SpaceInformationPtr& information, const ConfigurationGoal& goal, double error,
             Progress& progress)
        : ob::GoalSampleableRegion(information), goal_(information), progress_(progress) {
        write(goal_.get(), *goal.x_m, *goal.z_m);
        setThreshold(error);
    }
    bool isSatisfied(const ob::State* state, double* distance) const override {
        *distance = distanceGoal(state);
        progress_.see(*distance, numbers_of(state).time);
        return *distance <= threshold_;
    }
    double distanceGoal(const ob::State* state) const override { return si_->distance(state, goal_.get()); }
    void sampleGoal(ob::State* state) const override { si_->copyState(state, goal_.get()); }
    unsigned int maxSampleCount() const override { return std::numeric_limits<unsigned int>::max(); }

 private:
    ob::ScopedState<> goal_;
    Progress& progress_;
};

/// What SST adds up is the time.
class FlightTime : public ob::OptimizationObjective {
 public:
    using ob::OptimizationObjective::OptimizationObjective;
    ob::Cost stateCost(const ob::State* /*state*/) const override { return ob::Cost(0); }
    ob::Cost motionCost(const ob::State* from, const ob::State* to) const override {
        return ob::Cost(std::max(0.0, numbers_of(to).time - numbers_of(from).time));
    }
};

oc::SpaceInformationPtr make_information(const Problem& problem, const Options& options) {
    const ob::StateSpacePtr states = make_states(problem);
    const auto controls = std::make_shared<oc::RealVectorControlSpace>(states, 2);
    ob::RealVectorBounds thrusts(2);
    thrusts.setLow(0);
    thrusts.setHigh(max_thrust_n);
    controls->setBounds(thrusts);
    controls->setControlSamplerAllocator([turn = options.turn_rad_s2](const oc::ControlSpace* space) {
        return std::make_shared<HoverSampler>(space, turn);
    });
    auto information = std::make_shared<oc::SpaceInformation>(states, controls);
    states->setup();  // ODESolver reads from a space that is set up
    const auto solver = std::make_shared<oc::ODEBasicSolver<>>(information, fly, integration_s);
    const auto into_circle = [](const ob::State*, const oc::Control*, double, ob::State* result) {
        ob::SO2StateSpace().enforceBounds(result->as<ob::CompoundState>()->as<ob::SO2StateSpace::StateType>(1));
    };
    information->setStatePropagator(oc::ODESolver::getStatePropagator(solver, into_circle));
    information->setStateValidityChecker(
        [raw = information.get(), &problem](const ob::State* state) { return is_valid(*raw, problem, state); });
    information->setPropagationStepSize(propagation_s);
    information->setMinMaxControlDuration(min_steps, max_steps);
    information->setDirectedControlSamplerAllocator([tries = options.directed](const oc::SpaceInformation* space) {
        return std::make_shared<oc::SimpleDirectedControlSampler>(space, tries);
    });
    information->setup();
    return information;
}

std::shared_ptr<ob::Planner> make_planner(const Options& options, const oc::SpaceInformationPtr& information) {
    if (options.planner == "rrt") {
        auto planner = std::make_shared<oc::RRT>(information);
        planner->setGoalBias(options.goal_bias);
        planner->setIntermediateStates(true);
        return planner;
    }
    auto planner = std::make_shared<oc::SST>(information);
    planner->setGoalBias(options.goal_bias);
    planner->setSelectionRadius(options.selection_radius);
    planner->setPruningRadius(options.pruning_radius);
    return planner;
}

void run(const Options& options, const Problem& problem, std::uint32_t seed) {
    const oc::SpaceInformationPtr information = make_information(problem, options);
    const auto definition = std::make_shared<ob::ProblemDefinition>(information);
    ob::ScopedState<> start(information);
    write(start.get(), problem.start.at[plane::x], problem.start.at[plane::z]);
    definition->addStartState(start);
    Progress progress(options.goal_error);
    definition->setGoal(std::make_shared<RestGoal>(information, std::get<ConfigurationGoal>(problem.goal.kind),
                                                   options.goal_error, progress));
    const auto objective = std::make_shared<FlightTime>(information);
    objective->setCostThreshold(ob::Cost(0));  // search on to the end
    definition->setOptimizationObjective(objective);
    const auto planner = make_planner(options, information);
    planner->setProblemDefinition(definition);
    planner->setup();
    progress.begin = Progress::Clock::now();
    planner->solve(ob::timedPlannerTerminationCondition(options.time_limit_s));
    for (const Arrivals& arrivals : {progress.exact, progress.wide}) {
        fmt::print(
            R"({{"problem": "{}", "planner": "{}", "goal_error": {}, "seed": {}, "nearest": {:.4f}, "solutions": [{}]}})"
            "\n",
            problem.name, options.planner, arrivals.error, seed, progress.nearest, arrivals.text);
    }
    std::fflush(stdout);
}

void run_all(const Options& options) {
    const Problem problem = read_problem(options.problem);
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    ompl::RNG::setSeed(1);  // once: OMPL takes no other
    for (std::uint32_t seed = 1; seed <= options.seeds; ++seed) {
        run(options, problem, seed);
    }
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App program("OMPL's RRT and SST on dynobench's planar rotor, as lines of JSON");
    program.add_option("PROBLEM", options.problem, "problem file; obstacles are boxes")->required();
    program.add_option("PLANNER", options.planner, "rrt or sst")->required()->check(CLI::IsMember({"rrt", "sst"}));
    program.add_option("--seeds", options.seeds, "runs")->check(CLI::Range(1, 10000));
    program.add_option("--time-limit", options.time_limit_s, "of each run [s]")->check(CLI::Range(0.01, 3600.0));
    program.add_option("--goal-error", options.goal_error, "distance that counts as the goal")
        ->check(CLI::Range(0.001, 10.0));
    program.add_option("--goal-bias", options.goal_bias, "share of the samples at the goal")
        ->check(CLI::Range(0.0, 1.0));
    program.add_option("--turn", options.turn_rad_s2, "spread of the pitch acceleration of a control [rad/s2]")
        ->check(CLI::Range(0.01, 200.0));
    program.add_option("--directed", options.directed, "controls of which RRT takes the best")
        ->check(CLI::Range(1, 1000));
    program.add_option("--selection-radius", options.selection_radius, "of SST")->check(CLI::Range(0.001, 10.0));
    program.add_option("--pruning-radius", options.pruning_radius, "of SST")->check(CLI::Range(0.001, 10.0));
    return downwash::bench::run_program(program, argc, argv, [&options] { run_all(options); });
}
