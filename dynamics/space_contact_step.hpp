#pragma once

#include "downwash/dynamics/space_contact.hpp"
#include "downwash/dynamics/space_integration.hpp"

// A tick of a vehicle in space that may touch a surface.

namespace downwash::dynamics {

/// What the surface does to the vehicle.
template <class T, int n>
struct SpaceContactLoad {
    SpaceLoad<T, n> load;
    T normal_n;  ///< sum of the normal forces, >= 0
    T depth_m;   ///< depth of the deepest point; negative: its distance; -1e300 without points
};

/// A point of contact from the multirotor's centre of mass, in body axes [m].
template <class T, int n, class P>
LaneVector<T> contact_point(const BasicSpaceModel<P, n>& model, const SpaceContactPoint& point, const T* q) {
    LaneVector<T> at = spread<T>(point.at_m);
    for (int i = point.link; i >= 0 && n > 0; --i) {
        const SpaceLinkNumbers<P>& link = model.link[i];
        at = spread<T>(link.joint_m) + rotation_about(spread<T>(link.axis), q[7 + i]) * at;
    }
    return at;
}

/// The load at coordinates and speeds of a plant.
template <class T, int n, class P>
SpaceContactLoad<T, n> space_contact_load(const BasicSpaceModel<P, n>& model, const SpaceContact& contact, const T* q,
                                          const T* u, const SpacePlaces<T, n>& p) {
    const T zero(0);
    SpaceContactLoad<T, n> all{{{{zero, zero, zero}, {zero, zero, zero}}, {}}, zero, T(-1e300)};
    for (T& torque_nm : all.load.joint_torque_nm) {
        torque_nm = zero;
    }
    const LaneVector<T> normal = turned_back(p.attitude, spread<T>(contact.normal));
    const LaneVector<T> from_surface = LaneVector<T>{q[0], q[1], q[2]} - spread<T>(contact.surface_m);
    const T distance_m = dot(from_surface, spread<T>(contact.normal));  // of the multirotor's centre of mass
    for (int i = 0; i < contact.point_count; ++i) {
        const SpaceContactPoint& point = contact.point[i];
        const LaneVector<T> at = contact_point(model, point, q);
        const LaneVector<T> velocity = velocity_at(p, point.link, at, u);
        const T outward_m_s = dot(velocity, normal);
        const LaneVector<T> slip = velocity - outward_m_s * normal;
        const T depth_m = -(distance_m + dot(at, normal));
        const T normal_n = T(contact.stiffness_n_m) * lane::max(depth_m, zero) *
                           lane::max(T(1) - T(contact.dissipation_s_m) * outward_m_s, zero);
        const T slip_speed = lane::sqrt(dot(slip, slip) + T(contact.slip_speed_m_s * contact.slip_speed_m_s));
        const T drag = T(contact.friction) * normal_n / slip_speed;
        add_force_at(p, point.link, at, normal_n * normal - drag * slip, all.load);
        all.normal_n = all.normal_n + normal_n;
        all.depth_m = lane::max(all.depth_m, depth_m);
    }
    return all;
}

/// Surroundings of a vehicle that touches: surface effects of the beginning of the tick, in which the vehicle moves by
/// a millimetre or two, and the load.
template <int joints, SpaceSurroundings<double> Around>
class TouchingSpace {
 public:
    TouchingSpace(const SpaceModel<joints>& model, const SpaceContact& contact, const Around& around, const double* q)
        : model_(model), contact_(contact), around_(around) {
        const LaneVector<double> position_m{q[0], q[1], q[2]};
        const LaneRotation<double> attitude = rotation_of(q + 3);
        const auto& here = at_attitude<double>(around, attitude);
        for (int i = 0; i < model.rotor_count; ++i) {
            thrust_ratio_[i] =
                here.thrust_ratio(i, position_m + attitude * model.rotor[i].position_m, attitude * model.rotor[i].axis);
        }
        const LaneVector<double> center_m = position_m + attitude * model.center_m;
        body_ratio_ = model.has_fountain ? here.body_ratio(center_m, attitude * model.center_axis) : 1;
        wall_nearness_ = model.has_walls ? around.wall_nearness(center_m) : LaneVector<double>{0, 0, 0};
    }

    double thrust_ratio(int rotor, const LaneVector<double>& /*hub_m*/, const LaneVector<double>& /*axis*/) const {
        return thrust_ratio_[rotor];
    }
    double thrust_scale(int rotor) const { return around_.thrust_scale(rotor); }
    double body_ratio(const LaneVector<double>& /*center_m*/, const LaneVector<double>& /*axis*/) const {
        return body_ratio_;
    }
    LaneVector<double> wall_nearness(const LaneVector<double>& /*center_m*/) const { return wall_nearness_; }
    static constexpr bool has_wind = Around::has_wind;
    LaneVector<double> wind() const { return around_.wind(); }
    static constexpr bool has_wash = Around::has_wash;
    static constexpr int drag_pieces = Around::drag_pieces;
    [[nodiscard]] const SpaceSlipstreams& slipstreams() const { return around_.slipstreams(); }
    double wash_scale() const { return around_.wash_scale(); }
    template <int n>
    void add_load(const double* q, const double* u, const SpacePlaces<double, n>& places,
                  SpaceLoad<double, n>& load) const {
        around_.add_load(q, u, places, load);
        if constexpr (n == joints) {
            const SpaceLoad<double, n> more = space_contact_load(model_, contact_, q, u, places).load;
            load.wrench.force_n = load.wrench.force_n + more.wrench.force_n;
            load.wrench.torque_nm = load.wrench.torque_nm + more.wrench.torque_nm;
            for (int i = 0; i < n; ++i) {
                load.joint_torque_nm[i] += more.joint_torque_nm[i];
            }
        }
    }

