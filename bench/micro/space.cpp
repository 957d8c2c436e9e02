// Ticks of the plant in space: one Runge-Kutta step of 10 ms under constant commands, without a controller. With a map
// four rotors ask a VolumeMap in each of the four stages.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>

// The functions of a pack of lanes have to be there before what is flown with them.
#include "downwash/base/lane_pack.hpp"

#include "bridge.hpp"
#include "downwash/aeromap/volume_map.hpp"
#include "downwash/base/numbers.hpp"
#include "downwash/dynamics/quadrotor.hpp"
#include "downwash/dynamics/space_step.hpp"

using namespace downwash;
using bench::Bridge;

namespace {

/// The volume under the deck of the bridge that bench_aero_map measures, too.
const VolumeMap& volume() {
    static const VolumeMap map(std::make_shared<const DirectEffect>(Bridge::get().model->effect(0)),
                               Bridge::get().model->plane(), {-8, -2, 8, 10}, -1.25, 1.25);
    return map;
}

/// A quadrotor of the size of the shipped robot, with drag torque and spinning rotors, and links that hang one after
/// the other.
template <int n>
SpaceModel<n> sample_model() {
    QuadrotorParameters quadrotor;
    quadrotor.mass_kg = 4.5;
    quadrotor.inertia_kg_m2 = {0.2, 0.2, 0.35};
    quadrotor.arm_m = 0.45;
    quadrotor.rotor_height_m = 0.06;
    quadrotor.drag_torque_m = 0.02;
    quadrotor.thrust_coefficient_n_s2 = 5e-5;
    quadrotor.rotor_inertia_kg_m2 = 2e-4;
    quadrotor.power_coefficient_w_n1p5 = 2.9;
    SpacePlant plant = make_quadrotor(quadrotor);
    for (int i = 0; i < n; ++i) {
        const Vector3 axis = i % 2 == 0 ? Vector3{0, 1, 0} : Vector3{1, 0, 0};
        plant.links.push_back(
            {{0.3, {{{0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.001}}}}, {0, 0, i == 0 ? 0 : -0.4}, axis, {0, 0, -0.2}});
    }
    return make_space_model<n>(plant);
}

/// Every lane asks for itself.
struct InVolume : dynamics::CalmSpace {
    explicit InVolume(const VolumeMap& volume) : map(volume) {}
    const VolumeMap& map;
    template <class T>
    T thrust_ratio(int /*rotor*/, const dynamics::LaneVector<T>& hub_m, const dynamics::LaneVector<T>& /*axis*/) const {
        T factors;
        for (int lane = 0; lane < lane::width<T>; ++lane) {
            lane::set_number(factors, lane,
                             map.factor({lane::number_in(hub_m.x, lane), lane::number_in(hub_m.y, lane),
                                         lane::number_in(hub_m.z, lane)}));
        }
        return factors;
    }
};

/// Flights of half a second that start in a slow turn 0.6 m and more under the deck.
template <class T, int n, class Surroundings>
void fly_space_ticks(benchmark::State& state, const Surroundings& surroundings) {
    constexpr int ticks = 50;
    const SpaceModel<n> model = sample_model<n>();
    const double weight_n = model.total_mass_kg * standard_gravity_m_s2;
    dynamics::SpaceState<T, n> start{};
    dynamics::SpaceCommand<T, n> command{};
    const Vector3 at_m = Bridge::get().model->plane().to_world(-5, 0, 9);
    for (int lane = 0; lane < lane::width<T>; ++lane) {
        lane::set_number(start.q[0], lane, at_m[0] + 0.1 * lane);
        lane::set_number(start.q[1], lane, at_m[1]);
        lane::set_number(start.q[2], lane, at_m[2]);
    }
    start.q[3] = T(1);
    start.u[0] = T(0.3);
    start.u[5] = T(0.4);
    for (int i = 0; i < 4; ++i) {
        command.thrust_n[i] = T(0.25 * weight_n);
    }
    for (int i = 0; i < n; ++i) {
        start.u[6 + i] = T(0.3);
        command.joint_torque_nm[i] = T(0.05);
    }
    for ([[maybe_unused]] auto _ : state) {
        dynamics::SpaceState<T, n> vehicle = start;
        for (int i = 0; i < ticks; ++i) {
            vehicle = dynamics::space_step(model, vehicle, command, T(0.01), surroundings);
        }
        benchmark::DoNotOptimize(vehicle);
    }
    state.SetItemsProcessed(state.iterations() * ticks * lane::width<T>);
}

template <class T, int n>
void space_tick(benchmark::State& state) {
    fly_space_ticks<T, n>(state, dynamics::CalmSpace{});
}
template <class T, int n>
void space_tick_with_map(benchmark::State& state) {
    fly_space_ticks<T, n>(state, InVolume(volume()));
}

[[maybe_unused]] const bool space_ticks_are_registered = [] {
    const auto add = []<class T, int n>(const std::string& name) {
        const std::string joints = "plant_in_space/" + std::to_string(n) + "_joints" + name;
        benchmark::RegisterBenchmark(joints.c_str(), space_tick<T, n>);
        benchmark::RegisterBenchmark((joints + "_map").c_str(), space_tick_with_map<T, n>);
    };
    add.operator()<double, 0>("");
    add.operator()<double, 1>("");
    add.operator()<double, 2>("");
    add.operator()<double, 3>("");
    add.operator()<lane::Pack, 0>("_lanes");
    add.operator()<lane::Pack, 1>("_lanes");
    add.operator()<lane::Pack, 2>("_lanes");
    add.operator()<lane::Pack, 3>("_lanes");
    return true;
}();

}  // namespace
