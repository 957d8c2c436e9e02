// Direct effects in space at any attitude, against the level vehicle of the plane and against sums by hand, and volumes
// against direct effects.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "../support/random.hpp"
#include "../support/scratch_folder.hpp"
#include "../support/space_robots.hpp"
#include "../support/volume_scenes.hpp"
#include "downwash/base/lane_pack.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/effects/effect_models.hpp"
#include "downwash/simulation/space_flight.hpp"
#include "downwash/simulation/surface_volumes.hpp"

using namespace downwash;
using dynamics::LaneRotation;
using dynamics::LaneVector;
using test::space_robot;

namespace {

constexpr double radius = 0.12;

LaneRotation<double> attitude_of(double yaw_rad, double tilt_rad, double about_rad) {
    const double half = 0.5 * tilt_rad;
    const double tilt[4] = {std::cos(half), std::sin(half) * std::cos(about_rad), std::sin(half) * std::sin(about_rad),
                            0};
    const double yaw[4] = {std::cos(0.5 * yaw_rad), 0, 0, std::sin(0.5 * yaw_rad)};
    return dynamics::rotation_of(tilt) * dynamics::rotation_of(yaw);
}

Vector3 vector_of(const LaneVector<double>& v) {
    return {v.x, v.y, v.z};
}

AeroSettings of_several_rotors(EffectModel ground) {
    AeroSettings aero;
    aero.ground = ground;
    return aero;
}

/// A step in the floor, and a plate above it that ends.
std::vector<Obstacle> steps() {
    return {{"floor", Box{{20, 20, 1}}, {0, 0, -0.5}, {}},
            {"step", Box{{2, 20, 0.4}}, {1.2, 0, 0.2}, {}},
            {"plate", Box{{3, 2, 0.1}}, {0, 1.1, 1.3}, {0, 0, 0.3}}};
}

std::vector<Vector3> hubs_of(const SpaceRobot& robot) {
    std::vector<Vector3> hubs_m;
    for (const SpaceRotor& rotor : robot.plant.rotors) {
        hubs_m.push_back(rotor.position_m);
    }
    return hubs_m;
}

LaneVector<double> hub_at(const SpaceRobot& robot, std::size_t rotor, const LaneVector<double>& at_m,
                          const LaneRotation<double>& attitude) {
    const Vector3& p = robot.plant.rotors[rotor].position_m;
    return at_m + attitude * LaneVector<double>{p[0], p[1], p[2]};
}

}  // namespace

TEST_CASE("A level vehicle feels the images and the fountain of the planar effects at its heading") {
    const SpaceRobot robot = space_robot(0);
    const std::vector<Vector3> hubs_m = hubs_of(robot);
    const auto scene = std::make_shared<const Scene>(steps());
    AeroSettings aero = of_several_rotors(EffectModel::multirotor_body);
    aero.ceiling = EffectModel::multirotor_images;
    simulation::DirectSpaceEffect effect(scene, aero, robot);
    test::Random random(80);
    double felt = 0;
    for (int i = 0; i < 60; ++i) {
        const double yaw_rad = i == 0 ? 0 : random.uniform(-3, 3);
        const LaneRotation<double> attitude = attitude_of(yaw_rad, 0, 0);
        const LaneVector<double> at_m{random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8), random.uniform(0.5, 1)};
        for (std::size_t rotor = 0; rotor < hubs_m.size(); ++rotor) {
            const LaneVector<double> hub_m = hub_at(robot, rotor, at_m, attitude);
            const DirectEffect planar(scene, aero, radius, neighbours_of(hubs_m, rotor, radius, yaw_rad));
            const SidedFactor<double> expected = planar.sided_factor(vector_of(hub_m));
            const SidedFactor<double> k = effect.at_turned_rotor(static_cast<int>(rotor), hub_m, attitude);
            CHECK(k.all == Approx(expected.all).margin(1e-9));
            CHECK(k.above == Approx(expected.above).margin(1e-9));
            felt = std::max(felt, std::abs(k.all - 1));
            if (i == 0) {
                CHECK(effect.at_rotor(static_cast<int>(rotor), hub_m).all == k.all);
            }
        }
        const DirectEffect planar =
            DirectEffect::fountain(scene, aero, radius, neighbours_of(hubs_m, 0, radius, yaw_rad));
        const LaneVector<double> center_m{at_m.x, at_m.y, at_m.z + 0.05};
        CHECK(effect.at_turned_body(center_m, attitude).all == Approx(planar.factor(vector_of(center_m))).margin(1e-9));
    }
    CHECK(felt > 0.05);
}

