#pragma once

namespace downwash {

/// Where the robot's bodies are: planar position of the multirotor's centre of mass [m], pitch and arm angle relative
/// to the multirotor [rad] (docs/model.md 1: pitch positive nose down, arm direction (cos a, -sin a) with a = pitch +
/// arm). Only collision and clearance know of a displacement beside the plane.
struct PlanarPose {
    double x_m = 0;
    double z_m = 0;
    double pitch_rad = 0;
    double arm_rad = 0;
    double lateral_m = 0;  ///< to the left of the plane
};

}  // namespace downwash
