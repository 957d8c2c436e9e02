#pragma once

#include <cmath>
#include <limits>

#include "downwash/base/lane_math.hpp"
#include "downwash/controllers/reference_point.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "downwash/simulation/flight_rules.hpp"
#include "downwash/simulation/flight_sums.hpp"
#include "downwash/simulation/vehicle_state.hpp"

// The rules and sums of a planned flight that need nothing but the numbers of one tick, one template over the lane
// type.

namespace downwash::simulation {

/// FlightRules as plain numbers.
struct RuleLimits {
    double x_low_m, x_high_m, z_low_m, z_high_m;
    double arm_low_rad, arm_high_rad;  ///< infinite without limits
    double max_tracking_error_m, max_arm_error_rad;
    double max_saturation;
    double max_pitch_rate_rad_s;
};

/// The limits of a flight with this arm. An arm that does not move has no limits to leave: its joint only holds it.
inline RuleLimits rule_limits(const FlightRules& rules, const ArmParameters& arm) noexcept {
    constexpr double unlimited = std::numeric_limits<double>::infinity();
    const bool has_limits = arm.is_limited && arm.lower_limit_rad < arm.upper_limit_rad;
    return {rules.bounds.x_low_m,
            rules.bounds.x_high_m,
            rules.bounds.z_low_m,
            rules.bounds.z_high_m,
            has_limits ? arm.lower_limit_rad : -unlimited,
            has_limits ? arm.upper_limit_rad : unlimited,
            rules.max_tracking_error_m,
            rules.max_arm_error_rad,
            rules.max_saturation,
            rules.max_pitch_rate_rad_s};
}

/// Distance of the vehicle from its reference in (x, z) [m].
template <class T>
T tracking_error(const VehicleState<T>& state, const BasicReferencePoint<T>& reference) {
    const T dx = reference.position[0] - state.plant.q[0];
    const T dz = reference.position[1] - state.plant.q[1];
    return lane::sqrt(dx * dx + dz * dz);
}

/// How far beyond stability: positive where a number is not finite, or the vehicle tumbles or runs away.
template <class T>
T instability(const VehicleState<T>& state, T tracking_error_m) {
    T sum(0);  // not finite as soon as one number is not
    for (int i = 0; i < 4; ++i) {
        sum = sum + lane::abs(state.plant.q[i]) + lane::abs(state.plant.u[i]);
    }
    const T excess =
        lane::max(lane::abs(state.plant.q[2]) - T(unstable_pitch_rad), tracking_error_m - T(unstable_error_m));
    return lane::select(sum < T(1e4), excess, T(1));
}

/// The first of the rules unstable, saturation, tracking, bounds and arm limits that the end of a tick breaks, as the
/// number of its Rejection; 0 for none.
/// @param saturation of the tick   @param state,reference at its end
template <class T>
T broken_rule(const RuleLimits& limits, T saturation, const VehicleState<T>& state,
              const BasicReferencePoint<T>& reference) {
    const auto number_of = [](Rejection rejection) { return T(static_cast<double>(rejection)); };
    const T* q = state.plant.q;
    const T error_m = tracking_error(state, reference);
    const T beyond_bounds = lane::max(lane::max(T(limits.x_low_m) - q[0], q[0] - T(limits.x_high_m)),
                                      lane::max(T(limits.z_low_m) - q[1], q[1] - T(limits.z_high_m)));
    const T beyond_arm = lane::max(T(limits.arm_low_rad) - q[3], q[3] - T(limits.arm_high_rad));
    const T beyond_tracking = lane::max(error_m - T(limits.max_tracking_error_m),
                                        lane::abs(reference.position[2] - q[3]) - T(limits.max_arm_error_rad));
    T rejection = lane::select(beyond_arm > T(0), number_of(Rejection::arm_limits), T(0));
    rejection = lane::select(beyond_bounds > T(0), number_of(Rejection::bounds), rejection);
    rejection = lane::select(beyond_tracking > T(0), number_of(Rejection::tracking), rejection);
    // Not a number either: a limit of the actuators may have hidden that nothing sensible was asked of them.
    rejection = lane::select(saturation <= T(limits.max_saturation), rejection, number_of(Rejection::saturation));
    const T beyond_stability =
        lane::max(instability(state, error_m), lane::abs(state.plant.u[2]) - T(limits.max_pitch_rate_rad_s));
    return lane::select(beyond_stability > T(0), number_of(Rejection::unstable), rejection);
}

/// Adds what one tick contributes.
template <class T>
void add_tick(BasicFlightSums<T>& sums, const PlantModel& plant, const VehicleState<T>& before,
              const VehicleState<T>& next) {
    const T dx = next.plant.q[0] - before.plant.q[0];
    const T dz = next.plant.q[1] - before.plant.q[1];
    const T da = T(0.5 * plant.arm_length_m) * (next.plant.q[3] - before.plant.q[3]);
    sums.length_m = sums.length_m + lane::sqrt(dx * dx + dz * dz + da * da);
}

}  // namespace downwash::simulation
