#include <catch2/catch.hpp>
#include <cmath>

#include "../support/random.hpp"
#include "../support/test_problem.hpp"
#include "downwash/dynamics/flight_step.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/simulation/direct_field.hpp"
#include "downwash/simulation/surroundings.hpp"
#include "downwash/simulation/vehicle_effect.hpp"

// The vehicle of the tests: four rotors of R = 0.1905 m at x = +-0.32 m, 0.06 m over its centre of mass; 4.95 kg.

using namespace downwash;

namespace {

constexpr double rotor_radius_m = 0.1905;
constexpr double reach_m = 0.32;
constexpr double rotor_height_m = 0.06;
constexpr double weight_n = 4.95 * 9.80665;

std::shared_ptr<const FlightModel> model_among(std::vector<Obstacle> obstacles) {
    Problem problem = test::ceiling_problem();
    problem.obstacles = std::move(obstacles);
    return make_flight_model(problem);
}

/// K, and its slope over the height of a rotor.
struct Factor {
    double value;
    double slope_1_m;
};

/// Cheeseman and Bennett's.
Factor ground_factor(double z_m) {
    const double r = rotor_radius_m / (4 * z_m);
    const double k = 1 / (1 - r * r);
    return {k, -2 * k * k * r * r / z_m};
}

/// The fit of the ceiling effect on a rotor `gap_m` below.
Factor ceiling_factor(double gap_m) {
    const double r = rotor_radius_m / (gap_m + 0.3168 * rotor_radius_m);
    const double k = 1 / (1 - r * r / 6.924);
    return {k, 2 * k * k * r * r / 6.924 / (gap_m + 0.3168 * rotor_radius_m)};
}

/// How the effect changes with the pose: a spring, or the opposite of one.
struct Slopes {
    double force_n_m;      ///< dF/dz
    double torque_nm_rad;  ///< dT2/dpitch
};

/// By central differences over 1 mm and 1 mrad.
Slopes slopes_of(const FlightModel& model, const PlanarPose& pose) {
    constexpr double step = 1e-3;
    const auto effect = [&](double rise_m, double turn_rad) {
        return vehicle_effect(model, {pose.x_m, pose.z_m + rise_m, pose.pitch_rad + turn_rad, pose.arm_rad});
    };
    return {weight_n * (effect(step, 0).force_factor - effect(-step, 0).force_factor) / (2 * step),
            (effect(0, step).pitch_torque_nm - effect(0, -step).pitch_torque_nm) / (2 * step)};
}

}  // namespace

TEST_CASE("far from everything a vehicle feels no surface") {
    const VehicleEffect effect = vehicle_effect(*model_among({}), {1, 2, 0.2, 0});
    const Slopes slopes = slopes_of(*model_among({}), {1, 2, 0.2, 0});
    CHECK(effect.force_factor == Approx(1).epsilon(1e-14));
    CHECK(std::abs(effect.pitch_torque_nm) < 1e-13);
    CHECK(std::abs(slopes.force_n_m) < 1e-9);
    CHECK(std::abs(slopes.torque_nm_rad) < 1e-9);
}

TEST_CASE("two rotors of four over a plate carry more and push the nose up, under a ceiling pull up their side") {
    // The plate ends below the centre of mass; the front rotors' discs lie over it one radius high, the others beside
    // it.
    const auto model = model_among({test::box("plate", {4, 4, 1}, {2, 0, 0.5})});
    const VehicleEffect effect = vehicle_effect(*model, {0, 1 + rotor_radius_m - rotor_height_m, 0, 0});
    // K = 1 / (1 - 1/16) = 16/15 for the two in front, each carrying a quarter of the weight.
    CHECK(effect.force_factor == Approx(31.0 / 30).epsilon(1e-9));
    CHECK(effect.pitch_torque_nm == Approx(-reach_m * weight_n / 2 / 15).epsilon(1e-9));  // -0.518 Nm
    CHECK(effect.pitch_torque_factor == Approx(-reach_m / 30 / rotor_radius_m).epsilon(1e-9));
    const double z_m = 2 - 1.5 * rotor_radius_m - rotor_height_m;
    const double torque_nm = reach_m * weight_n / 2 * (ceiling_factor(1.5 * rotor_radius_m).value - 1);
    for (const double side : {1.0, -1.0}) {
        const auto below = model_among({test::box("slab", {4, 4, 1}, {2 * side, 0, 2.5})});
        CHECK(vehicle_effect(*below, {0, z_m, 0, 0}).pitch_torque_nm == Approx(-side * torque_nm).epsilon(1e-9));
    }
}