 private:
    const SpaceModel<joints>& model_;
    const SpaceContact& contact_;
    const Around& around_;
    double thrust_ratio_[max_rotors] = {};
    double body_ratio_;
    LaneVector<double> wall_nearness_;
};

/// How the points of contact give way to forces at a configuration [1/kg].
struct ContactMobility {
    double normal = 0;  ///< sum over all points, for forces across the surface
    double slip = 0;    ///< greatest of any point, for forces along it
};

/// The mobility at coordinates of a plant.
template <int n>
ContactMobility contact_mobility(const SpaceModel<n>& model, const SpaceContact& contact, const double* q,
                                 const SpacePlaces<double, n>& p) {
    const LaneVector<double> normal = turned_back(p.attitude, contact.normal);
    const LaneVector<double> some =
        lane::abs(normal.x) < 0.6 ? LaneVector<double>{1, 0, 0} : LaneVector<double>{0, 1, 0};
    LaneVector<double> along = cross(normal, some);
    along = 1 / lane::sqrt(dot(along, along)) * along;
    ContactMobility mobility;
    for (int i = 0; i < contact.point_count; ++i) {
        const SpaceContactPoint& point = contact.point[i];
        const LaneVector<double> at = contact_point(model, point, q);
        mobility.normal += mobility_at(model, p, point.link, at, normal);
        mobility.slip = lane::max(mobility.slip, mobility_at(model, p, point.link, at, along) +
                                                     mobility_at(model, p, point.link, at, cross(normal, along)));
    }
    return mobility;
}

/// A tick beside a surface, in as many Runge-Kutta steps as contact needs: one where nothing can touch. Near it a step
/// is at most a quarter of a radian of the fastest vibration against the surface, and at most the time in which
/// friction slows slip by a factor of e.
struct SpaceContactStep {
    const SpaceContact& contact;  ///< its points on the multirotor are those of the model without `center_of_mass`
    LaneVector<double> center_of_mass_m{
        0, 0,
        0};  ///< centre of mass of the multirotor, from the point to which contact points refer, in the body frame
    SpaceContactRecord& record;  ///< record of the last tick
    int joint_steps = 1;         ///< least number of steps: joint_steps() of the model
    double step_share = 1;       ///< share of the step that is taken otherwise; for tests

    /// The state after `dt_s`, a tick of at most 0.02 s; see space_step().
    template <int n, SpaceSurroundings<double> Around>
    SpaceState<double, n> operator()(const SpaceModel<n>& model, const SpaceState<double, n>& state,
                                     const SpaceCommand<double, n>& command, double dt_s, const Around& around) const {
        SpaceContact here = contact;
        for (SpaceContactPoint& point : here.point) {
            point.at_m = point.link < 0 ? point.at_m - center_of_mass_m : point.at_m;
        }
        const auto load_at = [&](const SpaceState<double, n>& at) {
            return space_contact_load(model, here, at.q, at.u, places_at(model, at.q));
        };
        SpaceContactLoad<double, n> load = load_at(state);
        record = {0, load.depth_m, joint_steps};
        if (-load.depth_m > (greatest_speed(model, here, state) + max_acceleration_m_s2 * dt_s) * dt_s) {
            return EqualSpaceSteps{joint_steps}(model, state, command, dt_s, around);
        }
        const ContactMobility mobility = contact_mobility(model, here, state.q, places_at(model, state.q));
        const double vibration_s = 0.25 / lane::sqrt(here.stiffness_n_m * mobility.normal);
        const TouchingSpace<n, Around> surroundings(model, here, around, state.q);
        SpaceState<double, n> next = state;
        record.steps = 0;
        for (double rest_s = dt_s; rest_s > 0;) {
            // Friction decays slip at mu N / v_slip times the mobility.
            const double decay_1_s = here.friction * load.normal_n * mobility.slip / here.slip_speed_m_s;
            const double longest_s = step_share * lane::min(lane::min(vibration_s, dt_s / joint_steps),
                                                            decay_1_s > 0 ? 1 / decay_1_s : dt_s);
            const double parts = std::ceil(rest_s / longest_s);
            const bool is_last = parts <= 1;
            const double step_s = is_last ? rest_s : rest_s / parts;
            next = space_step(model, next, command, step_s, surroundings);
            const SpaceContactLoad<double, n> then = load_at(next);
            record.normal_impulse_n_s += 0.5 * step_s * (load.normal_n + then.normal_n);
            record.depth_m = lane::max(record.depth_m, then.depth_m);
            ++record.steps;
            load = then;
            rest_s = is_last ? 0 : rest_s - step_s;
        }
        return next;
    }

 private:
    static constexpr double max_acceleration_m_s2 = 100;

    /// No point is faster.
    template <int n>
    static double greatest_speed(const SpaceModel<n>& model, const SpaceContact& contact,
                                 const SpaceState<double, n>& state) {
        const double* u = state.u;
        double rate_rad_s = lane::sqrt(u[3] * u[3] + u[4] * u[4] + u[5] * u[5]);
        double reach_m = 0;
        for (int i = 0; i < n; ++i) {
            rate_rad_s += lane::abs(u[6 + i]);
            reach_m += lane::sqrt(dot(model.link[i].joint_m, model.link[i].joint_m));
        }
        double farthest_m = 0;
        for (int i = 0; i < contact.point_count; ++i) {
            const LaneVector<double>& at_m = contact.point[i].at_m;
            farthest_m = lane::max(farthest_m, lane::sqrt(dot(at_m, at_m)));
        }
        return lane::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]) + (reach_m + farthest_m) * rate_rad_s;
    }
};

}  // namespace downwash::dynamics
