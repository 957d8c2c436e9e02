#pragma once

namespace downwash {

/// Where the vehicle and the arm should be at one instant: (x, z, arm) with first and second time derivatives
/// [m, m, rad; per s; per s2], plane coordinates, the arm angle relative to the multirotor and unwrapped. One template
/// over the lane type.
template <class T>
struct BasicReferencePoint {
    T position[3]{};
    T velocity[3]{};
    T acceleration[3]{};

    friend bool operator==(const BasicReferencePoint&, const BasicReferencePoint&) = default;
};

/// That of one vehicle.
using ReferencePoint = BasicReferencePoint<double>;

}  // namespace downwash