TEST_CASE("wide ground carries like a spring and rights the vehicle, a wide ceiling pulls it up and tips it over") {
    const auto check = [](const FlightModel& model, double hub_m, const Factor& k) {
        const PlanarPose pose{0.4, hub_m - rotor_height_m, 0, 0};
        const VehicleEffect effect = vehicle_effect(model, pose);
        const Slopes slopes = slopes_of(model, pose);
        CHECK(effect.force_factor == Approx(k.value).epsilon(1e-9));
        CHECK(std::abs(effect.pitch_torque_nm) < 1e-9);
        const double slope_n_m = weight_n * k.slope_1_m;
        CHECK(slopes.force_n_m == Approx(slope_n_m).epsilon(1e-3));
        // Every rotor moves by reach per radian: the spring with its lever twice.
        CHECK(slopes.torque_nm_rad == Approx(reach_m * reach_m * slope_n_m).epsilon(1e-3));
        return slopes;
    };
    const auto over_ground = model_among({test::box("ground", {30, 20, 1}, {0, 0, -0.5})});
    for (const double height_m : {0.15, 0.3, 0.6}) {
        CHECK(check(*over_ground, height_m, ground_factor(height_m)).force_n_m < 0);
    }
    const auto below_ceiling = model_among({test::box("ceiling", {30, 20, 1}, {0, 0, 5.5})});
    for (const double gap_m : {0.1, 0.2, 0.5}) {
        CHECK(check(*below_ceiling, 5 - gap_m, ceiling_factor(gap_m)).torque_nm_rad > 0);
    }
}

TEST_CASE(
    "over wide ground every rotor of a vehicle that pitches loses what its tilt takes, under a ceiling none does") {
    const auto ground = model_among({{"floor", Box{{80, 80, 1}}, {0, 0, -0.5}, {}}});
    const auto ceiling = model_among({{"roof", Box{{80, 80, 1}}, {0, 0, 5.5}, {}}});
    for (const double pitch : {-0.5, -0.1, 0.0, 0.2, 0.35}) {
        const auto hub_z_m = [&](double x_m) { return rotor_height_m * std::cos(pitch) - x_m * std::sin(pitch); };
        double over_ground = 0;
        double under_ceiling = 0;
        for (const double x_m : {-reach_m, reach_m}) {
            const double change = ground_factor(0.7 + hub_z_m(x_m)).value - 1;
            const double sine = std::sin(pitch);
            over_ground += 0.5 * (1 + change * change / (change + 0.37 * sine * sine));
            under_ceiling += 0.5 * ceiling_factor(0.5 - hub_z_m(x_m)).value;
        }
        CHECK(vehicle_effect(*ground, {0, 0.7, pitch, 1.57}).force_factor == Approx(over_ground).epsilon(1e-9));
        CHECK(vehicle_effect(*ceiling, {0, 4.5, pitch, 1.57}).force_factor == Approx(under_ceiling).epsilon(1e-9));
    }
}

TEST_CASE("over wide ground the fountain lifts the whole vehicle as its formula says") {
    Problem problem = test::ceiling_problem();
    problem.obstacles = {test::box("ground", {30, 20, 1}, {0, 0, -0.5})};
    problem.aero.ground = EffectModel::multirotor_body;
    const auto model = make_flight_model(problem);
    const double d_m = 2 * reach_m;  // square; the centre between the rotors is d / sqrt(2) from each
    const double b_m = d_m / std::sqrt(2.0);
    for (const double z_m : {0.3, 0.5, 0.8}) {
        const auto image = [z_m](double distance_m) {
            return z_m / std::pow(distance_m * distance_m + 4 * z_m * z_m, 1.5);
        };
        const double rotors =
            rotor_radius_m * rotor_radius_m * (1 / (16 * z_m * z_m) + image(d_m) + 0.5 * image(std::sqrt(2.0) * d_m));
        const double body = 2 * rotor_radius_m * rotor_radius_m * 2 * image(b_m);  // thesis (2.17) with K_b = 2
        const VehicleEffect effect = vehicle_effect(*model, {0.4, z_m - rotor_height_m, 0, 0});
        const Slopes slopes = slopes_of(*model, {0.4, z_m - rotor_height_m, 0, 0});
        CHECK(effect.force_factor == Approx(1 / (1 - rotors - body)).epsilon(1e-6));
        CHECK(std::abs(effect.pitch_torque_nm) < 1e-9);
        CHECK(slopes.force_n_m < 0);
    }
}

