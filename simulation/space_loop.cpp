#include "downwash/simulation/space_loop.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <variant>

#include "downwash/base/key_error.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/simulation/space_vehicle.hpp"

#ifndef DOWNWASH_MAX_JOINTS
#error "the build says how many joints an arm in space may have"
#endif

namespace downwash {

int max_built_joints() noexcept {
    return DOWNWASH_MAX_JOINTS;
}

namespace {

/// The numbers of a law's memory by the number of joints.
template <class Law, int... n>
int memory_size_of(int joints, std::integer_sequence<int, n...> /*all*/) {
    static constexpr int sizes[] = {number_count<double, typename Law::template Memory<double, n>>...};
    return sizes[joints];
}

}  // namespace

SpacePose among_obstacles(const SpaceMotion& motion, const SpaceWorld& world) noexcept {
    SpacePose pose;
    pose.position_m = among_obstacles(motion.position_m, world);
    const lane::SinCos half = lane::sin_cos(-0.5 * world.scene_yaw_rad);
    const auto& q = motion.attitude;
    pose.attitude = {half.cosine * q[0] - half.sine * q[3], half.cosine * q[1] - half.sine * q[2],
                     half.cosine * q[2] + half.sine * q[1], half.cosine * q[3] + half.sine * q[0]};
    std::copy(motion.joints_rad.begin(), motion.joints_rad.end(), pose.joints_rad.begin());
    return pose;
}

int memory_size(const SpaceLaw& law, int joints) noexcept {
    return std::visit(
        [joints]<class Law>(const Law& /*law*/) {
            return memory_size_of<Law>(joints, std::make_integer_sequence<int, max_joints + 1>());
        },
        law);
}

SpaceCarry carry_of(const SpaceRobot& robot, const AnySpaceState& vehicle) {
    const double* const thrust_n = vehicle.plant.thrust_n;
    const double* const memory = vehicle.memory.number;
    return {{thrust_n, thrust_n + robot.plant.rotors.size()},
            {memory, memory + memory_size(robot.controller.law, robot.joints())}};
}

namespace simulation {

// space_loop_of.hpp has the arithmetic; this file needs the names alone.
template <int n>
std::unique_ptr<SpaceLoop> make_space_loop_of(const SpaceLoopSetup& setup);

namespace {

template <int... n>
std::unique_ptr<SpaceLoop> made(const SpaceLoopSetup& setup, std::integer_sequence<int, n...> /*built*/) {
    using Make = std::unique_ptr<SpaceLoop> (*)(const SpaceLoopSetup&);
    static constexpr Make make[] = {&make_space_loop_of<n>...};
    return make[setup.robot.joints()](setup);
}

}  // namespace

SpaceAero space_aero(const AeroSettings& aero, double rotor_radius_m) {
    if (!aero.enabled) {
        return {};
    }
    return {aero.map ? TiltLoss{} : aero.tilt_loss, aero.wall.force, aero.wall.moment * rotor_radius_m,
            !aero.map && aero.ground.model == EffectModel::multirotor_body};
}

void require_built_joints(const SpaceRobot& robot) {
    if (robot.joints() > DOWNWASH_MAX_JOINTS) {
        throw_input_error("has " + std::to_string(robot.joints()) + " joints, but this build flies arms of up to " +
                              std::to_string(DOWNWASH_MAX_JOINTS) +
                              ": configure it with -DDOWNWASH_MAX_JOINTS=" + std::to_string(robot.joints()),
                          "robot.arm");
    }
}

std::unique_ptr<SpaceLoop> make_space_loop(const SpaceLoopSetup& setup) {
    require_built_joints(setup.robot);
    return made(setup, std::make_integer_sequence<int, DOWNWASH_MAX_JOINTS + 1>());
}

}  // namespace simulation
}  // namespace downwash
