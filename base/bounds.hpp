#pragma once

#include "downwash/base/vector3.hpp"

namespace downwash {

/// A rectangle of plane coordinates [m].
struct Bounds {
    double x_low_m = 0, x_high_m = 0;
    double z_low_m = 0, z_high_m = 0;
};

/// A box of the world [m]: where the multirotor's centre of mass may be.
struct SpaceBounds {
    Vector3 low_m = {}, high_m = {};  ///< low < high in each coordinate
};

}  // namespace downwash
