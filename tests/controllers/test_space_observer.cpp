#include <catch2/catch.hpp>

#include "../dynamics/random_space_plant.hpp"
#include "space_loop.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

/// A steady force in world axes and a steady torque in body axes on the multirotor.
struct Pushed : dynamics::CalmSpace {
    dynamics::LaneVector<double> force_n, torque_nm;
    template <class T, int n>
    void add_load(const T* /*q*/, const T* /*u*/, const dynamics::SpacePlaces<T, n>& places,
                  dynamics::SpaceLoad<T, n>& load) const {
        load.wrench.force_n = load.wrench.force_n + turned_back(places.attitude, force_n);
        load.wrench.torque_nm = load.wrench.torque_nm + torque_nm;
    }
};

}  // namespace

TEST_CASE("In space the observer settles at a steady force, torque and joint torque, and the vehicle at its place") {
    const SpaceLawModel<2> nominal = law_model_of<2>(hexarotor(2));
    SpaceInversion law = gains_for(nominal.plant);
    law.observer_gain_1_s = 5;
    // Nothing else may carry the disturbance.
    law.horizontal.ki_1_s3 = law.height.ki_1_s3 = law.joint.ki_1_s3 = law.rate_ki_1_s2 = 0;
    Pushed around;
    around.force_n = {1.5, -0.8, 2};
    around.torque_nm = {0.05, -0.08, 0.03};
    const double joint_nm[2] = {0.02, -0.01};
    auto state = hovering<2>(nominal.plant);
    auto memory = law.rested(nominal, state, space_tick_s);
    BasicSpacePoint<double, 2> point{};
    point.position[space::yaw] = 0.7;
    point.position[space::first_joint] = 0.5;
    for (int tick = 0; tick < 2000; ++tick) {
        SpaceInversion::Memory<double, 2> next;
        dynamics::SpaceCommand<double, 2> given;
        law.control(nominal, state, memory, point, space_tick_s, controllers::NoRatios{}, given, next);
        memory = next;
        for (int i = 0; i < 2; ++i) {
            given.joint_torque_nm[i] += joint_nm[i];
        }
        state = dynamics::space_step(nominal.plant, state, given, space_tick_s, around);
    }
    // At rest the memory is the estimate.
    const double expected[] = {1.5, -0.8, 2, 0.05, -0.08, 0.03, 0.02, -0.01};
    for (int i = 0; i < 8; ++i) {
        CAPTURE(i);
        CHECK(memory.observed[i] == Approx(expected[i]).margin(1e-6));
    }
    CHECK(off_m<2>(state, point) < 1e-6);
    CHECK(yaw_of<2>(state) == Approx(0.7).margin(0.02));  // of the tilted vehicle, whose first axis is not level
    CHECK(state.q[7] == Approx(0.5).margin(1e-6));
}

TEST_CASE("A law that knows its plant observes nothing in a lively flight but what a tick leaves out") {
    // Rotors without lag, so that the law knows what acts; the rest is the error of mid-tick.
    SpacePlant plant = hexarotor(2, 0);
    const SpaceLawModel<2> nominal = law_model_of<2>(plant);
    SpaceInversion law = gains_for(nominal.plant);
    auto state = hovering<2>(nominal.plant);
    auto memory = law.rested(nominal, state, space_tick_s);
    const auto worst_at = [&](double tick_s) {
        double worst = 0;
        state = hovering<2>(nominal.plant);
        memory = law.rested(nominal, state, tick_s);
        const int ticks = static_cast<int>(3 / tick_s);
        for (int tick = 0; tick < ticks; ++tick) {
            const double t = tick * tick_s;
            BasicSpacePoint<double, 2> point{};
            for (int i = 0; i < 6; ++i) {
                point.position[i] = 0.3 * std::sin((1 + 0.3 * i) * t);
                point.velocity[i] = 0.3 * (1 + 0.3 * i) * std::cos((1 + 0.3 * i) * t);
            }
            SpaceInversion::Memory<double, 2> next;
            dynamics::SpaceCommand<double, 2> given;
            law.control(nominal, state, memory, point, tick_s, controllers::NoRatios{}, given, next);
            const auto places = dynamics::places_at(nominal.plant, state.q);
            const auto e = dynamics::equations_of_motion(nominal.plant, places, state.u);
            const controllers::SpaceObservation<double, 2> seen(law.observer_gain_1_s, tick_s, nominal.plant, state,
                                                                places, e, memory.observed);
            for (int i = 0; i < 8; ++i) {
                worst = std::max(worst, std::abs(seen.force()[i]));
            }
            memory = next;
            state = dynamics::space_step(nominal.plant, state, given, tick_s, FreeSpace{});
        }
        return worst;
    };
    const double coarse = worst_at(0.01);
    const double fine = worst_at(0.0025);
    CAPTURE(coarse, fine);
    CHECK(coarse < 0.05);  // of some 25 N
    CHECK(fine < coarse / 3);
}

TEST_CASE("An estimate that is held is the same a tick later, whatever pushed in between") {
    Random random(12);
    constexpr double gain_1_s = 5;
    constexpr int numbers = dynamics::space_speeds<2>;
    for (int trial = 0; trial < 100; ++trial) {
        const SpaceModel<2> nominal = make_space_model<2>(random_space_plant(random, 2));
        const auto momentum_in = [&](const dynamics::SpaceState<double, 2>& state, double(&p)[numbers]) {
            const auto places = dynamics::places_at(nominal, state.q);
            dynamics::momentum(nominal, places, dynamics::equations_of_motion(nominal, places, state.u), state.u, p);
        };
        const auto estimate_in = [&](const dynamics::SpaceState<double, 2>& state, const double(&kept)[numbers]) {
            const auto places = dynamics::places_at(nominal, state.q);
            const auto e = dynamics::equations_of_motion(nominal, places, state.u);
            return controllers::SpaceObservation<double, 2>(gain_1_s, space_tick_s, nominal, state, places, e, kept);
        };
        const auto before = random_space_state<2>(random, 3);
        const auto after = random_space_state<2>(random, 3);
        double old[numbers], change[numbers], kept[numbers], held[numbers];
        momentum_in(before, old);
        momentum_in(after, change);
        for (int i = 0; i < numbers; ++i) {
            change[i] -= old[i];
            kept[i] = random.uniform(-3, 3);
        }
        controllers::hold_estimate<2>(gain_1_s, space_tick_s, change, kept, held);
        const auto first = estimate_in(before, kept);
        const auto second = estimate_in(after, held);
        for (int i = 0; i < numbers; ++i) {
            CHECK(second.force()[i] == Approx(first.force()[i]).margin(1e-9));
        }
    }
}

TEST_CASE("Half a tick on, coordinates are those of constant rates") {
    Random random(9);
    double worst = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const auto state = random_space_state<2>(random, 10);
        double at[9];
        controllers::advanced<double, 2>(state.q, state.u, 0.005, at);
        const dynamics::LaneVector<double> rate{state.u[3], state.u[4], state.u[5]};
        const double size = std::sqrt(dot(rate, rate));
        const auto expected =
            dynamics::rotation_of(state.q + 3) * dynamics::rotation_about((1 / size) * rate, 0.005 * size);
        const auto found = dynamics::rotation_of(at + 3);
        for (const auto& [a, b] : {std::pair{expected.first, found.first}, {expected.second, found.second}}) {
            worst = std::max({worst, std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
        }
    }
    CHECK(worst < 1e-9);
}
