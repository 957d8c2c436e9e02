#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "../support/random.hpp"
#include "../support/single_tick.hpp"
#include "../support/test_problem.hpp"
#include "downwash/bench/ompl_user/closed_loop_ode.hpp"
#include "downwash/bench/ompl_user/plain_collisions.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/simulation/map_effect.hpp"

using namespace downwash;
using bench::ClosedLoopOde;
using Ode = ClosedLoopOde;

namespace {

constexpr double pi = 3.141592653589793;

/// One classical Runge-Kutta step.
void step(const ClosedLoopOde& ode, const double velocity[3], double dt_s, std::vector<double>& state) {
    std::vector<double> k[4];
    std::vector<double> at = state;
    for (int stage = 0; stage < 4; ++stage) {
        ode(at, velocity, k[stage]);
        const double way = stage < 2 ? 0.5 * dt_s : dt_s;
        for (std::size_t i = 0; i < state.size(); ++i) {
            at[i] = state[i] + way * k[stage][i];
        }
    }
    for (std::size_t i = 0; i < state.size(); ++i) {
        state[i] += dt_s / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
    }
}

/// Worst difference in (x, z, pitch, arm) between the ODE and our ticks along the same reference, and the greatest K
/// on the way.
double worst_difference(const FlightModel& model, const AeroMap* map, const Configuration& from,
                        double& greatest_factor) {
    const ClosedLoopOde ode(model, map);
    std::vector<double> state = Ode::resting_at(from[plane::x], from[plane::z], from[plane::arm]);
    FlightState vehicle = model.state_at(level_at(from));
    const double velocity[3] = {0.3, -0.05, 0.2};
    double worst = 0;
    greatest_factor = 1;
    for (int i = 0; i < 300; ++i) {
        ReferencePoint reference;
        for (int axis = 0; axis < 3; ++axis) {
            reference.position[axis] = state[Ode::reference_x + static_cast<std::size_t>(axis)];
            reference.velocity[axis] = velocity[axis];
        }
        controllers::Actuation<double> given{};
        if (map != nullptr) {
            const simulation::RotorMaps maps = simulation::rotor_maps(model, *map);
            vehicle = test::single_tick(model.tick(), vehicle, reference, given, simulation::MapEffect<double>(maps));
        } else {
            vehicle = test::single_tick(model.tick(), vehicle, reference, given);
        }
        step(ode, velocity, model.tick().tick_s, state);
        for (std::size_t k = 0; k < 4; ++k) {
            worst = std::max(worst, std::abs(vehicle.plant.q[k] - state[k]));
        }
        if (map != nullptr) {
            greatest_factor = std::max(greatest_factor, map->factor(0, vehicle.plant.q[0], vehicle.plant.q[1]));
        }
    }
    return worst;
}

}  // namespace

TEST_CASE("a user's closed loop hovers with its arm hanging, at the power of hover") {
    const Problem problem = test::ceiling_problem();
    const auto model = make_flight_model(problem);
    const ClosedLoopOde ode(*model, nullptr);
    std::vector<double> rates;
    const double still[3] = {};
    ode(Ode::resting_at(1, 2, pi / 2), still, rates);
    for (std::size_t i = 0; i < Ode::energy; ++i) {
        CHECK(rates[i] == Approx(0).margin(1e-9));
    }
    // 4.95 kg on four rotors, 2.9 W / N^1.5
    CHECK(rates[Ode::energy] == Approx(4 * 2.9 * std::pow(4.95 * 9.80665 / 4, 1.5)));
}

TEST_CASE("a user's closed loop flies as ours does, but for the controller's ticks") {
    const Problem problem = test::ceiling_problem();
    const auto model = make_flight_model(problem);
    const auto map = model->make_map(problem.bounds);
    double factor = 1;
    CHECK(worst_difference(*model, nullptr, {-2, 2.5, 1.0}, factor) < 0.02);
    CHECK(worst_difference(*model, map.get(), {-2, 4.7, 1.0}, factor) < 0.02);
    CHECK(factor > 1.05);
}

TEST_CASE("a user's particle in the nominal world moves as without worlds, and hovers with what it really weighs") {
    const Problem problem = test::ceiling_problem();
    const auto model = make_flight_model(problem);
    const auto map = model->make_map(problem.bounds);
    const double velocity[3] = {0.3, -0.05, 0.2};
    std::vector<double> plain, nominal;
    const FlownWorld believed = make_world(problem.robot, {});
    const std::vector<double> state = Ode::resting_at(-2, 4.7, 1);
    ClosedLoopOde(*model, map.get())(state, velocity, plain);
    ClosedLoopOde(*model, map.get(), &believed)(state, velocity, nominal);
    for (std::size_t i = 0; i < Ode::size; ++i) {
        CHECK(nominal[i] == Approx(plain[i]).margin(1e-12));
    }

    World heavy;
    heavy.mass_scale = 0.1;
    heavy.thrust_scale = -0.05;
    const FlownWorld world = make_world(problem.robot, heavy);
    const ClosedLoopOde ode(*model, nullptr, &world);
    const std::vector<double> settled = ode.hovered(Ode::resting_at(1, 2, pi / 2), 20);
    CHECK(settled[Ode::z] == Approx(2).margin(0.01));
    std::vector<double> rates;
    const double still[3] = {};
    ode(settled, still, rates);
    // 4.5 kg and 10 % of that more, an arm of 0.45 kg; rotors have to be asked for 1 / 0.95 of the weight.
    CHECK(rates[Ode::energy] == Approx(4 * 2.9 * std::pow(5.4 * 9.80665 / 0.95 / 4, 1.5)).epsilon(1e-3));
}

TEST_CASE("a user's collisions are ours without a margin") {
    Problem problem = test::walled_problem();
    problem.obstacles.push_back({"pipe", Cylinder{0.3, 6, {0.2, 1, 0}}, {2, 0, 3}, {0.1, 0.2, 0.3}});
    problem.obstacles.push_back({"ball", Sphere{0.5}, {-3, 0.2, 3}, {}});
    const auto model = make_flight_model(problem);
    bench::PlainCollisions plain(problem);
    test::Random random(3);
    int free = 0;
    int unclear = 0;
    for (int i = 0; i < 2000; ++i) {
        const double q[4] = {random.uniform(-6, 6), random.uniform(0.2, 5), random.uniform(-0.5, 0.5),
                             random.uniform(-3, 3)};
        const double clearance_m = model->collisions().clearance_m({q[0], q[1], q[2], q[3]});
        if (clearance_m > 0 && clearance_m < 1e-3) {
            ++unclear;
            continue;
        }
        CHECK(plain.is_free(q) == (clearance_m > 0));
        free += clearance_m > 0 ? 1 : 0;
    }
    CHECK(free > 300);
    CHECK(free < 1900);
    CHECK(unclear < 20);
}
