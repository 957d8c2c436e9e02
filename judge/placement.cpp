#include "downwash/judge/placement.hpp"

namespace downwash::judge {

Eigen::Quaterniond turn_from_z(const Eigen::Vector3d& direction) {
    return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), direction);
}

}  // namespace downwash::judge
