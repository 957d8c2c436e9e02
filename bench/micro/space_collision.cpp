// Collision in space on the shipped bridge: queries per second of one core for a hexarotor with rotor discs and an arm
// of n joints, at poses all over the bounds and at those between two ticks of fast flight.

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "../../tests/support/random.hpp"
#include "bridge.hpp"
#include "downwash/scene/space_checker.hpp"

using namespace downwash;
using bench::Bridge;

namespace {

constexpr double pi = 3.14159265358979323846;

/// Sizes of a hexarotor of 0.37 m between opposite hubs.
SpaceRobotShape hexarotor(std::size_t links) {
    SpaceRobotShape robot;
    robot.bodies = {{Box{{0.2, 0.2, 0.1}}, {}}};
    for (int i = 0; i < 6; ++i) {
        const double angle = (30 + 60 * i) * pi / 180;
        robot.bodies.push_back(
            {Cylinder{0.089, 0.01, {0, 0, 1}}, {0.185 * std::cos(angle), 0.185 * std::sin(angle), 0.05}});
    }
    for (std::size_t i = 0; i < links; ++i) {
        SpaceLinkShape link;
        link.joint_m = {0, 0, i == 0 ? -0.1 : -0.13};
        link.axis = {0, -1, 0};
        link.lower_limit_rad = -1.67;
        link.upper_limit_rad = 1.67;
        link.bodies = {{Capsule{0.015, {0, 0, 0}, {0, 0, -0.13}}, {}}};
        robot.links.push_back(link);
    }
    return robot;
}

struct Motion {
    SpacePose from, to;  ///< a tick of 10 ms apart
};

std::vector<Motion> random_motions() {
    test::Random random(1);
    const Problem& problem = Bridge::get().problem;
    const Bounds& b = problem.bounds;
    std::vector<Motion> motions(1000);
    for (Motion& motion : motions) {
        motion.from.position_m = problem.plane.to_world(random.uniform(b.x_low_m, b.x_high_m), random.uniform(-1, 1),
                                                        random.uniform(b.z_low_m, b.z_high_m));
        motion.from.attitude =
            normalised({1, random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-1, 1)});
        motion.to = motion.from;
        for (std::size_t i = 0; i < 3; ++i) {
            motion.to.position_m[i] += random.uniform(-0.03, 0.03);
            motion.to.attitude[i + 1] += random.uniform(-0.02, 0.02);
            motion.from.joints_rad[i] = random.uniform(-1.6, 1.6);
            motion.to.joints_rad[i] = motion.from.joints_rad[i] + random.uniform(-0.03, 0.03);
        }
        motion.to.attitude = normalised(motion.to.attitude);
    }
    return motions;
}

/// Asks about every motion.
template <class Ask>
void each_motion(benchmark::State& state, std::size_t links, const Ask& ask) {
    const SpaceChecker checker(std::make_shared<const Scene>(Bridge::get().problem.obstacles), hexarotor(links));
    const std::vector<Motion> motions = random_motions();
    for ([[maybe_unused]] auto _ : state) {
        for (const Motion& motion : motions) {
            benchmark::DoNotOptimize(ask(checker, motion));
        }
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(motions.size()));
}

[[maybe_unused]] const bool space_collisions_are_registered = [] {
    const auto add = [](const std::string& name, std::size_t links, const auto& ask) {
        benchmark::RegisterBenchmark((name + "/" + std::to_string(links) + "_joints").c_str(),
                                     [links, ask](benchmark::State& state) { each_motion(state, links, ask); });
    };
    for (const std::size_t links : {0, 2, 3}) {
        add("collision_check_in_space", links,
            [](const SpaceChecker& checker, const Motion& m) { return checker.is_nearer_than(m.from, 0.05); });
        add("clearance_in_space", links,
            [](const SpaceChecker& checker, const Motion& m) { return checker.clearance_m(m.from); });
        add("self_collision", links,
            [](const SpaceChecker& checker, const Motion& m) { return checker.touching_bodies(m.from).has_value(); });
        add("collision_between_ticks", links, [](const SpaceChecker& checker, const Motion& m) {
            return checker.comes_nearer_between(m.from, m.to, 0.05);
        });
    }
    return true;
}();

}  // namespace
