#pragma once

#include <cmath>

#include "downwash/dynamics/flight_step.hpp"
#include "downwash/dynamics/integration.hpp"

// A tick of a vehicle in the plane that may touch a surface.

namespace downwash::dynamics {

/// What the surface does to the vehicle.
struct ContactLoad {
    double force[4] = {};        ///< generalised forces [N, N, N m, N m]
    double normal_n = 0;         ///< sum of the normal forces, >= 0
    double depth_m = -INFINITY;  ///< depth of the deepest point; negative: its distance
};

/// The load at coordinates and speeds of a plant.
inline ContactLoad contact_load(const PlantModel& model, const PlanarContact& contact, const double q[4],
                                const double u[4], const Attitude<double>& a) {
    ContactLoad load;
    const auto touch = [&](PlanePoint<double> from_center, PlanePoint<double> from_joint) {
        // A turn moves a point across its lever: d(x, z)/d angle = (lever z, -lever x).
        const PlanePoint<double> velocity{u[0] + u[2] * from_center.z + u[3] * from_joint.z,
                                          u[1] - u[2] * from_center.x - u[3] * from_joint.x};
        const PlanePoint<double> n = contact.normal;
        const double distance_m =
            (q[0] + from_center.x - contact.surface_m.x) * n.x + (q[1] + from_center.z - contact.surface_m.z) * n.z;
        load.depth_m = lane::max(load.depth_m, -distance_m);
        if (distance_m >= 0) {
            return;
        }
        const double inward_m_s = -(velocity.x * n.x + velocity.z * n.z);
        const double normal_n =
            -contact.stiffness_n_m * distance_m * lane::max(1 + contact.dissipation_s_m * inward_m_s, 0.0);
        const double slip_m_s = velocity.x * n.z - velocity.z * n.x;  // along (n.z, -n.x)
        const double drag_n = contact.friction * normal_n * slip_m_s /
                              lane::sqrt(slip_m_s * slip_m_s + contact.slip_speed_m_s * contact.slip_speed_m_s);
        const PlanePoint<double> force{normal_n * n.x - drag_n * n.z, normal_n * n.z + drag_n * n.x};
        load.force[0] += force.x;
        load.force[1] += force.z;
        load.force[2] += force.x * from_center.z - force.z * from_center.x;
        load.force[3] += force.x * from_joint.z - force.z * from_joint.x;
        load.normal_n += normal_n;
    };
    if (contact.is_end_effector) {
        const PlanePoint<double> arm{model.arm_length_m * a.arm_x, model.arm_length_m * a.arm_z};
        touch({a.joint_x + arm.x, a.joint_z + arm.z}, arm);
    }
    for (int i = 0; i < contact.point_count; ++i) {
        const PlanePoint<double>& p = contact.point_m[i];
        touch({a.cos_pitch * p.x + a.sin_pitch * p.z, a.cos_pitch * p.z - a.sin_pitch * p.x}, {0, 0});
    }
    return load;
}

/// Surroundings of a vehicle that touches: the thrust ratios at the beginning of the tick, in which the vehicle moves
/// by a millimetre or two, and the load.
template <Surroundings<double> Around>
class TouchingSurroundings {
 public:
    TouchingSurroundings(const PlantModel& model, const PlanarContact& contact, const Around& around, const double q[4],
                         const Attitude<double>& a)
        : model_(model), contact_(contact), around_(around) {
        for (int i = 0; i < model.rotor_count; ++i) {
            thrust_ratio_[i] = around.thrust_ratio(i, rotor_position(model, a, q[0], q[1], i), a.sin_pitch);
        }
        const PlanePoint<double> center = center_position(model, a, q[0], q[1]);
        body_ratio_ = model.has_fountain ? around.body_ratio(center, a.sin_pitch) : 1;
        wall_nearness_ = model.has_walls ? around.wall_nearness(center) : 0;
    }

