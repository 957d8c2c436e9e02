#pragma once

#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"

namespace downwash {

/// The vertical plane in which the manipulator moves. A plane coordinate (x, z) is the world point
/// origin + x (cos h, sin h, 0) + z (0, 0, 1); "lateral" is the distance to the left of the plane.
class DOWNWASH_EXPORT PlaneOfMotion {
 public:
    PlaneOfMotion() : PlaneOfMotion({0, 0, 0}, 0) {}
    /// @param origin_m a world point of the plane  @param heading_rad of its x axis about the world's z
    PlaneOfMotion(const Vector3& origin_m, double heading_rad);

    [[nodiscard]] const Vector3& origin_m() const noexcept { return origin_m_; }
    [[nodiscard]] double heading_rad() const noexcept { return heading_rad_; }
    [[nodiscard]] double cos_heading() const noexcept { return cos_; }
    [[nodiscard]] double sin_heading() const noexcept { return sin_; }

    /// World position of the plane coordinates (x, z), `lateral_m` to the left of the plane.
    [[nodiscard]] Vector3 to_world(double x_m, double lateral_m, double z_m) const noexcept {
        return {origin_m_[0] + x_m * cos_ - lateral_m * sin_, origin_m_[1] + x_m * sin_ + lateral_m * cos_,
                origin_m_[2] + z_m};
    }

    /// Plane coordinates (x, lateral, z) of a world position.
    [[nodiscard]] Vector3 from_world(const Vector3& p_m) const noexcept {
        const double dx = p_m[0] - origin_m_[0];
        const double dy = p_m[1] - origin_m_[1];
        return {dx * cos_ + dy * sin_, -dx * sin_ + dy * cos_, p_m[2] - origin_m_[2]};
    }

 private:
    Vector3 origin_m_;
    double heading_rad_;
    double cos_;
    double sin_;
};

}  // namespace downwash
