#include <catch2/catch.hpp>
#include <cmath>

#include "../support/single_tick.hpp"
#include "downwash/controllers/control.hpp"
#include "downwash/simulation/surroundings.hpp"
#include "hover_scenes.hpp"

// Laws that read surface effects from a map.

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr double gravity = 9.80665;

/// The fit of the ceiling effect a distance below.
double ceiling_ratio(double gap_m) {
    const double r = radius_m / (gap_m + 0.3168 * radius_m);
    return 1 / (1 - r * r / 6.924);
}

/// The wide ceiling, and loops without integrals: what they have to ask for shows as an error.
Problem problem_reading(const std::optional<controllers::FeedForward>& feed_forward) {
    Problem problem = ceiling_alone();
    gains_of(problem.robot).position_ki = 0;
    gains_of(problem.robot).height_kp = 12;
    gains_of(problem.robot).height_kd = 7;
    gains_of(problem.robot).aids.feed_forward = feed_forward;
    return problem;
}

/// How far above its reference a vehicle comes to rest whose reference is so far below the ceiling.
double settled_error_m(const Problem& problem, double gap_m, const FlownWorld* world = nullptr) {
    const auto model = make_flight_model(problem);
    const double z_m = ceiling_m - gap_m - hub_height_m;
    FlightState state = model->state_at({0, z_m, 0, quarter_turn});
    for (int i = 0; i < 4000; ++i) {
        controllers::Actuation<double> given{};
        state = single_quiet_tick(*model, state, at_rest({0, z_m, quarter_turn}), given, world);
    }
    CHECK(std::abs(state.plant.u[1]) < 1e-6);
    return state.plant.q[1] - z_m;
}

/// The same by hand: K_acting / K_read (g - kp e) = g, by bisection.
template <class Read>
double error_by_hand_m(double gap_m, double kp, const Read& read_ratio, double strength = 1) {
    double low = -0.3;
    double high = gap_m - 0.01;
    while (high - low > 1e-9) {
        const double e = 0.5 * (low + high);
        const double acting = 1 + strength * (ceiling_ratio(gap_m - e) - 1);
        (acting / read_ratio(gap_m - e) * (gravity - kp * e) > gravity ? low : high) = e;
    }
    return low;
}

}  // namespace

TEST_CASE("the rotors act as demanded at any pose and tilt if the map is right, with a fountain too") {
    Random random(6);
    for (const bool has_fountain : {false, true}) {
        Problem problem = cluttered_problem();
        if (has_fountain) {
            problem.aero.ground = EffectModel::multirotor_body;
        }
        problem.aero.tilt_loss = {0.37, 0.2};
        gains_of(problem.robot).aids.feed_forward.emplace();
        const auto model = make_flight_model(problem);
        const PlantModel& plant = model->tick().plant;
        REQUIRE(plant.has_fountain == has_fountain);
        int near_surfaces = 0;
        for (int i = 0; i < 200; ++i) {
            const PlanarPose pose{random.uniform(-2, 4), random.uniform(0.3, 4.8), random.uniform(-0.3, 0.3),
                                  random.uniform(-1, 1)};
            const FlightState state = model->state_at(pose);
            const auto motion = dynamics::motion_at(plant, state.plant.q, state.plant.u);
            simulation::DirectField field(*model);
            const simulation::NominalSurroundings<double, simulation::DirectField> around(field,
                                                                                          model->tick().tilt_loss);
            controllers::Actuation<double> given{};
            const double thrust_n = random.uniform(40, 60);
            const double torque_nm = random.uniform(-2, 2);
            const double observed[4] = {};
            controllers::Aid aid(gains_of(problem.robot).aids, plant, state.plant, motion, observed, 0.01, around);
            const auto believed = aid.command_rotors(plant, state.plant, thrust_n, torque_nm, 0.01, 0, given);
            REQUIRE(given.saturation < 1);
            const auto wrench =
                dynamics::rotor_wrench(plant, motion.attitude, pose.x_m, pose.z_m, given.command.thrust_n, around);
            CHECK(wrench.thrust_n == Approx(thrust_n).epsilon(1e-12));
            CHECK(wrench.pitch_torque_nm == Approx(torque_nm).margin(1e-11));
            CHECK(believed.thrust_n == Approx(thrust_n).epsilon(1e-12));
            CHECK(believed.pitch_torque_nm == Approx(torque_nm).margin(1e-11));
            double commanded_n = 0;
            for (int k = 0; k < 4; ++k) {
                commanded_n += given.command.thrust_n[k];
            }
            near_surfaces += std::abs(commanded_n - thrust_n) > 1 ? 1 : 0;
        }
        CHECK(near_surfaces > 20);
    }
}

TEST_CASE("a map that is right cancels the steady pull of a ceiling to 1 percent") {
    for (const double gap_m : {0.25, 0.3, 0.4}) {
        const double plain_m = settled_error_m(problem_reading({}), gap_m);
        CHECK(plain_m == Approx(error_by_hand_m(gap_m, 12, [](double) { return 1.0; })).margin(1e-4));
        CHECK(plain_m > 0.02);
        CHECK(std::abs(settled_error_m(problem_reading(controllers::FeedForward{}), gap_m)) < 0.01 * plain_m);
    }
}

