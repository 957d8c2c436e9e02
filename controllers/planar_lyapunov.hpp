#pragma once

#include <string>

#include "downwash/controllers/aids.hpp"
#include "downwash/controllers/model_inversion.hpp"

namespace downwash {

/// The Lyapunov laws of the thesis for the vehicle in its plane of motion, with its arm (docs/model.md 5.8). Each
/// coordinate has gains k and k' [1/s], both > 0. The defaults suit the shipped vehicle.
///
/// The law of a coordinate is x_d'' + (k^2 - 1) e - (k + k') e' = x_d'' - (1 + k k') e - (k + k') de/dt, with
/// de/dt = dx/dt - dx_d/dt: a model inversion without integrals. It is flown as one.
struct PlanarLyapunov {
    static constexpr const char* name = "lyapunov";

    double horizontal_k = 1.1;       ///< gain of the error along x
    double horizontal_k_rate = 1.1;  ///< k', gain of the speed's error
    double vertical_k = 3.4;         ///< gain of the error along z
    double vertical_k_rate = 3.4;
    double pitch_k = 5.2;  ///< gain of the pitch against the tilt that x and z ask for
    double pitch_k_rate = 5.2;
    double joint_k = 4.8;  ///< gain of the arm's angle
    double joint_k_rate = 4.8;

    double pitch_rate_filter_s = 0.25;  ///< time constant of the filtered derivative of the tilt that is asked for

    double rotor_lead = 0;  ///< see controllers::limit_rotors()

    controllers::Aids aids;  ///< observer, and the feed-forward in the place of K_c

    double max_tilt_rad = 0.6108652381980153;  ///< 35 degrees: the pitch reference is clipped to this
    double min_vertical_force_ratio = 0.2;     ///< least vertical force over the weight

    /// The model inversion that demands the same accelerations.
    [[nodiscard]] ModelInversion inverted() const {
        const auto stiffness = [](double k, double k_rate) { return 1 + k * k_rate; };
        ModelInversion law;
        law.position_kp = stiffness(horizontal_k, horizontal_k_rate);
        law.position_kd = horizontal_k + horizontal_k_rate;
        law.height_kp = stiffness(vertical_k, vertical_k_rate);
        law.height_kd = vertical_k + vertical_k_rate;
        law.attitude_rate_kp = pitch_k + pitch_k_rate;
        law.attitude_kp = stiffness(pitch_k, pitch_k_rate) / law.attitude_rate_kp;
        law.pitch_rate_filter_s = pitch_rate_filter_s;
        law.arm_kp = stiffness(joint_k, joint_k_rate);
        law.arm_kd = joint_k + joint_k_rate;
        law.rotor_lead = rotor_lead;
        law.aids = aids;
        law.max_tilt_rad = max_tilt_rad;
        law.min_vertical_force_ratio = min_vertical_force_ratio;
        return law;
    }

    /// The law's keys in a robot file, below `controller`.
    template <class Rows>
    static void describe(Rows& rows) {
        using Law = PlanarLyapunov;
        const auto add_pair = [&rows](const std::string& of, double Law::*k, double Law::*k_rate) {
            rows.add(rows.number(of + ".k", "of the error [1/s]", k).at_least(1e-3).at_most(1e3));
            rows.add(
                rows.number(of + ".k_rate", "k', of the error of the speed [1/s]", k_rate).at_least(1e-3).at_most(1e3));
        };
        rows.optional_group("horizontal", "x of the multirotor to acceleration");
        add_pair("horizontal", &Law::horizontal_k, &Law::horizontal_k_rate);
        rows.optional_group("vertical", "height of the multirotor to acceleration");
        add_pair("vertical", &Law::vertical_k, &Law::vertical_k_rate);
        rows.optional_group("pitch", "pitch of the multirotor to torque");
        add_pair("pitch", &Law::pitch_k, &Law::pitch_k_rate);
        rows.add(rows.number("pitch.rate_filter_s", "time constant of the filtered derivative of the pitch reference",
                             &Law::pitch_rate_filter_s)
                     .at_least(0)
                     .at_most(100));
        rows.optional_group("joint", "arm angle to joint torque");
        add_pair("joint", &Law::joint_k, &Law::joint_k_rate);
        rows.add_limits();
        rows.add_aids();
    }
};

}  // namespace downwash