TEST_CASE("mirroring scene and vehicle mirrors the parasitic torque and nothing else") {
    test::Random random(3);
    for (int scene = 0; scene < 40; ++scene) {
        std::vector<Obstacle> here;
        std::vector<Obstacle> mirrored;
        for (int i = 0; i < 4; ++i) {
            const Vector3 size_m = {random.uniform(0.2, 2), random.uniform(0.2, 2), random.uniform(0.1, 1)};
            const Vector3 center_m = {random.uniform(-2, 2), random.uniform(-0.5, 0.5), random.uniform(0, 4)};
            here.push_back(test::box("box", size_m, center_m));
            mirrored.push_back(test::box("box", size_m, {-center_m[0], center_m[1], center_m[2]}));
        }
        const PlanarPose pose{random.uniform(-2, 2), random.uniform(0, 4), random.uniform(-0.5, 0.5), 0};
        const VehicleEffect a = vehicle_effect(*model_among(here), pose);
        const VehicleEffect b = vehicle_effect(*model_among(mirrored), {-pose.x_m, pose.z_m, -pose.pitch_rad, 0});
        const Slopes c = slopes_of(*model_among(here), pose);
        const Slopes d = slopes_of(*model_among(mirrored), {-pose.x_m, pose.z_m, -pose.pitch_rad, 0});
        CHECK(a.force_factor == Approx(b.force_factor).epsilon(1e-9));
        CHECK(a.pitch_torque_nm == Approx(-b.pitch_torque_nm).margin(1e-7));
        CHECK(c.force_n_m == Approx(d.force_n_m).epsilon(1e-6).margin(1e-4));
        CHECK(c.torque_nm_rad == Approx(d.torque_nm_rad).epsilon(1e-6).margin(1e-4));
    }
}

TEST_CASE("a vehicle is flyable as long as its outermost disc is") {
    const auto model = model_among({test::box("wall", {1, 8, 8}, {3.5, 0, 0})});  // its face at x = 3
    const double least_x_m = 3 - (1.3 * rotor_radius_m + reach_m);                // min_distance_radii is 0.3
    CHECK(is_flyable(*model, {least_x_m - 1e-6, 2, 0, 0}));
    CHECK_FALSE(is_flyable(*model, {least_x_m + 1e-6, 2, 0, 0}));
    // Tilted, its hubs come nearer by 0.32 cos(0.3) + 0.06 sin(0.3).
    const double tilted_x_m = 3 - (1.3 * rotor_radius_m + reach_m * std::cos(0.3) + rotor_height_m * std::sin(0.3));
    CHECK(is_flyable(*model, {tilted_x_m - 1e-6, 2, 0.3, 0}));
    CHECK_FALSE(is_flyable(*model, {tilted_x_m + 1e-6, 2, 0.3, 0}));
}

TEST_CASE("A wall pushes a hovering vehicle away and pulls the side towards it down, as its shares of the thrust say") {
    Problem problem = test::ceiling_problem();
    problem.obstacles = {{"wall", Box{{1, 40, 10}}, {1.5, 0, 2}, {}}};
    problem.aero.wall = {0.02, 0.04, 0.5};
    const auto model = make_flight_model(problem);
    const PlanarPose pose{0.3, 2, 0, -std::acos(-1.0) / 2};
    // The wall is 0.7 m from the centre: 0.38 m from the nearest hub.
    const double nearness = std::exp(-(0.7 - reach_m - rotor_radius_m) / (0.5 * rotor_radius_m));
    const VehicleEffect effect = vehicle_effect(*model, pose);
    CHECK(effect.force_factor == Approx(1).margin(1e-12));
    CHECK(effect.pitch_torque_nm == Approx(0.04 * rotor_radius_m * nearness * weight_n).epsilon(1e-4));

    const PlantModel& plant = model->tick().plant;
    const FlightState state = model->state_at(pose);
    double command_n[max_rotors];
    dynamics::allocate(plant, weight_n, 0.0, command_n);
    const auto motion = dynamics::motion_at(plant, state.plant.q, state.plant.u);
    double with[4];
    double without[4];
    simulation::DirectField field(*model);
    const simulation::NominalSurroundings<double, simulation::DirectField> around(field, no_tilt_loss);
    dynamics::accelerations(plant, state.plant.q, state.plant.u, motion, command_n, 0.0, around, with);
    PlantModel free = plant;
    free.has_walls = false;
    dynamics::accelerations(free, state.plant.q, state.plant.u, motion, command_n, 0.0, around, without);
    // The generalised forces that make the difference: the push along x, the moment on the pitch alone.
    double more[4];
    double less[4];
    dynamics::inverse_dynamics(plant, motion.equations, with, more);
    dynamics::inverse_dynamics(plant, motion.equations, without, less);
    CHECK(more[0] - less[0] == Approx(-0.02 * nearness * weight_n).epsilon(1e-4));
    CHECK(more[1] - less[1] == Approx(0).margin(1e-9));
    CHECK(more[2] - less[2] == Approx(0.04 * rotor_radius_m * nearness * weight_n).epsilon(1e-4));
    CHECK(more[3] - less[3] == Approx(0).margin(1e-9));
}
