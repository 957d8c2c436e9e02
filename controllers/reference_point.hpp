#pragma once

namespace downwash {

/// Where the vehicle and the arm should be at one instant: (x, z, arm) with first and second time derivatives
/// [m, m, rad; per s; per s2], plane coordinates, the arm angle relative to the multirotor and unwrapped.
struct ReferencePoint {
    double position[3] = {0, 0, 0};
    double velocity[3] = {0, 0, 0};
    double acceleration[3] = {0, 0, 0};

    friend bool operator==(const ReferencePoint&, const ReferencePoint&) = default;
};

}  // namespace downwash