    double thrust_ratio(int rotor, const PlanePoint<double>& /*hub_m*/, double /*sin_pitch*/) const {
        return thrust_ratio_[rotor];
    }
    [[nodiscard]] int same_as(int rotor) const { return rotor; }
    double body_ratio(const PlanePoint<double>& /*center_m*/, double /*sin_pitch*/) const { return body_ratio_; }
    double wall_nearness(const PlanePoint<double>& /*center_m*/) const { return wall_nearness_; }
    double thrust_scale(int rotor) const { return around_.thrust_scale(rotor); }
    static constexpr bool has_wind = Around::has_wind;
    PlanePoint<double> wind() const { return around_.wind(); }
    static constexpr bool has_wash = Around::has_wash;
    [[nodiscard]] const Slipstreams& slipstreams() const { return around_.slipstreams(); }
    double wash_scale() const { return around_.wash_scale(); }
    void add_load(const double q[4], const double u[4], const Attitude<double>& a, double force[4]) const {
        const ContactLoad load = contact_load(model_, contact_, q, u, a);
        for (int i = 0; i < 4; ++i) {
            force[i] += load.force[i];
        }
    }

 private:
    const PlantModel& model_;
    const PlanarContact& contact_;
    const Around& around_;
    double thrust_ratio_[max_rotors] = {};
    double body_ratio_, wall_nearness_;
};

/// The longest step in contact [s]: a quarter of a radian of the fastest vibration against the surface.
inline double longest_step_s(const PlantModel& model, const PlanarContact& contact) {
    double mobility = 0;  // what a newton at a point does to its velocity: bounds, of a vehicle whose arm is free
    if (contact.is_end_effector) {
        const double arm_m = model.arm_length_m;
        const double joint_m = lane::abs(model.joint_x_m) + lane::abs(model.joint_z_m);
        mobility = model.inverse_mass_1_kg +
                   arm_m * arm_m /
                       (model.arm_inertia_kg_m2 +
                        model.reduced_mass_kg * model.arm_center_of_mass_m * model.arm_center_of_mass_m) +
                   joint_m * joint_m / model.pitch_inertia_kg_m2;
    }
    for (int i = 0; i < contact.point_count; ++i) {
        const PlanePoint<double>& p = contact.point_m[i];
        mobility += 1 / model.multirotor_mass_kg + (p.x * p.x + p.z * p.z) / model.pitch_inertia_kg_m2;
    }
    return 0.25 / lane::sqrt(contact.stiffness_n_m * mobility);
}

template <Surroundings<double> Around>
PlantState<double> ContactStep::operator()(const PlantModel& model, const PlantState<double>& state,
                                           const Motion<double>& motion, const PlantCommand<double>& command,
                                           double dt_s, const Around& around) const {
    PlanarContact here = contact;
    for (PlanePoint<double>& point : here.point_m) {
        point = {point.x - center_of_mass_m.x, point.z - center_of_mass_m.z};
    }
    ContactLoad load = contact_load(model, here, state.q, state.u, motion.attitude);
    record = {0, load.depth_m, 1};
    const double reach_m = 2 * model.arm_length_m + 2;
    const double speed_m_s = lane::sqrt(state.u[0] * state.u[0] + state.u[1] * state.u[1]) +
                             reach_m * (lane::abs(state.u[2]) + lane::abs(state.u[3]));
    constexpr double max_acceleration_m_s2 = 100;
    if (-load.depth_m > (speed_m_s + max_acceleration_m_s2 * dt_s) * dt_s) {
        return flight_step(model, state, motion, command, dt_s, around);
    }
    const TouchingSurroundings<Around> surroundings(model, here, around, state.q, motion.attitude);
    record.steps = static_cast<int>(std::ceil(dt_s / (step_share * longest_step_s(model, here))));
    const double step_s = dt_s / record.steps;
    PlantState<double> next = state;
    for (int i = 0; i < record.steps; ++i) {
        next = flight_step(model, next, command, step_s, surroundings);
        const ContactLoad then = contact_load(model, here, next.q, next.u, attitude(model, next.q[2], next.q[3]));
        record.normal_impulse_n_s += 0.5 * step_s * (load.normal_n + then.normal_n);
        record.depth_m = lane::max(record.depth_m, then.depth_m);
        load = then;
    }
    return next;
}

}  // namespace downwash::dynamics