TEST_CASE("Over a wide floor a tilted vehicle feels the images of rotors at their real heights") {
    const SpaceRobot robot = space_robot(0);
    const std::vector<Vector3> hubs_m = hubs_of(robot);
    const auto floor =
        std::make_shared<const Scene>(std::vector<Obstacle>{{"floor", Box{{40, 40, 1}}, {0, 0, -0.5}, {}}});
    const AeroSettings aero = of_several_rotors(EffectModel::multirotor_body);
    simulation::DirectSpaceEffect effect(floor, aero, robot);
    test::Random random(81);
    for (int i = 0; i < 100; ++i) {
        const LaneRotation<double> attitude =
            attitude_of(random.uniform(-3, 3), random.uniform(0, 0.6), random.uniform(-3, 3));
        const LaneVector<double> at_m{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.45, 0.9)};
        double height[6];
        for (std::size_t k = 0; k < 6; ++k) {
            height[k] = hub_at(robot, k, at_m, attitude).z / radius;
        }
        double fountain = 0;
        for (std::size_t k = 0; k < 6; ++k) {
            // Thesis (2.14) and (2.15); of two discs the image acts by the lesser of what both feel of it.
            double loss = 1 / (16 * height[k] * height[k]);
            for (std::size_t j = 0; j < 6; ++j) {
                const double d = std::hypot(hubs_m[j][0] - hubs_m[k][0], hubs_m[j][1] - hubs_m[k][1]) / radius;
                const auto image = [d](double z) { return 0.5 * z / std::pow(d * d + 4 * z * z, 1.5); };
                loss += j == k ? 0 : std::min(image(height[k]), image(height[j]));
            }
            const SidedFactor<double> found =
                effect.at_turned_rotor(static_cast<int>(k), hub_at(robot, k, at_m, attitude), attitude);
            CHECK(found.all == Approx(1 / (1 - loss)).margin(1e-8));
            CHECK(found.above == 1);
            const RotorNeighbours neighbours = neighbours_of(hubs_m, k, radius);
            fountain += (formula_factor(EffectModel::multirotor_body, height[k], neighbours) -
                         formula_factor(EffectModel::multirotor_images, height[k], neighbours)) /
                        6;
        }
        const LaneVector<double> center_m = at_m + attitude * LaneVector<double>{0, 0, 0.05};
        CHECK(effect.at_turned_body(center_m, attitude).all == Approx(1 + fountain).margin(1e-8));
    }
}

TEST_CASE("Beside a step a rotor feels that the vehicle turns about its hub") {
    const SpaceRobot robot = space_robot(0);
    const auto scene = std::make_shared<const Scene>(steps());
    const AeroSettings aero = of_several_rotors(EffectModel::multirotor_images);
    simulation::DirectSpaceEffect effect(scene, aero, robot);
    const LaneVector<double> hub_m{0.25, 0, 0.55};
    double least = 2, most = 0;
    for (int i = 0; i < 12; ++i) {
        const LaneRotation<double> attitude = attitude_of(0.5 * i, 0.02 * i, 1);
        simulation::DirectSpaceEffect fresh(scene, aero, robot);
        const double expected = fresh.at_turned_rotor(2, hub_m, attitude).all;
        CHECK(effect.at_turned_rotor(2, hub_m, attitude).all == expected);
        CHECK(effect.at_turned_rotor(2, hub_m, attitude).all == expected);
        least = std::min(least, expected);
        most = std::max(most, expected);
    }
    CHECK(most - least > 0.01);
}

