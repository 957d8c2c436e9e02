// Ticks of flights in space: closed loop, law and plant, side by side in a pool and one at a time. `batch` in micro.cpp
// is the yardstick: flights in the plane of the same run.

#include <benchmark/benchmark.h>

#include <deque>
#include <string>
#include <vector>

#include "../../tests/support/space_robots.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/simulation/space_pool.hpp"

using namespace downwash;

namespace {

enum class Air { calm, volume, worlds };

constexpr double deck_z_m = 5;

/// The volumes around the robots' rotors under a deck.
const SurfaceVolumes& volumes_under_deck() {
    static const SurfaceVolumes volumes(std::make_shared<const Scene>(std::vector<Obstacle>{
                                            {"deck", Box{{30, 2.4, 0.3}}, {0, 0, deck_z_m + 0.15}, {}}}),
                                        {}, test::space_robot(0), {}, {-8, 8, 0, deck_z_m + 0.5}, -1.5, 1.5);
    return volumes;
}

SpacePoolSetup setup_of(const SpaceRobot& robot, Air air) {
    SpacePoolSetup setup{robot};
    if (air != Air::calm) {
        setup.volumes = &volumes_under_deck();
        setup.aero = simulation::space_aero(AeroSettings{}, robot.rotor_radius_m);
    }
    return setup;
}

/// Worlds that differ in everything, with noise and gusts.
const std::vector<SpaceWorld>& worlds() {
    static const std::vector<SpaceWorld> all = [] {
        std::vector<SpaceWorld> some(64);
        for (std::size_t i = 0; i < some.size(); ++i) {
            const double s = static_cast<double>(i) / 64 - 0.5;
            SpaceWorld& world = some[i];
            world.ceiling_scale = 0.2 * s;
            world.mass_scale = 0.05 * s;
            world.center_of_mass_m = {0.004 * s, -0.006 * s, 0};
            world.thrust_scale = -0.04 * s;
            world.scene_m = {0, 0.01 * s, 0.02 * s};
            world.delay_s = 0.008 + 0.01 * s;
            world.attitude_bias_rad = {0.004 * s, 0.002, 0};
            world.wind_m_s = {s, 0.3, 0};
            world.position_noise_m = 0.005;
            world.gyro_noise_rad_s = 0.01;
            world.gust_m_s = 0.3;
            world.gust_length_level_m = 20;
            world.gust_length_up_m = 5;
            world.tape = i;
        }
        return some;
    }();
    return all;
}

/// Edges of 3 m and 4 s under the deck, 0.3 to 0.6 m below it.
std::vector<SpaceFlightJob> edges(const SpacePool& pool, int joints, Air air) {
    std::vector<SpaceFlightJob> jobs;
    for (int i = 0; i < 64; ++i) {
        const double s = i / 64.0;
        SpacePoint from, to;
        from.position[space::x] = -6 + 6 * s;
        from.position[space::z] = deck_z_m - 0.6 + 0.3 * s;
        to.position[space::x] = -3 + 6 * s;
        to.position[space::y] = 0.4 - 0.8 * s;
        to.position[space::z] = deck_z_m - 0.3 - 0.3 * s;
        to.position[space::yaw] = 0.8 - s;
        for (int joint = 0; joint < joints; ++joint) {
            to.position[space::first_joint + joint] = 0.6 - s;
        }
        const SpaceWorld* const world = air == Air::worlds ? &worlds()[static_cast<std::size_t>(i)] : nullptr;
        jobs.push_back({pool.state_at(test::motion_at_rest(from), world), {{{from, to, 400, 0.01}}}, world});
    }
    return jobs;
}

void side_by_side(benchmark::State& state, int joints, Air air, Instructions instructions, int threads) {
    const SpaceRobot robot = test::space_robot(joints);
    SpacePool pool(setup_of(robot, air), threads, instructions);
    const std::vector<SpaceFlightJob> all = edges(pool, joints, air);
    std::int64_t ticks = 0;
    for ([[maybe_unused]] auto _ : state) {
        std::vector<SpaceFlightJob> jobs = all;
        pool.fly(jobs);
        for (const SpaceFlightJob& job : jobs) {
            ticks += job.legs[0].flight.ticks;
        }
    }
    state.SetItemsProcessed(ticks);
}

void one_at_a_time(benchmark::State& state, int joints, Air air) {
    const SpaceRobot robot = test::space_robot(joints);
    const SpacePoolSetup setup = setup_of(robot, air);
    const std::vector<SpaceFlightJob> all = edges(SpacePool(setup), joints, air);
    const auto effect = [&]() -> std::unique_ptr<simulation::SpaceEffect> {
        if (setup.volumes == nullptr) {
            return std::make_unique<simulation::NoEffectInSpace>();
        }
        return std::make_unique<simulation::VolumeSpaceEffect>(*setup.volumes, robot);
    }();
    std::deque<std::unique_ptr<simulation::SpaceLoop>> loops;
    for (const SpaceFlightJob& job : all) {
        loops.push_back(simulation::make_space_loop(
            {robot, job.world != nullptr ? *job.world : SpaceWorld{}, *effect, setup.aero, /*is_refined=*/false}));
    }
    std::int64_t ticks = 0;
    for ([[maybe_unused]] auto _ : state) {
        for (std::size_t i = 0; i < all.size(); ++i) {
            const SpaceSegment& segment = all[i].legs[0].segment;
            loops[i]->start(test::motion_at_rest(segment.from()));
            for (std::int64_t tick = 0; tick < segment.ticks(); ++tick) {
                SpaceFlightRow row;
                loops[i]->tick(tick, segment.at_tick(tick), row);
            }
            ticks += segment.ticks();
        }
    }
    state.SetItemsProcessed(ticks);
}

/// With every set of instructions that there is here, with two threads, and one at a time.
[[maybe_unused]] const bool flights_in_space_are_registered = [] {
    constexpr const char* names[] = {"baseline", "avx2", "avx512"};
    for (const int joints : {0, 2, 3}) {
        for (const Air air : {Air::calm, Air::volume, Air::worlds}) {
            const std::string variant = "flights_in_space/" + std::to_string(joints) + "_joints" +
                                        (air == Air::calm     ? "_"
                                         : air == Air::volume ? "_volume_"
                                                              : "_in_worlds_");
            benchmark::RegisterBenchmark((variant + "one_at_a_time").c_str(), one_at_a_time, joints, air);
            for (const Instructions instructions : known_instructions()) {
                benchmark::RegisterBenchmark((variant + names[static_cast<int>(instructions)]).c_str(), side_by_side,
                                             joints, air, instructions, 1);
            }
            benchmark::RegisterBenchmark((variant + "two_threads").c_str(), side_by_side, joints, air,
                                         best_instructions(), 2)
                ->UseRealTime();
        }
    }
    return true;
}();

}  // namespace
