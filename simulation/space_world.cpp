#include "downwash/simulation/space_world.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "downwash/base/lane_math.hpp"
#include "downwash/simulation/flight_memory.hpp"
#include "downwash/simulation/gusts.hpp"
#include "downwash/simulation/noise.hpp"

namespace downwash {
namespace simulation {
namespace {

dynamics::LaneVector<double> lane_vector(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

Matrix3 scaled(const Matrix3& m, double s) {
    return {s * m[0], s * m[1], s * m[2]};
}

/// The turn about an axis by its length, as a quaternion (w, x, y, z).
void set_turn(const Vector3& turn_rad, double out[4]) {
    const double angle_rad = std::sqrt(dot(turn_rad, turn_rad));
    const lane::SinCos half = lane::sin_cos(0.5 * angle_rad);
    const double scale = angle_rad > 0 ? half.sine / angle_rad : 0.5;
    out[0] = half.cosine;
    for (std::size_t i = 0; i < 3; ++i) {
        out[1 + i] = scale * turn_rad[i];
    }
}

GustPairNumbers<double> numbers_of(const GustPairFilter& filter) {
    return {filter.decay, filter.coupling, {filter.noise[0], filter.noise[1], filter.noise[2]}};
}

/// Gusts pass with the steady wind, or with 1 m/s where that is slower: a vehicle that hovers in calm air meets them as
/// one that flies through them. Without a level wind they pass along x.
void set_gusts(const SpaceWorld& world, double tick_s, SpaceWorldDifferences<double>& numbers) {
    const double level_m_s = std::sqrt(world.wind_m_s[0] * world.wind_m_s[0] + world.wind_m_s[1] * world.wind_m_s[1]);
    numbers.gust_cosine = level_m_s > 0 ? world.wind_m_s[0] / level_m_s : 1;
    numbers.gust_sine = level_m_s > 0 ? world.wind_m_s[1] / level_m_s : 0;
    if (!(world.gust_m_s > 0)) {
        return;
    }
    constexpr double least_speed_m_s = 1;
    const double speed_m_s = std::max(least_speed_m_s, std::sqrt(dot(world.wind_m_s, world.wind_m_s)));
    numbers.gust_m_s = world.gust_m_s;
    const double level_ticks = tick_s * speed_m_s / world.gust_length_level_m;
    const GustFilter along = gust_filter(level_ticks);
    numbers.gust_decay = along.decay;
    numbers.gust_noise = along.noise;
    numbers.gust_left = numbers_of(gust_pair_filter(level_ticks));
    numbers.gust_up = numbers_of(gust_pair_filter(tick_s * speed_m_s / world.gust_length_up_m));
}

}  // namespace

SpacePlant real_plant(const SpaceRobot& robot, const SpaceWorld& world) {
    SpacePlant plant = robot.plant;
    const double inertia_scale = 1 + world.inertia_scale;
    plant.multirotor.mass_kg *= 1 + world.mass_scale;
    plant.multirotor.inertia_kg_m2 = scaled(plant.multirotor.inertia_kg_m2, inertia_scale);
    for (std::size_t i = 0; i < plant.links.size(); ++i) {
        const double mass_scale = 1 + world.link_mass_scale[i];
        SpaceBody& body = plant.links[i].body;
        body.mass_kg *= mass_scale;
        body.inertia_kg_m2 = scaled(body.inertia_kg_m2, inertia_scale * mass_scale);
    }
    // The first joint, or the end effector without one, and the hubs stay where they are.
    Vector3& first_m = plant.links.empty() ? plant.end_effector_m : plant.links.front().joint_m;
    first_m = first_m - world.center_of_mass_m;
    for (SpaceRotor& rotor : plant.rotors) {
        rotor.position_m = rotor.position_m - world.center_of_mass_m;
    }
    plant.time_constant_s += world.rotor_time_constant_s;
    return plant;
}

SpaceWorldDifferences<double> differences_of(const SpaceRobot& robot, const SpaceWorld& world) {
    SpaceWorldDifferences<double> numbers{};
    numbers.center_of_mass_m = lane_vector(world.center_of_mass_m);
    for (int i = 0; i < max_rotors; ++i) {
        numbers.rotor_thrust_scale[i] = (1 + world.thrust_scale) * (1 + world.rotor_thrust_scale[i]);
    }
    numbers.ground_scale = world.ground_scale;
    numbers.ceiling_scale = world.ceiling_scale;
    numbers.scene_m = lane_vector(world.scene_m);
    const lane::SinCos turn = lane::sin_cos(world.scene_yaw_rad);
    numbers.scene_cosine = turn.cosine;
    numbers.scene_sine = turn.sine;
    numbers.wash_scale = 1 + world.wash_scale;
    numbers.delay_ticks = simulation::delay_ticks(robot.controller.delay_s + world.delay_s, robot.controller.rate_hz);
    numbers.position_bias_m = lane_vector(world.position_bias_m);
    set_turn(world.attitude_bias_rad, numbers.attitude_bias);
    numbers.position_noise_m = world.position_noise_m;
    numbers.velocity_noise_m_s = world.velocity_noise_m_s;
    numbers.gyro_noise_rad_s = world.gyro_noise_rad_s;
    numbers.wind_m_s = lane_vector(world.wind_m_s);
    set_gusts(world, 1 / robot.controller.rate_hz, numbers);
    return numbers;
}

void start_gusts(std::uint64_t tape, double gust[5]) {
    double noise[drawn_space_noise_count];
    draw_space_noise(normal_levels(), tape, -1, noise, 1);
    gust[0] = noise[0];
    start_gust_pair(noise[1], noise[2], gust + 1);
    start_gust_pair(noise[3], noise[4], gust + 3);
}

}  // namespace simulation

SpaceWorld without_noise(const SpaceWorld& world) noexcept {
    SpaceWorld quiet = world;
    quiet.position_noise_m = quiet.velocity_noise_m_s = quiet.gyro_noise_rad_s = quiet.gust_m_s = 0;
    return quiet;
}

Vector3 among_obstacles(const Vector3& point_m, const SpaceWorld& world) noexcept {
    const lane::SinCos turn = lane::sin_cos(world.scene_yaw_rad);
    const Vector3 from_m = point_m - world.scene_m;
    return {turn.cosine * from_m[0] + turn.sine * from_m[1], turn.cosine * from_m[1] - turn.sine * from_m[0],
            from_m[2]};
}

}  // namespace downwash
