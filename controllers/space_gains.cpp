#include "downwash/controllers/space_gains.hpp"

#include <algorithm>
#include <limits>

namespace downwash {
namespace {

/// Lags of the rotors count as if they were no shorter: 0.35 / lag stays finite.
constexpr double min_lag_s = 1e-6;
constexpr double max_attitude_rad_s = 12;

double attitude_bandwidth(double lag_s, const SpaceBandwidths& bandwidths) {
    return bandwidths.attitude_rad_s.value_or(std::min(0.35 / std::max(lag_s, min_lag_s), max_attitude_rad_s));
}

double joint_bandwidth(const SpaceBandwidths& bandwidths) {
    return bandwidths.joint_rad_s.value_or(SpaceBandwidths::least_joint_rad_s);
}

/// s^2 + 2 damping w s + w^2, and an integral whose share of w^3 leaves the damping nearly as it is.
SpaceLoopGains loop_gains(double rad_s, double damping, double integral_share, double integral_limit) {
    return {rad_s * rad_s, 2 * damping * rad_s, integral_share * rad_s * rad_s * rad_s, integral_limit};
}

}  // namespace

SpaceInversion gains_for(double rotor_time_constant_s, const SpaceBandwidths& bandwidths) {
    // A rate loop k (r - w) with r = k' e has the frequency sqrt(k k') and the damping sqrt(k / k') / 2.
    const double attitude_rad_s = attitude_bandwidth(rotor_time_constant_s, bandwidths);
    SpaceInversion law;
    law.horizontal = loop_gains(bandwidths.translation_rad_s, 0.85, 0.28, 2);
    law.height = loop_gains(bandwidths.height_rad_s, 1, 0.14, 2);
    law.joint = loop_gains(joint_bandwidth(bandwidths), 1, 0.05, 5);
    law.attitude_kp_1_s = 0.5 * attitude_rad_s;
    law.rate_kp_1_s = 2 * attitude_rad_s;
    law.rate_ki_1_s2 = 0.16 * attitude_rad_s * attitude_rad_s;
    law.yaw_kp_1_s = 0.5 * bandwidths.yaw_rad_s;
    law.yaw_rate_kp_1_s = 2 * bandwidths.yaw_rad_s;
    law.direction_rate_filter_s = 1.75 / attitude_rad_s;
    law.observer_gain_1_s = bandwidths.observer_gain_1_s.value_or(SpaceBandwidths::least_observer_1_s);
    return law;
}

Px4Cascade cascade_gains_for(double rotor_time_constant_s, const SpaceBandwidths& bandwidths) {
    const double attitude_rad_s = attitude_bandwidth(rotor_time_constant_s, bandwidths);
    Px4Cascade law;
    law.position_p_1_s = 0.5 * bandwidths.translation_rad_s;
    law.velocity = {2 * bandwidths.translation_rad_s, 0.4 * bandwidths.translation_rad_s * bandwidths.translation_rad_s,
                    0, 4};
    law.height_p_1_s = 0.5 * bandwidths.height_rad_s;
    law.vertical_velocity = {2 * bandwidths.height_rad_s, 0.2 * bandwidths.height_rad_s * bandwidths.height_rad_s, 0,
                             4};
    law.attitude_p_1_s = 0.5 * attitude_rad_s;
    law.rate = {2 * attitude_rad_s, 0.16 * attitude_rad_s * attitude_rad_s, 0, 10};
    law.yaw_p_1_s = 0.5 * bandwidths.yaw_rad_s;
    law.yaw_rate = {2 * bandwidths.yaw_rad_s, 0.16 * bandwidths.yaw_rad_s * bandwidths.yaw_rad_s, 0, 5};
    law.joint = loop_gains(3 * joint_bandwidth(bandwidths), 1, 0.3, 500);
    return law;
}

ModelInversion planar_gains_for(double rotor_time_constant_s, const SpaceBandwidths& bandwidths) {
    const SpaceInversion space = gains_for(rotor_time_constant_s, bandwidths);
    ModelInversion law;
    law.position_kp = space.horizontal.kp_1_s2;
    law.position_kd = space.horizontal.kd_1_s;
    law.position_ki = space.horizontal.ki_1_s3;
    law.height_kp = space.height.kp_1_s2;
    law.height_kd = space.height.kd_1_s;
    law.height_ki = space.height.ki_1_s3;
    law.arm_kp = space.joint.kp_1_s2;
    law.arm_kd = space.joint.kd_1_s;
    law.arm_ki = space.joint.ki_1_s3;
    law.attitude_kp = space.attitude_kp_1_s;
    law.attitude_rate_kp = space.rate_kp_1_s;
    law.attitude_rate_ki = space.rate_ki_1_s2;
    law.pitch_rate_filter_s = space.direction_rate_filter_s;
    law.rotor_lead = rotor_time_constant_s > 0 ? space.rotor_lead : 0;
    if (space.observer_gain_1_s > 0) {
        law.aids.observer = controllers::DisturbanceObserver{space.observer_gain_1_s};
    }
    return law;
}

SpaceInversion from_planar(const ModelInversion& planar) {
    const auto axis = [&](int i) {
        const ModelInversion::AxisGains gains = planar.axis_gains(i);
        return SpaceLoopGains{gains.kp, gains.kd, gains.ki, planar.position_integral_limit_m_s2};
    };
    SpaceInversion law;
    law.horizontal = axis(0);
    law.height = axis(1);
    law.joint = {planar.arm_kp, planar.arm_kd, planar.arm_ki, planar.arm_integral_limit_rad_s2};
    law.attitude_kp_1_s = law.yaw_kp_1_s = planar.attitude_kp;
    law.rate_kp_1_s = law.yaw_rate_kp_1_s = planar.attitude_rate_kp;
    law.rate_ki_1_s2 = law.yaw_rate_ki_1_s2 = planar.attitude_rate_ki;
    law.rate_integral_limit_rad_s2 = planar.attitude_integral_limit_rad_s2;
    law.direction_rate_filter_s = planar.pitch_rate_filter_s;
    law.rate_feed_forward = planar.rate_feed_forward;
    law.max_rate_rad_s = std::numeric_limits<double>::infinity();
    law.max_tilt_rad = planar.max_tilt_rad;
    law.rotor_lead = planar.rotor_lead;
    law.observer_gain_1_s = planar.aids.observer ? planar.aids.observer->gain_1_s : 0;
    law.min_vertical_force_ratio = planar.min_vertical_force_ratio;
    if (planar.aids.feed_forward) {
        law.feed_forward = true;
        law.feed_forward_offset_m = {planar.aids.feed_forward->offset_x_m, 0, planar.aids.feed_forward->offset_z_m};
    }
    return law;
}

}  // namespace downwash
