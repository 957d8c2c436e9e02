// The same closed loop in the way of other programs, to compare with tick_with_map and batch in one run: items are
// steps of 10 ms.

#include <benchmark/benchmark.h>
#include <ompl/control/SpaceInformation.h>
#include <ompl/control/spaces/RealVectorControlSpace.h>

#include <algorithm>

#include "bridge.hpp"
#include "downwash/bench/ompl_user/user_planner.hpp"

#ifdef DOWNWASH_HAS_MUJOCO
#include "../../tests/support/mujoco_world.hpp"
#endif

using namespace downwash;
using bench::Bridge;

namespace {

/// OMPL's ODESolver (RK4) over a right-hand side in Eigen, as a user's propagation of 0.1 s.
void ode_solver(benchmark::State& state, bool is_aware) {
    const Bridge& bridge = Bridge::get();
    const bench::UserPlanner user(bridge.problem, *bridge.model, is_aware ? bridge.map.get() : nullptr);
    const auto& information = user.information();
    ompl::base::State* from = information->allocState();
    ompl::base::State* to = information->allocState();
    ompl::control::Control* control = information->allocControl();
    const std::vector<double> start = bench::ClosedLoopOde::resting_at(-6, 9.0, -0.6);
    const double velocity[3] = {0.5, 0.03, 0.04};
    information->getStateSpace()->copyFromReals(from, start);
    std::copy(velocity, velocity + 3, control->as<ompl::control::RealVectorControlSpace::ControlType>()->values);
    constexpr int propagations = 100;
    for ([[maybe_unused]] auto _ : state) {
        information->getStateSpace()->copyFromReals(from, start);
        for (int i = 0; i < propagations; ++i) {
            information->getStatePropagator()->propagate(from, control, 0.1, to);
            std::swap(from, to);
        }
        benchmark::DoNotOptimize(from);
    }
    state.SetItemsProcessed(state.iterations() * propagations * 10);
    information->freeControl(control);
    information->freeState(to);
    information->freeState(from);
}
BENCHMARK_CAPTURE(ode_solver, free_air, false);
BENCHMARK_CAPTURE(ode_solver, with_map, true);

#ifdef DOWNWASH_HAS_MUJOCO
/// MuJoCo's RK4 of the plant alone: no controller, no surface effects. Level, the arm hanging, the thrust of hover.
void mujoco_rk4(benchmark::State& state) {
    const Bridge& bridge = Bridge::get();
    test::MujocoWorld world(bridge.problem.robot, 0.01);
    const PlantModel& plant = bridge.model->tick().plant;
    constexpr int steps = 1000;
    for ([[maybe_unused]] auto _ : state) {
        mj_resetData(world.model(), world.data());
        world.data()->qpos[3] = 1.5707963267948966;
        for (int i = 0; i < plant.rotor_count; ++i) {
            world.data()->ctrl[1 + i] = plant.force_share[i] * plant.total_mass_kg * standard_gravity_m_s2;
        }
        for (int i = 0; i < steps; ++i) {
            mj_step(world.model(), world.data());
        }
        benchmark::DoNotOptimize(world.data()->qpos[0]);
    }
    state.SetItemsProcessed(state.iterations() * steps);
}
BENCHMARK(mujoco_rk4);
#endif

}  // namespace
