#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "downwash/dynamics/space_integration.hpp"
#include "downwash/identification/logged_flight.hpp"
#include "downwash/identification/vehicle_estimate.hpp"
#include "downwash/simulation/space_world.hpp"

// Private to identification/: a trial as a filter of n joints needs it.

namespace downwash::identification {

/// What acts on a vehicle in a logged flight: rotors, air, and surfaces as a trial has them.
struct LoggedSpace : dynamics::CalmSpace {
    const double* rotor_scale;  ///< thrust over that of the nominal coefficient, of each rotor
    const double* ratio;        ///< K of each rotor
    dynamics::LaneVector<double> wind_m_s;
    const SpaceSlipstreams* streams;
    double stream_scale;

    template <class T>
    T thrust_ratio(int rotor, const dynamics::LaneVector<T>& /*hub_m*/, const dynamics::LaneVector<T>& /*axis*/) const {
        return T(ratio[rotor]);
    }
    [[nodiscard]] double thrust_scale(int rotor) const { return rotor_scale[rotor]; }
    static constexpr bool has_wind = true;
    [[nodiscard]] dynamics::LaneVector<double> wind() const { return wind_m_s; }
    static constexpr bool has_wash = true;
    /// Flights are so exact that two points along a link would make the multirotor's drag wrong by 0.1 %.
    static constexpr int drag_pieces = 8;
    [[nodiscard]] const SpaceSlipstreams& slipstreams() const { return *streams; }
    [[nodiscard]] double wash_scale() const { return stream_scale; }
};

/// Runge-Kutta steps are at most so long [s].
inline constexpr double longest_step_s = 0.005;

/// A trial as numbers of the plant, the air and the sensors.
template <int n>
struct TrialModel {
    SpaceModel<n> plant;
    int joint_steps;
    Eigen::Vector3d center_of_mass_m, wind_m_s;
    double rotor_scale[max_rotors];
    double stream_scale, delay_s;
    Eigen::Quaterniond attitude_bias;
    double joint_offset_rad[room_for<n>] = {};
    std::vector<double> surface_effects;

    /// @param max_delay_s a longer delay counts as this one
    TrialModel(const Trial& trial, const LoggedFlight& flight, double max_delay_s)
        : plant(make_space_model<n>(simulation::real_plant(trial.robot, trial.world))),
          joint_steps(dynamics::joint_steps(plant, longest_step_s)),
          center_of_mass_m(vector_of(trial.world.center_of_mass_m)),
          wind_m_s(vector_of(trial.world.wind_m_s)),
          stream_scale(1 + trial.world.wash_scale),
          delay_s(std::clamp(trial.robot.controller.delay_s + trial.world.delay_s, 0.0, max_delay_s)),
          attitude_bias(turn_by(vector_of(trial.world.attitude_bias_rad))),
          surface_effects(trial.surface_effects) {
        for (int i = 0; i < max_rotors; ++i) {
            rotor_scale[i] = (1 + trial.world.thrust_scale) * (1 + trial.world.rotor_thrust_scale[i]);
        }
        std::copy_n(trial.world.joint_offset_rad, n, joint_offset_rad);
        if (flight.is_true_motion) {
            delay_s = 0;
            attitude_bias.setIdentity();
            std::fill_n(joint_offset_rad, n, 0.0);
        }
    }
};

}  // namespace downwash::identification
