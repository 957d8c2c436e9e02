#include "downwash/scene/plane_of_motion.hpp"

#include "downwash/base/lane_math.hpp"

namespace downwash {

PlaneOfMotion::PlaneOfMotion(const Vector3& origin_m, double heading_rad)
    : origin_m_(origin_m), heading_rad_(heading_rad) {
    lane::sin_cos(heading_rad, sin_, cos_);
}

}  // namespace downwash
