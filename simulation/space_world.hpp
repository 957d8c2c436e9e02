#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/dynamics/space_step.hpp"
#include "downwash/simulation/space_robot.hpp"
#include "downwash/simulation/space_world_description.hpp"
#include "downwash/simulation/space_world_numbers.hpp"

namespace downwash {

/// A world in space as a flight needs it.
template <int n>
struct FlownSpaceWorld {
    simulation::SpaceWorldNumbers<double, n> numbers;
    bool has_noise;      ///< Noise in what the controller sees, or gusts.
    std::uint64_t tape;  ///< See SpaceWorld.
};

namespace simulation {

/// What a world in space remembers of a flight one lane wide; see FlightMemory.
template <int n>
struct SpaceFlightMemory : SpaceWorldMemory<double, n> {
    /// Where the vehicle was recent_ticks + 1 ticks ago, one tick before that, ...; see FlightMemory.
    std::vector<PastSpaceMotion<double, n>> older;
};

/// The plant that really flies, seen from the multirotor's true centre of mass.
[[nodiscard]] DOWNWASH_EXPORT SpacePlant real_plant(const SpaceRobot& robot, const SpaceWorld& world);

/// The differences of a world besides plant and joints.
[[nodiscard]] DOWNWASH_EXPORT SpaceWorldDifferences<double> differences_of(const SpaceRobot& robot,
                                                                           const SpaceWorld& world);

/// The filter states of the gusts as a flight begins: they blow already. @param[out] gust see SpaceWorldMemory
DOWNWASH_EXPORT void start_gusts(std::uint64_t tape, double gust[5]);

}  // namespace simulation

/// Prepares a world for the tick.
/// @pre the robot has n joints and is sound; scales are above -1, the rotors' time constant stays at least half a tick
/// where the robot has a lag, and the delay stays within 0 and simulation::max_delay_ticks, but for rounding
template <int n>
[[nodiscard]] FlownSpaceWorld<n> make_space_world(const SpaceRobot& robot, const SpaceWorld& world) {
    FlownSpaceWorld<n> flown{};
    static_cast<simulation::SpaceWorldDifferences<double>&>(flown.numbers) = simulation::differences_of(robot, world);
    flown.numbers.plant = make_space_model<n>(simulation::real_plant(robot, world));
    for (int i = 0; i < n; ++i) {
        flown.numbers.joint_offset_rad[i] = world.joint_offset_rad[i];
    }
    flown.has_noise =
        world.position_noise_m > 0 || world.velocity_noise_m_s > 0 || world.gyro_noise_rad_s > 0 || world.gust_m_s > 0;
    flown.tape = world.tape;
    return flown;
}

/// A world without its noise and gusts.
[[nodiscard]] DOWNWASH_EXPORT SpaceWorld without_noise(const SpaceWorld& world) noexcept;

/// What a world remembers as a flight begins: the vehicle was always in this state, and gusts blow already.
template <int n>
[[nodiscard]] simulation::SpaceFlightMemory<n> memory_at_start(const FlownSpaceWorld<n>& world,
                                                               const dynamics::SpaceState<double, n>& state) {
    simulation::SpaceFlightMemory<n> memory{};
    for (simulation::PastSpaceMotion<double, n>& past : memory.past) {
        std::copy_n(state.q, dynamics::space_coordinates<n>, past.q);
        std::copy_n(state.u, dynamics::space_speeds<n>, past.u);
    }
    if (world.has_noise) {
        simulation::start_gusts(world.tape, memory.gust);
    }
    return memory;
}

/// A point of the world, where surfaces and obstacles are in their nominal places.
[[nodiscard]] DOWNWASH_EXPORT Vector3 among_obstacles(const Vector3& point_m, const SpaceWorld& world) noexcept;

}  // namespace downwash