TEST_CASE("A world that turns the scene with the vehicle changes no image, and a fountain carries weight") {
    const SpaceRobot robot = space_robot(0);
    const auto scene = std::make_shared<const Scene>(std::vector<Obstacle>{
        {"plate", Box{{1, 4, 1}}, {0.5, 0, -0.5}, {}}, {"floor", Box{{9, 9, 1}}, {0, 0, -1}, {}}});
    const auto hover = [&](EffectModel ground, double yaw_rad, double scene_yaw_rad) {
        const AeroSettings aero = of_several_rotors(ground);
        simulation::DirectSpaceEffect effect(scene, aero, robot);
        SpacePlan plan;
        plan.tick_s = 0.01;
        SpacePoint here;
        here.position[space::z] = 0.35;
        here.position[space::yaw] = yaw_rad;
        plan.reference = {{0, here}, {600, here}};
        SpaceFlightSettings settings;
        settings.effect = &effect;
        settings.aero = simulation::space_aero(aero, robot.rotor_radius_m);
        settings.world.scene_yaw_rad = scene_yaw_rad;
        return fly(robot, plan, test::motion_at_rest(here), settings);
    };
    const SpaceFlight nominal = hover(EffectModel::multirotor_images, 0, 0);
    const SpaceFlight together = hover(EffectModel::multirotor_images, 0.7, 0.7);
    const SpaceFlight alone = hover(EffectModel::multirotor_images, 0.7, 0);
    const SpaceFlight lifted = hover(EffectModel::multirotor_body, 0, 0);
    REQUIRE(nominal.outcome == Outcome::ok);
    REQUIRE(lifted.outcome == Outcome::ok);
    double differs = 0;
    double command_n = 0;
    double lifted_n = 0;
    for (std::size_t i = 0; i < 6; ++i) {
        CHECK(together.rows.back().rotor_factor[i] == Approx(nominal.rows.back().rotor_factor[i]).margin(1e-9));
        differs = std::max(differs, std::abs(alone.rows.back().rotor_factor[i] - nominal.rows.back().rotor_factor[i]));
        command_n += nominal.rows.back().rotor_lag_n[i];
        lifted_n += lifted.rows.back().rotor_lag_n[i];
    }
    CHECK(differs > 1e-3);
    CHECK(lifted_n < 0.99 * command_n);
}

TEST_CASE("Flights through volumes feel what direct effects give, in lanes to the last bit") {
    SpaceRobot robot = space_robot(1);
    const test::VolumeSite bay = test::girder_bay();
    const auto scene = std::make_shared<const Scene>(bay.obstacles);
    AeroSettings aero;
    aero.wall = {0.02, 0.04, 0.7};
    const SurfaceVolumes volumes(scene, aero, robot, bay.frame, {-6, 6, 1, 4}, -7, 7);
    simulation::VolumeSpaceEffect looked_up(volumes, robot);
    simulation::DirectSpaceEffect direct(scene, aero, robot);
    VolumePatches<lane::width<lane::Pack>> patches;
    VolumeLookUp<lane::Pack> lanes(volumes.rotor->view(), patches);
    test::Random random(82);
    double worst = 0;
    double walls = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vector3 at = bay.any(random);
        const LaneVector<double> hub_m{at[0], at[1], at[2]};
        const bool is_flyable = direct.is_flyable(i % 6, hub_m);
        REQUIRE(looked_up.is_flyable(i % 6, hub_m) == is_flyable);
        if (!is_flyable) {
            continue;
        }
        const SidedFactor<double> k = looked_up.at_rotor(i % 6, hub_m);
        const SidedFactor<double> expected = direct.at_rotor(i % 6, hub_m);
        worst = std::max({worst, std::abs(k.all - expected.all), std::abs(k.above - expected.above)});
        const auto towards = looked_up.wall_nearness(hub_m);
        const auto expected_wall = direct.wall_nearness(hub_m);
        walls = std::max({walls, std::abs(towards.x - expected_wall.x), std::abs(towards.y - expected_wall.y)});
        const SidedFactor<lane::Pack> pack = lanes.at(lane::Pack(hub_m.x), lane::Pack(hub_m.y), lane::Pack(hub_m.z));
        REQUIRE(lane::number_in(pack.all, i % lane::width<lane::Pack>) == k.all);
        REQUIRE(lane::number_in(pack.above, i % lane::width<lane::Pack>) == k.above);
    }
    CAPTURE(worst, walls);
    CHECK(worst <= 0.01);
    CHECK(walls <= 0.01);

    // Up to just below the deck and back.
    SpacePlan plan = test::space_plan(1);
    for (SpaceKnot& knot : plan.reference) {
        knot.point.position[space::x] -= 3;
        knot.point.position[space::y] += 1.485;
        knot.point.position[space::z] += 1;
    }
    SpaceFlightSettings settings;
    settings.aero = simulation::space_aero(aero, robot.rotor_radius_m);
    settings.effect = &direct;
    const SpaceFlight by_direct = fly(robot, plan, test::motion_at_rest(plan.reference.front().point), settings);
    settings.effect = &looked_up;
    const SpaceFlight by_volume = fly(robot, plan, test::motion_at_rest(plan.reference.front().point), settings);
    simulation::VolumeSpaceEffect again(volumes, robot);
    settings.effect = &again;
    const SpaceFlight repeated = fly(robot, plan, test::motion_at_rest(plan.reference.front().point), settings);
    REQUIRE(by_direct.rows.size() == by_volume.rows.size());
    REQUIRE(by_direct.outcome == by_volume.outcome);
    CHECK(by_direct.outcome == Outcome::ok);
    double apart_m = 0;
    double felt = 0;
    for (std::size_t i = 0; i < by_direct.rows.size(); ++i) {
        const Vector3 between = by_direct.rows[i].motion.position_m - by_volume.rows[i].motion.position_m;
        apart_m = std::max(apart_m, std::sqrt(dot(between, between)));
        felt = std::max(felt, std::abs(by_direct.rows[i].rotor_factor[0] - 1));
        REQUIRE(repeated.rows[i].motion == by_volume.rows[i].motion);
    }
    CAPTURE(apart_m, felt);
    CHECK(apart_m < 2e-3);
    CHECK(felt > 0.005);
}

