#pragma once

namespace downwash {

/// Gains of the model-inversion controllers (docs/model.md 5): v = acc_ref + kd e' + kp e + ki integral e.
struct ControllerGains {
    double rate_hz = 100;  ///< control ticks per second; a command is held over one tick

    double position_kp = 0;                     ///< [1/s2]
    double position_kd = 0;                     ///< [1/s]
    double position_ki = 0;                     ///< [1/s3]
    double position_integral_limit_m_s2 = 2.0;  ///< most that ki * integral may ask for, per axis

    double attitude_k5 = 0;    ///< pitch angle to pitch rate [1/s]
    double attitude_ku5 = 0;   ///< pitch rate to pitch acceleration [1/s]
    double attitude_kiu5 = 0;  ///< integral of the pitch rate error [1/s2]
    double attitude_integral_limit_rad_s2 = 5.0;
    double pitch_rate_filter_s = 0.1;  ///< time constant of the filtered derivative of the pitch reference
    bool rate_feed_forward = false;    ///< adds d(u5_ref)/dt to the pitch acceleration

    double arm_kp = 0;  ///< [1/s2]
    double arm_kd = 0;  ///< [1/s]
    double arm_ki = 0;  ///< [1/s3]
    double arm_integral_limit_rad_s2 = 5.0;

    double max_tilt_rad = 0.6108652381980153;  ///< 35 degrees: the pitch reference is clipped to this
    double min_vertical_force_ratio = 0.2;     ///< f_min of the inversion as a share of the weight
};

}  // namespace downwash
