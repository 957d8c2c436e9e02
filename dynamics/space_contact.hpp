#pragma once

#include <cmath>

#include "downwash/dynamics/ceiling_contact.hpp"

// A vehicle in space that touches a plane surface: compliant, one-sided, with friction (docs/model.md 2.11).
// space_contact_step.hpp flies it.

namespace downwash::dynamics {

/// A point of a vehicle that may touch.
struct SpaceContactPoint {
    int link = -1;  ///< that it belongs to, -1: the multirotor
    LaneVector<double> at_m{0, 0,
                            0};  ///< from the link's joint in its own axes, or from the multirotor's centre of mass
};

/// The surface, what touches it, and what both are like. The default stiffness lets a vehicle of 5 kg that comes with
/// two points at 0.3 m/s in by 1.5 mm.
struct SpaceContact {
    LaneVector<double> surface_m{0, 0, 0};  ///< a point of it
    LaneVector<double> normal{0, 0, -1};    ///< unit vector out of the surface, towards the vehicle
    int point_count = 0;
    SpaceContactPoint point[max_contact_points] = {};
    double stiffness_n_m = 1e5;    ///< k of each point, > 0
    double dissipation_s_m = 10;   ///< c: normal force k d (1 + c d') at the depth d (Hunt and Crossley 1975), >= 0
    double friction = 0.5;         ///< Coulomb's, >= 0
    double slip_speed_m_s = 0.02;  ///< speed at which friction has 0.7 of its full force, > 0; below it creeps
};

/// What happened at a surface over one tick.
struct SpaceContactRecord {
    double normal_impulse_n_s = 0;  ///< impulse of the surface on the vehicle
    double depth_m = -INFINITY;     ///< greatest of any point; negative: least distance
    int steps = 0;                  ///< steps of the integrator
};

}  // namespace downwash::dynamics
