#include "downwash/judge/space_vehicle.hpp"

#include <cmath>
#include <cstddef>

#include "downwash/judge/placement.hpp"

namespace downwash::judge {
namespace {

Eigen::Matrix3d matrix_of(const Matrix3& m) {
    Eigen::Matrix3d out;
    out << m[0][0], m[0][1], m[0][2], m[1][0], m[1][1], m[1][2], m[2][0], m[2][1], m[2][2];
    return out;
}

}  // namespace

double SpaceVehicle::mass_kg() const noexcept {
    double sum_kg = 0;
    for (const FlyingBody& body : bodies) {
        sum_kg += body.mass_kg;
    }
    return sum_kg;
}

SpaceVehicle vehicle_in(const SpaceWorld& world, const SpaceRobot& robot) {
    const ::downwash::SpacePlant& plant = robot.plant;
    const Eigen::Vector3d off = vector_of(world.center_of_mass_m);
    const double inertia_scale = 1 + world.inertia_scale;
    SpaceVehicle v{};
    v.center_of_mass_m = off;
    v.bodies.push_back(
        {plant.multirotor.mass_kg * (1 + world.mass_scale), matrix_of(plant.multirotor.inertia_kg_m2) * inertia_scale});
    // From the centre of mass of a body to the origin of the frame in which the file places the next joint.
    Eigen::Vector3d to_frame = -off;
    for (std::size_t i = 0; i < plant.links.size(); ++i) {
        const SpaceLink& link = plant.links[i];
        const double mass_scale = 1 + world.link_mass_scale[i];
        v.bodies.push_back(
            {link.body.mass_kg * mass_scale, matrix_of(link.body.inertia_kg_m2) * (inertia_scale * mass_scale)});
        FlyingJoint joint{};
        joint.in_inner_m = to_frame + vector_of(link.joint_m);
        to_frame = -vector_of(link.center_of_mass_m);
        joint.in_outer_m = to_frame;
        joint.axis = vector_of(link.axis).normalized();
        joint.viscous_friction_nm_s = link.viscous_friction_nm_s;
        joint.coulomb_friction_nm = link.coulomb_friction_nm;
        joint.stop = link.stop;
        joint.max_torque_nm = robot.links[i].max_torque_nm;
        joint.link_m = vector_of(i + 1 < plant.links.size() ? plant.links[i + 1].joint_m : plant.end_effector_m);
        joint.drag = link.drag;
        v.joints.push_back(joint);
    }
    v.end_effector_m = to_frame + vector_of(plant.end_effector_m);
    for (std::size_t i = 0; i < plant.rotors.size(); ++i) {
        const SpaceRotor& rotor = plant.rotors[i];
        v.rotors.push_back({vector_of(rotor.position_m) - off, vector_of(rotor.axis).normalized(),
                            static_cast<double>(rotor.spin), -rotor.spin * rotor.drag_torque_m,
                            (1 + world.thrust_scale) * (1 + world.rotor_thrust_scale[i]), robot.min_thrust_n[i],
                            robot.max_thrust_n[i]});
    }
    v.rotor_time_constant_s = plant.time_constant_s > 0 ? plant.time_constant_s + world.rotor_time_constant_s : 0;
    v.power_coefficient_w_n1p5 = plant.power_coefficient_w_n1p5;
    v.spin_kg_m2_s_n0p5 =
        plant.rotor_inertia_kg_m2 > 0 ? plant.rotor_inertia_kg_m2 / std::sqrt(plant.thrust_coefficient_n_s2) : 0;
    v.body_drag = plant.drag;
    v.rotor_radius_m = robot.rotor_radius_m;
    v.wash_scale = plant.wash ? plant.wash->scale * (1 + world.wash_scale) : 0;
    return v;
}

}  // namespace downwash::judge
