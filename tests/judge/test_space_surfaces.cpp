#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "downwash/judge/space_surroundings.hpp"
#include "downwash/simulation/space_effect.hpp"
#include "downwash/simulation/space_surroundings.hpp"
#include "space_flights.hpp"

// What surfaces do to a vehicle at any attitude: the judge puts it together from fields of single discs, an execution
// asks for whole vehicles.

using namespace downwash;
using namespace downwash::test;
using Eigen::Vector3d;

namespace {

/// Surfaces on all sides of the origin, each over a part of a vehicle that is near it.
std::shared_ptr<const Scene> surfaces_around() {
    return std::make_shared<const Scene>(
        std::vector<Obstacle>{{"floor", Box{{2, 5, 0.2}}, {0.6, 0, -1.2}, {}},
                              {"pipe", Cylinder{0.2, 6, {0, 1, 0}}, {-1.2, 0, -1.5}, {}},
                              {"deck", Box{{3, 1.5, 0.2}}, {-0.5, 0.4, 1.4}, {}},
                              {"wall", Box{{0.2, 2, 6}}, {1.7, 0.5, 0}, {0, 0, 0.4}}});
}

AeroSettings of_several_rotors(EffectModel ground) {
    AeroSettings aero;
    aero.ground = ground;
    aero.ceiling = EffectModel::multirotor_images;
    aero.tilt_loss = {0.37, 0.2};
    aero.wall = {0.05, -0.03, 1.5};
    return aero;
}

template <int n>
void check_accelerations(EffectModel ground) {
    INFO("joints " << n << ", model " << info(ground).name);
    Random random(20 + n);
    const auto scene = surfaces_around();
    const AeroSettings aero = of_several_rotors(ground);
    const SpaceWorld nominal{};
    double worst = 0;      // difference over the size of the largest acceleration
    double strongest = 0;  // what images of others add to K
    double by_walls = 0, by_fountain = 0;
    const SpaceRobot robot = robot_of(random_space_plant(random, n));
    simulation::DirectSpaceEffect effect(scene, aero, robot);
    const SpaceSlipstreams none = no_space_slipstreams;
    const simulation::NominalSpace<double, simulation::SpaceEffect> around(effect, aero.tilt_loss, none);
    auto model = make_space_model<n>(robot.plant);
    model.has_fountain = ground == EffectModel::multirotor_body;
    model.has_walls = true;
    model.wall_force = aero.wall.force;
    model.wall_moment_m = aero.wall.moment * robot.rotor_radius_m;
    const judge::SpaceSurfaces surfaces(scene, aero, robot);
    const judge::SpaceSurroundings surroundings(&surfaces, nominal);
    const judge::SpaceVehicle vehicle = judge::vehicle_in(nominal, robot);
    const judge::SpacePlant plant(vehicle, surroundings);
    AeroSettings without_images = aero;
    without_images.ground = without_images.ceiling = EffectModel::cheeseman_bennett;
    const judge::SpaceSurfaces single_rotors(scene, without_images, robot);
    for (int k = 0; k < 50; ++k) {
        const auto state = random_space_state<n>(random, 0.1);
        std::vector<double> thrust_n;
        double all_n[max_rotors] = {};
        for (std::size_t i = 0; i < robot.plant.rotors.size(); ++i) {
            thrust_n.push_back(all_n[i] = random.uniform(1, 12));
        }
        const double no_nm[room_for<n>] = {};
        double du[6 + n];
        dynamics::accelerations(model, state.q, state.u, all_n, dynamics::rotor_spin_of(model, all_n), no_nm, around,
                                du);

        const judge::SpaceCoordinates at = test::coordinates_of<n>(state);
        const judge::BodyMotions bodies = judge::bodies_at(vehicle, at);
        const Eigen::VectorXd a = plant.accelerations(bodies, thrust_n, Eigen::VectorXd::Zero(n), Vector3d::Zero());
        const Vector3d turn = at.attitude.conjugate() * Vector3d(a.segment<3>(3));
        double size = 0, off = 0;
        for (int i = 0; i < 3; ++i) {
            size = std::max({size, std::abs(du[i]), std::abs(du[3 + i])});
            off = std::max({off, std::abs(a[i] - du[i]), std::abs(turn[i] - du[3 + i])});
        }
        worst = std::max(worst, off / size);

        std::vector<Vector3d> hubs_m;
        Vector3d center_m = Vector3d::Zero();
        for (const judge::FlyingRotor& rotor : vehicle.rotors) {
            hubs_m.push_back(at.position_m + at.attitude * rotor.hub_m);
            center_m += hubs_m.back() / static_cast<double>(vehicle.rotors.size());
        }
        const auto factors = surfaces.at_rotors(hubs_m);
        const auto single = single_rotors.at_rotors(hubs_m);
        for (std::size_t i = 0; i < factors.size(); ++i) {
            strongest = std::max(strongest, factors[i].all - single[i].all);
        }
        by_walls = std::max(by_walls, surfaces.towards_wall(center_m).norm());
        by_fountain = std::max(by_fountain, surfaces.fountain(hubs_m));
    }
    CHECK(worst < 1e-9);
    CHECK(strongest > 0.02);
    CHECK(by_walls > 0.5);
    CHECK((by_fountain > 0.03) == (ground == EffectModel::multirotor_body));
}

}  // namespace

TEST_CASE("The judge and the plant feel the same images of neighbours, fountains and walls at any attitude") {
    for (const EffectModel ground : {EffectModel::multirotor_images, EffectModel::multirotor_body}) {
        check_accelerations<0>(ground);
        check_accelerations<1>(ground);
        check_accelerations<3>(ground);
    }
}

TEST_CASE("The judge has images on one side alone, and a rotor's own model on the other") {
    Random random(3);
    const SpaceRobot robot = robot_of(random_space_plant(random, 0));
    AeroSettings aero = of_several_rotors(EffectModel::multirotor_images);
    aero.ceiling = EffectModel::sanchez_cuevas;
    const auto scene = surfaces_around();
    simulation::DirectSpaceEffect effect(scene, aero, robot);
    const judge::SpaceSurfaces surfaces(scene, aero, robot);
    for (int k = 0; k < 50; ++k) {
        const auto state = random_space_state<0>(random, 0);
        const judge::SpaceCoordinates at = test::coordinates_of<0>(state);
        std::vector<Vector3d> hubs_m;
        for (const SpaceRotor& rotor : robot.plant.rotors) {
            const Vector3 place = rotor.position_m;
            hubs_m.push_back(at.position_m + at.attitude * Vector3d(place[0], place[1], place[2]));
        }
        const auto mine = surfaces.at_rotors(hubs_m);
        for (std::size_t i = 0; i < mine.size(); ++i) {
            const auto theirs = effect.at_turned_rotor(
                static_cast<int>(i), {hubs_m[i].x(), hubs_m[i].y(), hubs_m[i].z()}, dynamics::rotation_of(state.q + 3));
            CHECK(mine[i].all == Approx(theirs.all).margin(1e-10));
            CHECK(mine[i].above == Approx(theirs.above).margin(1e-10));
        }
    }
}
