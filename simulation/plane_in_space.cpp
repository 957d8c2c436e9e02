#include "downwash/simulation/plane_in_space.hpp"

#include <algorithm>

#include "downwash/controllers/axes.hpp"
#include "downwash/controllers/space_axes.hpp"

namespace downwash {

SpaceWorld in_space(const World& world, const PlaneOfMotion& plane) {
    SpaceWorld space;
    space.ceiling_scale = world.ceiling_scale;
    space.ground_scale = world.ground_scale;
    space.scene_m = vector_in_space(world.scene_x_m, world.scene_z_m, plane);
    space.mass_scale = world.mass_scale;
    space.inertia_scale = world.inertia_scale;
    space.link_mass_scale[0] = world.arm_mass_scale;
    space.center_of_mass_m = {world.center_of_mass_x_m, 0, world.center_of_mass_z_m};
    space.thrust_scale = world.thrust_scale;
    std::copy_n(world.rotor_thrust_scale, max_rotors, space.rotor_thrust_scale);
    space.wash_scale = world.arm_wash_scale;
    space.rotor_time_constant_s = world.rotor_time_constant_s;
    space.delay_s = world.delay_s;
    space.position_bias_m = vector_in_space(world.position_bias_x_m, world.position_bias_z_m, plane);
    space.attitude_bias_rad = {0, world.pitch_bias_rad, 0};
    space.wind_m_s = vector_in_space(world.wind_x_m_s, world.wind_z_m_s, plane);
    space.position_noise_m = world.position_noise_m;
    space.velocity_noise_m_s = world.velocity_noise_m_s;
    space.gyro_noise_rad_s = world.gyro_noise_rad_s;
    space.gust_m_s = world.gust_m_s;
    space.gust_length_level_m = world.gust_length_x_m;
    space.gust_length_up_m = world.gust_length_z_m;
    return space;
}

SpacePoint in_space(const ReferencePoint& point, const PlaneOfMotion& plane) {
    SpacePoint space;
    const auto set = [](const Vector3& place, double joint, double(&axes)[space_axes<max_joints>]) {
        std::copy_n(place.begin(), 3, axes);
        axes[space::first_joint] = joint;
    };
    set(plane.to_world(point.position[plane::x], 0, point.position[plane::z]), point.position[plane::arm],
        space.position);
    set(vector_in_space(point.velocity[plane::x], point.velocity[plane::z], plane), point.velocity[plane::arm],
        space.velocity);
    set(vector_in_space(point.acceleration[plane::x], point.acceleration[plane::z], plane),
        point.acceleration[plane::arm], space.acceleration);
    space.position[space::yaw] = plane.heading_rad();
    return space;
}

}  // namespace downwash