TEST_CASE("Volumes of one image each give K of several rotors at any attitude, and come back from a cache") {
    const SpaceRobot robot = space_robot(0);
    const auto scene = std::make_shared<const Scene>(steps());
    const AeroSettings aero = of_several_rotors(EffectModel::multirotor_body);
    SurfaceVolumes volumes(scene, aero, robot, {}, {-1.5, 1.5, 0.1, 1.3}, -1.5, 1.5);
    CHECK(volumes.images.size() == 3);
    simulation::VolumeSpaceEffect looked_up(volumes, robot);
    simulation::DirectSpaceEffect direct(scene, aero, robot);
    test::Random random(83);
    double worst = 0;
    double of_body = 0;
    double felt = 0;
    for (int i = 0; i < 2000; ++i) {
        const LaneRotation<double> attitude =
            attitude_of(random.uniform(-3, 3), random.uniform(0, 0.5), random.uniform(-3, 3));
        const LaneVector<double> at_m{random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8), random.uniform(0.3, 1)};
        const int rotor = i % 6;
        const LaneVector<double> hub_m = hub_at(robot, static_cast<std::size_t>(rotor), at_m, attitude);
        if (!direct.is_flyable(rotor, hub_m)) {
            continue;
        }
        const SidedFactor<double> k = looked_up.at_turned_rotor(rotor, hub_m, attitude);
        const SidedFactor<double> expected = direct.at_turned_rotor(rotor, hub_m, attitude);
        worst = std::max({worst, std::abs(k.all - expected.all), std::abs(k.above - expected.above)});
        of_body = std::max(of_body, std::abs(looked_up.at_turned_body(hub_m, attitude).all -
                                             direct.at_turned_body(hub_m, attitude).all));
        felt = std::max(felt, expected.all - 1);
    }
    CAPTURE(worst, of_body, felt);
    // Errors of the parts add up, and near the cap of 2 the sum of losses counts four times.
    CHECK(worst <= 0.03);
    CHECK(of_body <= 0.01);
    CHECK(felt > 0.1);

    const test::ScratchFolder folder;
    volumes.keep(folder.path());
    SurfaceVolumes again(scene, aero, robot, {}, {-1.5, 1.5, 0.1, 1.3}, -1.5, 1.5);
    again.read(folder.path());
    CHECK(again.rotor->to_bytes() == volumes.rotor->to_bytes());
    CHECK(again.fountain->to_bytes() == volumes.fountain->to_bytes());
    CHECK(again.images[2].map->to_bytes() == volumes.images[2].map->to_bytes());
    CHECK(again.images[2].map->to_bytes() != volumes.images[1].map->to_bytes());
}

TEST_CASE("Flights on several threads through the same volumes are those on one thread") {
    const SpaceRobot robot = space_robot(0);
    const test::VolumeSite bay = test::girder_bay();
    const auto scene = std::make_shared<const Scene>(bay.obstacles);
    const auto flown = [&](int threads) {
        const SurfaceVolumes volumes(scene, {}, robot, bay.frame, {-6, 6, 1, 4}, -7, 7);
        std::vector<Vector3> ends_m(8);
        run_parallel(ends_m.size(), threads, [&](std::size_t i) {
            SpacePlan plan = test::space_plan(0);
            for (SpaceKnot& knot : plan.reference) {
                knot.point.position[space::x] -= 3 - 0.05 * static_cast<double>(i);
                knot.point.position[space::y] += 1.485;
                knot.point.position[space::z] += 1;
            }
            simulation::VolumeSpaceEffect effect(volumes, robot);
            SpaceFlightSettings settings;
            settings.effect = &effect;
            settings.aero = simulation::space_aero({}, robot.rotor_radius_m);
            ends_m[i] = fly(robot, plan, test::motion_at_rest(plan.reference.front().point), settings)
                            .rows.back()
                            .motion.position_m;
        });
        return std::pair(ends_m, volumes.rotor->to_bytes());
    };
    CHECK(flown(4) == flown(1));
}
