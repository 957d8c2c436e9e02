#pragma once

#include <concepts>
#include <limits>

#include "downwash/controllers/space_law_model.hpp"
#include "downwash/dynamics/space_step.hpp"

// From what a control law in space demands to what rotors and joints are commanded (docs/model.md 5.11). One template
// over the lane type and the number of joints.

namespace downwash::controllers {

/// Thrust ratios that a law reads. `ratio(rotor, hub_m)`: K = T / T_free of a rotor with its hub there in the world.
template <class Map, class T>
concept RatioMap = requires(const Map& map, const dynamics::LaneVector<T>& hub_m) {
    { map.ratio(0, hub_m) } -> std::same_as<T>;
};

/// The map of a law that knows no surfaces.
struct NoRatios {
    template <class T>
    T ratio(int /*rotor*/, const dynamics::LaneVector<T>& /*hub_m*/) const {
        return T(1);
    }
};

/// A push that a law is told of, such as that of a surface on which the vehicle presses: a map that is one, too, tells
/// of it.
struct ToldPush {
    bool is_on_end_effector = false;                ///< false: on the multirotor
    dynamics::LaneVector<double> at_m{0, 0, 0};     ///< from the multirotor's centre of mass, body axes; on that alone
    dynamics::LaneVector<double> force_n{0, 0, 0};  ///< on the vehicle, world axes
};

/// Puts a push among the equations: they then ask for what stands up to it, J^T F.
/// @param places of the vehicle that the law sees
template <class T, int n>
void stand_up_to(const ToldPush& push, const dynamics::SpacePlaces<T, n>& places, dynamics::SpaceEquations<T, n>& e) {
    dynamics::SpaceLoad<T, n> load{};
    const dynamics::LaneVector<T> force = turned_back(places.attitude, dynamics::spread<T>(push.force_n));
    dynamics::add_force_at(places, push.is_on_end_effector ? n - 1 : -1,
                           push.is_on_end_effector ? places.end_effector_m : dynamics::spread<T>(push.at_m), force,
                           load);
    e.bias_force_n = e.bias_force_n - load.wrench.force_n;
    e.bias_torque_nm = e.bias_torque_nm - load.wrench.torque_nm;
    for (int i = 0; i < n; ++i) {
        e.bias_joint_nm[i] = e.bias_joint_nm[i] - load.joint_torque_nm[i];
    }
}

/// The least K that a law takes from a map, so that commands stay finite: that of the plane.
inline constexpr double min_space_ratio = 0.1;

/// What a law asks of the rotors, by what acts: K included.
template <class T>
struct SpaceDemand {
    T lift_n;                           ///< along b3
    dynamics::LaneVector<T> torque_nm;  ///< about the multirotor's centre of mass, body axes
};

/// The thrusts that have to act for a demand [N]. A rotor's drag torque follows its speed, so it belongs to the thrust
/// T_i in free air, not to the acting one A_i = K_i T_i. With B for K = 1 and r_i the drag torque per thrust, acting
/// thrusts give the wrench (B + N') A, where N' has the columns r_i (1 / K_i - 1) axis_i in the rows of torque. We ask
/// A = B^+ w' for the w' with (1 + N' B^+) w' = w: rows of torque alone change.
/// @param ratio K of each rotor, or nullptr where all are 1
/// @param[out] tilt_n thrusts for lift, roll and pitch torque   @param[out] yaw_n those for yaw torque beside them
template <int n, class T>
void acting_thrusts(const SpaceLawModel<n>& nominal, const T* ratio, const SpaceDemand<T>& demand, T tilt_n[max_rotors],
                    T yaw_n[max_rotors]) {
    using dynamics::LaneVector;
    const SpaceAllocation& allocation = nominal.allocation;
    LaneVector<T> torque = demand.torque_nm;
    if (ratio != nullptr) {
        LaneVector<T> lift{T(0), T(0), T(0)};  // the columns of N' B^+
        LaneVector<T> column[3] = {{T(1), T(0), T(0)}, {T(0), T(1), T(0)}, {T(0), T(0), T(1)}};  // and of 1 + N' B^+
        for (int i = 0; i < allocation.rotor_count; ++i) {
            const auto& rotor = nominal.plant.rotor[i];
            const LaneVector<T> lost =
                (T(rotor.reaction_m) * (T(1) / ratio[i] - T(1))) * dynamics::spread<T>(rotor.axis);
            const double* share = allocation.share[i];
            lift = lift + T(share[0]) * lost;
            for (int k = 0; k < 3; ++k) {
                column[k] = column[k] + T(share[1 + k]) * lost;
            }
        }
        const LaneVector<T> wanted = torque - demand.lift_n * lift;
        const LaneVector<T> first = cross(column[1], column[2]);
        const T inverse_determinant = T(1) / dot(column[0], first);
        torque = {inverse_determinant * dot(first, wanted),
                  inverse_determinant * dot(cross(column[2], column[0]), wanted),
                  inverse_determinant * dot(cross(column[0], column[1]), wanted)};
    }
    for (int i = 0; i < allocation.rotor_count; ++i) {
        const double* share = allocation.share[i];
        tilt_n[i] = T(share[0]) * demand.lift_n + T(share[1]) * torque.x + T(share[2]) * torque.y;
        yaw_n[i] = T(share[3]) * torque.z;
    }
}

/// The saturation of the worst rotor: its demand over its greatest thrust. Below the least thrust it is more than 1, by
/// the share of the range that is missing.
/// @param demand_n free-air thrusts [N]
template <int n, class T>
T rotor_saturation(const SpaceLawModel<n>& nominal, const T demand_n[max_rotors]) {
    T worst(-std::numeric_limits<double>::infinity());
    for (int i = 0; i < nominal.plant.rotor_count; ++i) {
        const double min_n = nominal.min_thrust_n[i];
        const double max_n = nominal.max_thrust_n[i];
        const T missed = (T(min_n) - demand_n[i]) * T(1 / (max_n - min_n));
        worst = lane::max(worst, demand_n[i] * T(1 / max_n));
        worst = lane::max(worst, lane::select(missed > T(0), T(1) + missed, worst));
    }
    return worst;
}

/// Thrusts within limits that keep as much of a demand as rotors can give, by priority: yaw torque is given up first,
/// then lift is raised or lowered, and only where no lift leaves room for roll and pitch torque do these shrink, both
/// by the same factor. What yaw gets is what then is left.
/// @param tilt_n,yaw_n see acting_thrusts()   @param demand lift as in there   @param low_n,high_n limits of what acts
/// [N]
/// @param[out] clipped_n thrusts within the limits
template <int n, class T>
void clip_by_priority(const SpaceLawModel<n>& nominal, const T tilt_n[max_rotors], const T yaw_n[max_rotors],
                      const T& lift_n, const T low_n[max_rotors], const T high_n[max_rotors], T clipped_n[max_rotors]) {
    const SpaceAllocation& allocation = nominal.allocation;
    const int rotors = allocation.rotor_count;
    // Lift per share: rotor i allows lifts from (low - torque part) / share to (high - torque part) / share. A rotor
    // without share in the lift does not bound it.
    double largest = 0;
    for (int i = 0; i < rotors; ++i) {
        largest = lane::max(largest, allocation.share[i][0]);
    }
    int bounding[max_rotors];
    int bounding_count = 0;
    for (int i = 0; i < rotors; ++i) {
        if (allocation.share[i][0] > 1e-3 * largest) {
            bounding[bounding_count++] = i;
        }
    }
    constexpr double unlimited = std::numeric_limits<double>::infinity();
    T low[max_rotors], high[max_rotors], turn[max_rotors];  // per share of lift
    T turn_n[max_rotors];
    for (int i = 0; i < rotors; ++i) {
        turn_n[i] = tilt_n[i] - T(allocation.share[i][0]) * lift_n;
    }
    for (int b = 0; b < bounding_count; ++b) {
        const int i = bounding[b];
        const T per_share(1 / allocation.share[i][0]);
        low[b] = low_n[i] * per_share;
        high[b] = high_n[i] * per_share;
        turn[b] = turn_n[i] * per_share;
    }
    // Any two rotors have to agree on a lift: the most that torques may be scaled by.
    T scale(1);
    for (int b = 0; b < bounding_count; ++b) {
        for (int c = 0; c < bounding_count; ++c) {
            const T apart = turn[c] - turn[b];
            const T room = high[c] - low[b];
            const auto is_too_much = (apart > T(0)) & (apart * scale > room);
            scale = lane::select(is_too_much, room / apart, scale);
        }
    }
    scale = lane::max(scale, T(0));
    T min_lift_n(-unlimited), max_lift_n(unlimited);
    for (int b = 0; b < bounding_count; ++b) {
        min_lift_n = lane::max(min_lift_n, low[b] - scale * turn[b]);
        max_lift_n = lane::min(max_lift_n, high[b] - scale * turn[b]);
    }
    const T lift = lane::max(min_lift_n, lane::min(lift_n, max_lift_n));
    T share_of_yaw(1);
    for (int i = 0; i < rotors; ++i) {
        clipped_n[i] = lane::clamp(T(allocation.share[i][0]) * lift + scale * turn_n[i], low_n[i], high_n[i]);
        const T room = lane::select(yaw_n[i] > T(0), high_n[i], low_n[i]) - clipped_n[i];  // of the sign of yaw_n
        const auto is_too_much = lane::abs(yaw_n[i]) * share_of_yaw > lane::abs(room);
        share_of_yaw = lane::select(is_too_much, room / yaw_n[i], share_of_yaw);
    }
    for (int i = 0; i < rotors; ++i) {
        clipped_n[i] = lane::clamp(clipped_n[i] + share_of_yaw * yaw_n[i], low_n[i], high_n[i]);
    }
}

/// The wrench of free-air thrusts [N] if the ratios are right, body axes.
/// @param ratio K of each rotor, or nullptr where all are 1
template <int n, class T>
dynamics::SpaceWrench<T> wrench_of(const SpaceModel<n>& plant, const T* ratio, const T thrust_n[max_rotors]) {
    using dynamics::LaneVector;
    dynamics::SpaceWrench<T> wrench{{T(0), T(0), T(0)}, {T(0), T(0), T(0)}};
    for (int i = 0; i < plant.rotor_count; ++i) {
        const LaneVector<T> axis = dynamics::spread<T>(plant.rotor[i].axis);
        const LaneVector<T> push = (ratio != nullptr ? ratio[i] * thrust_n[i] : thrust_n[i]) * axis;
        wrench.force_n = wrench.force_n + push;
        wrench.torque_nm = wrench.torque_nm + (cross(dynamics::spread<T>(plant.rotor[i].position_m), push) +
                                               (T(plant.rotor[i].reaction_m) * thrust_n[i]) * axis);
    }
    return wrench;
}

/// What rotors do in one tick, as a law expects it.
template <class T>
struct CommandedRotors {
    dynamics::SpaceWrench<T> wrench;  ///< that acts in the middle of the tick, body axes
    T saturation;                     ///< see rotor_saturation()
};

/// K at the rotors of the vehicle that a law sees. @param offset_m of the map's surfaces from their nominal places
template <class T, int n, RatioMap<T> Map>
void read_ratios(const SpaceLawModel<n>& nominal, const dynamics::SpaceState<T, n>& seen,
                 const dynamics::LaneRotation<T>& attitude, const Vector3& offset_m, const Map& map,
                 T ratio[max_rotors]) {
    const dynamics::LaneVector<T> at{seen.q[0] - T(offset_m[0]), seen.q[1] - T(offset_m[1]),
                                     seen.q[2] - T(offset_m[2])};
    for (int i = 0; i < nominal.plant.rotor_count; ++i) {
        const auto hub_m = at + attitude * dynamics::spread<T>(nominal.plant.rotor[i].position_m);
        ratio[i] = lane::max(map.ratio(i, hub_m), T(min_space_ratio));
    }
}

/// The commands of the rotors for a demand, within their limits.
/// @param ratio K of each rotor as the law knows it, or nullptr   @param rotor_lead docs/model.md 5.2
/// @param[out] given the rotors' commands
template <class T, int n>
CommandedRotors<T> command_rotors(const SpaceLawModel<n>& nominal, const dynamics::SpaceState<T, n>& seen,
                                  const T* ratio, const SpaceDemand<T>& demand, double tick_s, double rotor_lead,
                                  dynamics::SpaceCommand<T, n>& given) {
    const SpaceModel<n>& plant = nominal.plant;
    T tilt_n[max_rotors], yaw_n[max_rotors], demand_n[max_rotors];
    acting_thrusts(nominal, ratio, demand, tilt_n, yaw_n);
    for (int i = 0; i < plant.rotor_count; ++i) {
        demand_n[i] = tilt_n[i] + yaw_n[i];
        if (ratio != nullptr) {
            demand_n[i] = demand_n[i] / ratio[i];
        }
    }
    CommandedRotors<T> rotors;
    rotors.saturation = rotor_saturation(nominal, demand_n);
    const auto is_saturated = rotors.saturation > T(1);
    if (lane::bits_of(is_saturated) != 0) {  // hardly any tick needs it
        T low_n[max_rotors], high_n[max_rotors], clipped_n[max_rotors];
        for (int i = 0; i < plant.rotor_count; ++i) {
            const T k = ratio != nullptr ? ratio[i] : T(1);
            low_n[i] = k * T(nominal.min_thrust_n[i]);
            high_n[i] = k * T(nominal.max_thrust_n[i]);
        }
        clip_by_priority(nominal, tilt_n, yaw_n, demand.lift_n, low_n, high_n, clipped_n);
        for (int i = 0; i < plant.rotor_count; ++i) {
            const T k = ratio != nullptr ? ratio[i] : T(1);
            demand_n[i] = lane::select(is_saturated, clipped_n[i] / k, demand_n[i]);
        }
    }
    const double half_tick_s = 0.5 * tick_s;
    const T reached(half_tick_s / (half_tick_s + plant.rotor_time_constant_s));  // 1 without lag
    T expected_n[max_rotors]{};
    for (int i = 0; i < plant.rotor_count; ++i) {
        const bool leads = plant.has_rotor_lag && rotor_lead > 0;
        const T asked_n = leads ? demand_n[i] + T(rotor_lead) * (demand_n[i] - seen.thrust_n[i]) : demand_n[i];
        given.thrust_n[i] = lane::clamp(asked_n, T(nominal.min_thrust_n[i]), T(nominal.max_thrust_n[i]));
        const T from = plant.has_rotor_lag ? seen.thrust_n[i] : given.thrust_n[i];
        expected_n[i] = from + reached * (given.thrust_n[i] - from);
    }
    rotors.wrench = wrench_of(plant, ratio, expected_n);
    for (int i = plant.rotor_count; i < max_rotors; ++i) {
        given.thrust_n[i] = T(0);
    }
    return rotors;
}

/// The torques of the joints that give demanded joint accelerations under a wrench on the multirotor, whose own
/// accelerations follow from it: see joint_torque() of the plane.
/// @param e the equations, with what the law observes in its bias   @param y demanded accelerations [rad/s2]
template <class T, int n>
void joint_torques_for(const SpaceModel<n>& model, const dynamics::SpaceEquations<T, n>& e,
                       const dynamics::SpaceWrench<T>& wrench, const T y[room_for<n>], T torque_nm[room_for<n>]) {
    if constexpr (n > 0) {
        using dynamics::LaneVector;
        const T inverse_mass(model.inverse_mass_1_kg);
        LaneVector<T> force = wrench.force_n - e.bias_force_n;
        LaneVector<T> turn = wrench.torque_nm - e.bias_torque_nm;
        for (int i = 0; i < n; ++i) {
            force = force - y[i] * e.joint_push_kg_m[i];
            turn = turn - y[i] * e.joint_spin_kg_m2[i];
        }
        const LaneVector<T> center = inverse_mass * e.first_moment_kg_m;
        turn = dynamics::solve_positive(e.inertia_kg_m2 - dynamics::point_inertia(T(model.total_mass_kg), center),
                                        turn - cross(center, force));
        const LaneVector<T> a = inverse_mass * (force - cross(turn, e.first_moment_kg_m));
        for (int i = 0; i < n; ++i) {
            torque_nm[i] = e.bias_joint_nm[i] + dot(e.joint_push_kg_m[i], a) + dot(e.joint_spin_kg_m2[i], turn);
            for (int k = 0; k < n; ++k) {
                torque_nm[i] =
                    torque_nm[i] + (k < i ? e.joint_inertia_kg_m2[k][i] : e.joint_inertia_kg_m2[i][k]) * y[k];
            }
        }
    }
}

/// The commands of the joints, clipped to their limits. @return the saturation: at least `saturation`
template <class T, int n>
T command_joints(const SpaceLawModel<n>& nominal, const T torque_nm[room_for<n>], T saturation,
                 dynamics::SpaceCommand<T, n>& given) {
    for (int i = 0; i < n; ++i) {
        const T max_nm(nominal.max_joint_torque_nm[i]);
        saturation = lane::max(saturation, lane::abs(torque_nm[i]) / max_nm);
        given.joint_torque_nm[i] = lane::clamp(torque_nm[i], -max_nm, max_nm);
    }
    if constexpr (n == 0) {
        given.joint_torque_nm[0] = T(0);
    }
    return saturation;
}

}  // namespace downwash::controllers
