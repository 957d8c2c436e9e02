#pragma once

#include "downwash/dynamics/lane_vector.hpp"

// A frame or rotor guards that touch a level ceiling from below: compliant, one-sided, with friction
// (docs/model.md 2.5). ceiling_tick.hpp flies it.

namespace downwash::dynamics {

/// Most places at which a multirotor can touch.
inline constexpr int max_contact_points = 32;

/// What touches, where the ceiling is, and what both are like. The default stiffness lets 1.5 kg that hit four points
/// at 0.5 m/s in by 1 mm.
struct CeilingContact {
    double ceiling_m = 0;  ///< height of the ceiling in the world
    int point_count = 0;
    LaneVector<double> point_m[max_contact_points] = {};  ///< points that may touch, in the body frame
    double stiffness_n_m = 1e5;                           ///< k of each point, > 0
    double dissipation_s_m = 1;    ///< c: normal force k d (1 + c d') at the depth d (Hunt and Crossley 1975), >= 0
    double friction = 0.5;         ///< Coulomb's, >= 0
    double slip_speed_m_s = 0.02;  ///< speed at which friction has 0.7 of its full force, > 0; below it creeps
};

/// Adds points spread evenly over a ring that is level in the body frame: the rim of a rotor guard.
/// @pre there is room for them
inline void add_ring(CeilingContact& contact, const LaneVector<double>& center_m, double radius_m, int points) {
    for (int i = 0; i < points; ++i) {
        const lane::SinCos turn = lane::sin_cos(6.28318530717958647692 * i / points);
        contact.point_m[contact.point_count++] =
            center_m + LaneVector<double>{radius_m * turn.cosine, radius_m * turn.sine, 0};
    }
}

}  // namespace downwash::dynamics
