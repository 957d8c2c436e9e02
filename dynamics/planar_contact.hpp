#pragma once

#include <cmath>

#include "downwash/dynamics/plant_state.hpp"

// A vehicle in the plane that touches a plane surface: compliant, one-sided, with friction (docs/model.md 2.6).
// contact_step.hpp flies it.

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
    double slip_speed_m_s = 0.02;  ///< speed at which friction has 0.7 of its full force, > 0; below it creeps
};

/// What happened at a surface over one tick.
struct ContactTickRecord {
    double normal_impulse_n_s = 0;  ///< impulse of the surface on the vehicle
    double depth_m = -INFINITY;     ///< greatest of any point; negative: least distance
    int steps = 0;                  ///< steps of the integrator
};

}  // namespace downwash::dynamics
