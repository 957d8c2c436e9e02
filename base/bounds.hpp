#pragma once

namespace downwash {

/// A rectangle of plane coordinates [m].
struct Bounds {
    double x_low_m = 0, x_high_m = 0;
    double z_low_m = 0, z_high_m = 0;
};

}  // namespace downwash
