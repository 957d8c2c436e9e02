#pragma once

#include "downwash/base/lane_math.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "downwash/dynamics/plant_state.hpp"
#include "downwash/dynamics/rigid_body.hpp"
#include "downwash/dynamics/slipstream_shape.hpp"
#include "downwash/dynamics/slipstreams.hpp"

// What the slipstreams of the rotors do to the arm (docs/model.md 2.7), one template over the lane type.

namespace downwash::dynamics {

/// The Gauss rule with twelve points: shares of the part of an arm that may be inside, and weights.
inline constexpr int wash_points = 12;
inline constexpr double wash_point[wash_points] = {0.009219682876640378, 0.0479413718147626,  0.11504866290284765,
                                                   0.20634102285669126,  0.31608425050090994, 0.43738329574426554,
                                                   0.5626167042557344,   0.6839157494990901,  0.7936589771433087,
                                                   0.8849513370971523,   0.9520586281852375,  0.9907803171233596};
inline constexpr double wash_weight[wash_points] = {0.023587668193255917, 0.05346966299765909, 0.08003916427167317,
                                                    0.10158371336153292,  0.11674626826917739, 0.12457352290670144,
                                                    0.12457352290670144,  0.11674626826917739, 0.10158371336153292,
                                                    0.08003916427167317,  0.05346966299765909, 0.023587668193255917};

/// Speed of the air in a slipstream over the speed that momentum theory has at the disc, along the rotor's axis.
/// @param depth below the disc, in radii of the rotor   @param away_squared square of the distance from the axis, in
/// radii
template <class T>
T slipstream_speed(T depth, T away_squared) {
    const T inflow = lane::clamp(T(1) + depth * T(1 / inflow_radii), T(0), T(1));
    const T rise = inflow * inflow * (T(3) - T(2) * inflow);
    // Along the axis of a vortex cylinder, which contracts as it speeds up.
    const T below = lane::max(depth, T(0));
    const T slant = lane::sqrt(T(1) + below * below);
    const T way = T(0.5) * (below + slant);  // the mixing layer has grown for so long; half a radius at the disc
    const T gain = T(2) * way / slant;
    const T away = lane::sqrt(away_squared * gain);  // in radii of the contracted slipstream
    // The mixing layer eats the core and keeps the momentum; behind the end of the core it is all there is.
    const T core = lane::max(T(1) - T(mixing_rate) * way, T(0));
    const T behind = lane::max(way - T(1 / mixing_rate), T(0));
    const T lacking = T(layer_momentum) * core;
    const T layer =
        (lane::sqrt(lacking * lacking + T(jet_momentum) * (T(1) - core * core)) - lacking) * T(1 / jet_momentum) +
        T(jet_spread) * behind;
    const T place = lane::clamp((away - core) / layer, T(0), T(1));
    const T profile = T(1) - lane::power_three_halves(place);
    const T decay = T(1) + T(jet_decay * jet_spread) * behind;
    return rise * gain * (profile * profile) / decay;
}

/// An arm in a slipstream. x and z are body axes from the joint.
template <class T>
struct WashedArm {
    T along_x, along_z;  ///< unit vector towards the end effector
    T length_m;
    T drag_n_s_m, drag_n_s2_m2;  ///< of the whole arm, as in PlantNumbers
    T joint_m_s;                 ///< what the joint moves through the air across the arm
    T rate_rad_s;                ///< rate at which the arm turns against the world
    T hub_x_m, hub_z_m;          ///< the rotor
    T disc_m_s;                  ///< speed of the air at its disc
};

/// A force across the arm.
template <class T>
struct AcrossLoad {
    T force_n;    ///< along (e_z, -e_x), with e towards the end effector
    T moment_nm;  ///< about the joint
};

/// What one slipstream changes of the arm's drag. The Gauss rule runs over the part of the arm that may be inside:
/// docs/model.md 2.7 says how exact that is.
/// @param lateral_m distance of the rotor from the arm's plane, >= 0
template <class T>
AcrossLoad<T> load_of_slipstream(const WashedArm<T>& arm, double radius_m, double lateral_m) {
    AcrossLoad<T> load{T(0), T(0)};
    T first_m(0);
    T last_m = arm.length_m;
    // Where at + slope s > 0, s metres from the joint, the arm is outside.
    const auto leave_out = [&](T at, T slope) {
        const T some = lane::select(lane::abs(slope) < T(1e-9), T(1e-9), slope);
        const T end_m = -at / some;
        last_m = lane::select(some > T(0), lane::min(last_m, end_m), last_m);
        first_m = lane::select(some < T(0), lane::max(first_m, end_m), first_m);
    };
    const T edge_m = T(edge_radii * radius_m) + T(edge_spread) * arm.hub_z_m;
    const T widening = T(edge_spread) * arm.along_z;
    leave_out(-arm.hub_x_m - edge_m, widening + arm.along_x);
    leave_out(arm.hub_x_m - edge_m, widening - arm.along_x);
    leave_out(T(lateral_m) - edge_m, widening);
    leave_out(T(-inflow_radii * radius_m) - arm.hub_z_m, arm.along_z);
    const T inside_m = last_m - first_m;
    if (lane::bits_of(inside_m > T(0)) == 0) {
        return load;
    }
    const T length_m = lane::max(inside_m, T(0));
    const T share = length_m / arm.length_m;
    const T inverse_radius_1_m(1 / radius_m);
    const T lateral_squared(lateral_m * lateral_m / (radius_m * radius_m));
    const T across_m_s = arm.disc_m_s * arm.along_x;  // against (e_z, -e_x)
    const auto drag = [&](T speed_m_s) {
        return (arm.drag_n_s_m + arm.drag_n_s2_m2 * lane::abs(speed_m_s)) * speed_m_s;
    };
    for (int i = 0; i < wash_points; ++i) {
        const T from_joint_m = first_m + T(wash_point[i]) * length_m;
        const T depth = (arm.hub_z_m - from_joint_m * arm.along_z) * inverse_radius_1_m;
        const T beside = (from_joint_m * arm.along_x - arm.hub_x_m) * inverse_radius_1_m;
        const T wash_m_s = across_m_s * slipstream_speed(depth, beside * beside + lateral_squared);
        const T still_m_s = arm.joint_m_s + arm.rate_rad_s * from_joint_m;
        const T force_n = T(wash_weight[i]) * share * (drag(still_m_s) - drag(still_m_s - wash_m_s));
        load.force_n = load.force_n + force_n;
        load.moment_nm = load.moment_nm + force_n * from_joint_m;
    }
    return load;
}

/// A vehicle as its slipstreams need it.
template <class T>
struct WashedVehicle {
    Attitude<T> attitude;
    T u[4];                  ///< speeds [m/s, m/s, rad/s, rad/s]
    PlanePoint<T> wind;      ///< velocity of the air [m/s]
    T acting_n[max_rotors];  ///< thrust of each rotor in free air
    T scale;                 ///< speed of the slipstreams over that of the model
};

/// What all slipstreams change of the arm's drag. Neither inline nor with any effect but its value: what flies without
/// a wash stays as small and as fast as it is.
template <class T, class P>
[[gnu::noinline, gnu::pure]] AcrossLoad<T> load_of_slipstreams(const BasicPlantModel<P>& model,
                                                               const Slipstreams& slipstreams,
                                                               const WashedVehicle<T>& vehicle) {
    T sum_n[max_rotors + 1];
    for (T& sum : sum_n) {
        sum = T(0);
    }
    for (int i = 0; i < model.rotor_count; ++i) {
        T& sum = sum_n[slipstreams.of_rotor[i]];
        sum = sum + lane::max(vehicle.acting_n[i], T(0));
    }
    const Attitude<T>& a = vehicle.attitude;
    const T* u = vehicle.u;
    const T x_m_s = u[0] - vehicle.wind.x;
    const T z_m_s = u[1] - vehicle.wind.z;
    WashedArm<T> arm;
    arm.along_x = a.arm_x * a.cos_pitch - a.arm_z * a.sin_pitch;
    arm.along_z = a.arm_x * a.sin_pitch + a.arm_z * a.cos_pitch;
    arm.length_m = T(model.arm_length_m);
    arm.drag_n_s_m = T(model.arm_drag_n_s_m);
    arm.drag_n_s2_m2 = T(model.arm_drag_n_s2_m2);
    arm.joint_m_s = (x_m_s + u[2] * a.joint_z) * a.arm_z - (z_m_s - u[2] * a.joint_x) * a.arm_x;
    arm.rate_rad_s = u[2] + u[3];
    AcrossLoad<T> all{T(0), T(0)};
    for (int i = 0; i < slipstreams.count; ++i) {
        const int rotor = slipstreams.rotor[i];
        arm.hub_x_m = T(model.rotor_x_m[rotor]) - T(model.joint_x_m);
        arm.hub_z_m = T(model.rotor_z_m[rotor]) - T(model.joint_z_m);
        arm.disc_m_s = vehicle.scale * lane::sqrt(T(slipstreams.speed_squared_per_n) * sum_n[i]);
        const AcrossLoad<T> load = load_of_slipstream(arm, slipstreams.radius_m, slipstreams.lateral_m[i]);
        all.force_n = all.force_n + load.force_n;
        all.moment_nm = all.moment_nm + load.moment_nm;
    }
    return all;
}

/// Adds what the slipstreams change of the arm's drag to generalised forces Q [N, N, N m, N m].
template <class T, class P>
void add_arm_wash(const BasicPlantModel<P>& model, const Slipstreams& slipstreams, const WashedVehicle<T>& vehicle,
                  T force[4]) {
    const AcrossLoad<T> load = load_of_slipstreams(model, slipstreams, vehicle);
    const Attitude<T>& a = vehicle.attitude;
    const T lever_m = a.joint_z * a.arm_z + a.joint_x * a.arm_x;
    force[0] = force[0] + load.force_n * a.arm_z;
    force[1] = force[1] - load.force_n * a.arm_x;
    force[2] = force[2] + (load.force_n * lever_m + load.moment_nm);
    force[3] = force[3] + load.moment_nm;
}

}  // namespace downwash::dynamics
