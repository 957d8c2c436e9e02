#pragma once

#include <cmath>

#include "downwash/dynamics/flight_step.hpp"

// A vehicle in the plane that touches a plane surface: compliant, one-sided, with friction (docs/model.md 2.6).

namespace downwash::dynamics {

/// Most places of a vehicle at which it can touch.
inline constexpr int max_touching_points = 2;

/// The surface, what touches it, and what both are like. The default stiffness lets a vehicle of 5 kg that comes with
/// two points at 0.3 m/s in by 1.5 mm.
struct PlanarContact {
    PlanePoint<double> surface_m{0, 0};  ///< a point of it
    PlanePoint<double> normal{0, -1};    ///< unit vector out of the surface, towards the vehicle
    int point_count = 0;
    PlanePoint<double> point_m[max_touching_points] = {};  ///< from the centre of mass of the model, in the body frame
    bool is_end_effector = false;                          ///< the only point is that of the arm instead
    double stiffness_n_m = 1e5;                            ///< k of each point, > 0
    double dissipation_s_m = 10;   ///< c: normal force k d (1 + c d') at the depth d (Hunt and Crossley 1975), >= 0
    double friction = 0.5;         ///< Coulomb's, >= 0
    double slip_speed_m_s = 0.02;  ///< at which friction has 0.7 of its full force, > 0; below it creeps
};

/// What the surface does to the vehicle.
struct ContactLoad {
    double force[4] = {};        ///< generalised forces [N, N, N m, N m]
    double normal_n = 0;         ///< sum of the normal forces, >= 0
    double depth_m = -INFINITY;  ///< of the deepest point; negative: its distance
};

/// The load at coordinates and speeds of a plant.
template <class P>
ContactLoad contact_load(const BasicPlantModel<P>& model, const PlanarContact& contact, const double q[4],
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
template <class Factor, class P>
class TouchingSurroundings {
 public:
    TouchingSurroundings(const BasicPlantModel<P>& model, const PlanarContact& contact, Factor& factor,
                         const double q[4], const Attitude<double>& a)
        : model_(model), contact_(contact), factor_(factor) {
        for (int i = 0; i < model.rotor_count; ++i) {
            keep(i, q, a);
        }
        if (model.has_fountain) {
            keep(model.body(), q, a);
        }
        if (model.has_walls) {
            ratio_[model.walls()] =
                1 + wall_nearness(model, factor, rotor_position(model, a, q[0], q[1], model.body()));
        }
    }

    /// See rotor_wrench().
    double operator()(int rotor, double /*x_m*/, double /*z_m*/) const { return ratio_[rotor]; }
    [[nodiscard]] double thrust_scale(int rotor) const { return free_air_thrust(factor_, rotor, 1.0); }
    [[nodiscard]] PlanePoint<double> wind() const {
        if constexpr (requires { factor_.wind(); }) {
            return factor_.wind();
        } else {
            return {0, 0};
        }
    }
    /// See accelerations().
    void add_load(const double q[4], const double u[4], const Attitude<double>& a, double force[4]) const {
        const ContactLoad load = contact_load(model_, contact_, q, u, a);
        for (int i = 0; i < 4; ++i) {
            force[i] += load.force[i];
        }
    }

 private:
    void keep(int rotor, const double q[4], const Attitude<double>& a) {
        ratio_[rotor] = thrust_ratio(factor_, rotor, rotor_position(model_, a, q[0], q[1], rotor), a);
    }

    const BasicPlantModel<P>& model_;
    const PlanarContact& contact_;
    Factor& factor_;
    double ratio_[max_rotors + 2] = {};
};

/// What happened at a surface over one tick.
struct ContactTickRecord {
    double normal_impulse_n_s = 0;  ///< of the surface on the vehicle
    double depth_m = -INFINITY;     ///< greatest of any point; negative: least distance
    int steps = 0;                  ///< of the integrator
};

/// A tick beside a surface, in as many Runge-Kutta steps as contact needs: one where nothing can touch.
struct ContactStep {
    const PlanarContact& contact;               ///< its points are those of the model without `center_of_mass`
    PlanePoint<double> center_of_mass_m{0, 0};  ///< of the plant, from where the points are given, in the body frame
    ContactTickRecord& record;                  ///< of the last tick
    double step_share = 1;                      ///< of the step that is taken otherwise; for tests

    /// The state after `dt_s`; see flight_step().
    template <class P, class Factor>
    PlantState<double> operator()(const BasicPlantModel<P>& model, const PlantState<double>& state,
                                  const Motion<double>& motion, const PlantCommand<double>& command, double dt_s,
                                  Factor&& factor) const {
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
            return flight_step(model, state, motion, command, dt_s, factor);
        }
        const TouchingSurroundings<std::remove_reference_t<Factor>, P> surroundings(model, here, factor, state.q,
                                                                                    motion.attitude);
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

 private:
    /// A quarter of a radian of the fastest vibration against the surface.
    template <class P>
    static double longest_step_s(const BasicPlantModel<P>& model, const PlanarContact& contact) {
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
};

}  // namespace downwash::dynamics