TEST_CASE("a map that has the ceiling 3 or 5 cm too high or too low loses part of that") {
    const double gap_m = 0.3;
    const double plain_m = settled_error_m(problem_reading({}), gap_m);
    double lost_before = 0;
    for (const double offset_m : {0.03, 0.05, -0.03, -0.05}) {
        const double error_m = settled_error_m(problem_reading(controllers::FeedForward{0, offset_m}), gap_m);
        const auto read = [&](double at_gap_m) { return ceiling_ratio(at_gap_m + offset_m); };
        CHECK(error_m == Approx(error_by_hand_m(gap_m, 12, read)).margin(1e-4));
        const double lost = error_m / plain_m;  // 1: as bad as no map
        if (offset_m > 0) {
            CHECK(lost > lost_before);
            CHECK(lost < 0.45);
        } else {
            CHECK(lost < 0);  // the law counters more than there is, and sinks
            CHECK(lost > -0.45);
        }
        lost_before = offset_m == 0.05 ? 0 : lost;
    }
}

TEST_CASE("a law reads the map of what is believed: in a world with a stronger ceiling the rest of it stays") {
    const double gap_m = 0.3;
    const Problem problem = problem_reading(controllers::FeedForward{});
    World strong;
    strong.ceiling_scale = 0.2;
    const FlownWorld stronger = make_world(problem.robot, strong);
    const auto read = [](double at_gap_m) { return ceiling_ratio(at_gap_m); };
    CHECK(settled_error_m(problem, gap_m, &stronger) == Approx(error_by_hand_m(gap_m, 12, read, 1.2)).margin(1e-4));

    World low;
    low.scene_z_m = -0.04;  // the ceiling is nearer than the map has it
    const FlownWorld lower = make_world(problem.robot, low);
    const auto read_higher = [](double at_gap_m) { return ceiling_ratio(at_gap_m + 0.04); };
    CHECK(settled_error_m(problem, gap_m, &lower) ==
          Approx(error_by_hand_m(gap_m - 0.04, 12, read_higher)).margin(1e-4));
}

TEST_CASE("over an edge a map that is right leaves the vehicle level without a pitch reference") {
    Problem problem = problem_reading({});
    problem.obstacles = {box("plate", {4, 4, 1}, {2, 0, 0.5})};  // under half of the front rotors
    const double x_m = -0.3;
    const double z_m = 1.25;
    const auto pitch_reference = [&] {
        return analyse_hover(*make_flight_model(problem), x_m, z_m, -quarter_turn).trim.pitch_reference_rad;
    };
    const double without_rad = pitch_reference();
    gains_of(problem.robot).aids.feed_forward.emplace();
    const double with_rad = pitch_reference();
    gains_of(problem.robot).aids.feed_forward->offset_x_m = 0.05;
    const double shifted_rad = pitch_reference();
    CHECK(std::abs(without_rad) > 1e-3);
    CHECK(std::abs(with_rad) < 1e-9);
    CHECK(std::abs(shifted_rad) > 0.1 * std::abs(without_rad));
    CHECK(std::abs(shifted_rad) < 0.5 * std::abs(without_rad));
}

TEST_CASE("a map that is right lets a vehicle hover below a ceiling down to the flyable area, a wrong one less near") {
    const auto boundary_m = [](const auto& is_stable) {
        double low = 0.058;
        double high = 1;
        while (high - low > 1e-5) {
            const double middle = 0.5 * (low + high);
            (is_stable(middle) ? high : low) = middle;
        }
        return high;
    };
    const auto found_m = [&](double offset_z_m) {
        Problem problem = ceiling_alone();
        gains_of(problem.robot).aids.feed_forward = controllers::FeedForward{0, offset_z_m};
        const auto model = make_flight_model(problem);
        return boundary_m([&](double gap_m) { return below_ceiling(*model, gap_m).verdict == HoldVerdict::stable; });
    };
    // With R = K / K_read the loop is s^3 + R kd s^2 + (R kp - g R'/R) s + R ki, stable while R kp - g R'/R > ki / kd.
    const auto by_hand_m = [&](double offset_m) {
        return boundary_m([&](double gap_m) {
            const auto ratio = [&](double at_m) { return ceiling_ratio(at_m) / ceiling_ratio(at_m + offset_m); };
            const double slope_1_m = (ratio(gap_m - 1e-5) - ratio(gap_m + 1e-5)) / 2e-5;
            return ratio(gap_m) * 2.0 - gravity * slope_1_m / ratio(gap_m) > 0.4 / 2.6;
        });
    };
    CHECK(found_m(0) < 0.059);
    double before_m = 0.059;
    for (const double offset_m : {0.01, 0.03, 0.05}) {
        const double found = found_m(offset_m);
        CHECK(found == Approx(by_hand_m(offset_m)).margin(0.004));  // sampling costs a little
        CHECK(found > before_m);
        CHECK(found < 0.25);  // 0.32 m without a map
        before_m = found;
    }
}
