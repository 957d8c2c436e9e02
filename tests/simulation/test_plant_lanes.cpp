#include "downwash/base/lane_pack.hpp"
//
#include <catch2/catch.hpp>
#include <cstring>
#include <vector>

#include "../support/random.hpp"
#include "../support/test_robot.hpp"
#include "downwash/simulation/closed_loop.hpp"

// Every lane flies a vehicle of its own, of which the controller knows nothing.

using namespace downwash;

namespace {

using lane::Pack;

/// What a world has beside its plant, in every lane.
template <class T>
struct Surroundings {
    T effect_scale;    ///< of K - 1
    T scene_offset_m;  ///< by which the surfaces are higher than the controller's map has them
    T thrust_scale;

    /// K falls off from a ground at z = 0.
    T operator()(int /*rotor*/, T /*x_m*/, T z_m) const {
        return thrust_scale *
               (T(1) + effect_scale * (T(0.1) / (T(1) + (z_m - scene_offset_m) * (z_m - scene_offset_m))));
    }
};

Robot varied(Robot robot, test::Random& random) {
    robot.multirotor.mass_kg *= random.uniform(0.95, 1.05);
    robot.multirotor.pitch_inertia_kg_m2 *= random.uniform(0.9, 1.1);
    robot.arm.mass_kg *= random.uniform(0.9, 1.1);
    robot.arm.joint_x_m += random.uniform(-0.01, 0.01);
    robot.arm.joint_z_m += random.uniform(-0.01, 0.01);
    for (Vector3& hub_m : robot.rotors.positions_m) {
        hub_m[0] += 0.005;
    }
    robot.rotors.time_constant_s *= random.uniform(0.8, 1.5);
    return robot;
}

/// Puts a struct of doubles into a lane of a struct of packs.
template <class Packs, class Doubles>
void set_lane(Packs& packs, int lane, const Doubles& from) {
    static_assert(number_count<Pack, Packs> == number_count<double, Doubles>);
    for (int i = 0; i < number_count<double, Doubles>; ++i) {
        Pack pack = number_at<Pack>(packs, i);
        lane::set_number(pack, lane, number_at<double>(from, i));
        set_number_at(packs, i, pack);
    }
}

/// The robot with rotors that lag.
struct Fixture {
    Robot robot = [] {
        Robot lagging = test::test_robot();
        lagging.rotors.time_constant_s = 0.02;
        return lagging;
    }();
    ModelInversion law = test::gains_of(robot);
    simulation::TickModel known{test::plant_of(robot), law, 0.01};
    ReferencePoint reference{{0.3, 1.4, 0.2}, {}, {}};
};

}  // namespace

TEST_CASE_METHOD(Fixture, "lanes with vehicles and surfaces of their own fly each as it flies alone, to the last bit") {
    constexpr int ticks = 400;
    test::Random random(11);
    std::vector<PlantModel> plants;
    std::vector<Surroundings<double>> worlds;
    simulation::State<double> start{};
    start.plant.q[1] = 1.5;
    start.plant.q[3] = 0.5;
    BasicPlantModel<Pack> plant_lanes{};
    Surroundings<Pack> world_lanes{};
    simulation::State<Pack> lanes{};
    BasicReferencePoint<Pack> reference_lanes{};
    for (int lane = 0; lane < lane::width<Pack>; ++lane) {
        plants.push_back(test::plant_of(varied(robot, random)));
        worlds.push_back({random.uniform(0.7, 1.4), random.uniform(-0.05, 0.05), random.uniform(0.95, 1.05)});
        static_cast<PlantStructure&>(plant_lanes) = plants.back();
        set_lane<PlantNumbers<Pack>, PlantNumbers<double>>(plant_lanes, lane, plants.back());
        set_lane(world_lanes, lane, worlds.back());
        set_lane(lanes, lane, start);
        set_lane(reference_lanes, lane, reference);
    }
    for (int i = 0; i < ticks; ++i) {
        controllers::Actuation<Pack> given{};
        lanes = simulation::tick_of_other_plant(known, law, plant_lanes, lanes, lanes.plant, reference_lanes,
                                                world_lanes, given);
    }
    for (int lane = 0; lane < lane::width<Pack>; ++lane) {
        simulation::State<double> alone = start;
        for (int i = 0; i < ticks; ++i) {
            controllers::Actuation<double> given{};
            alone =
                simulation::tick_of_other_plant(known, law, plants[static_cast<std::size_t>(lane)], alone, alone.plant,
                                                reference, worlds[static_cast<std::size_t>(lane)], given);
        }
        INFO("lane " << lane);
        for (int i = 0; i < number_count<double, simulation::State<double>>; ++i) {
            CHECK(lane::number_in(number_at<Pack>(lanes, i), lane) == number_at<double>(alone, i));
        }
        CHECK(alone.plant.q[0] == Approx(0.3).margin(0.2));  // it flies, not as the nominal vehicle would
        CHECK(alone.plant.q[0] != lane::number_in(lanes.plant.q[0], (lane + 1) % lane::width<Pack>));
    }
}

TEST_CASE_METHOD(Fixture, "a plant as its controller knows it flies the tick of the closed loop") {
    const test::FreeAir free_air;
    simulation::State<double> one{};
    simulation::State<double> other{};
    for (int i = 0; i < 200; ++i) {
        controllers::Actuation<double> given{};
        one = simulation::tick(known, one, reference, free_air, given);
        other =
            simulation::tick_of_other_plant(known, law, known.plant, other, other.plant, reference, free_air, given);
    }
    CHECK(std::memcmp(&one, &other, sizeof one) == 0);
    CHECK(one.plant.q[0] > 0.1);
}
