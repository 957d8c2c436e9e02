#pragma once

#include <fcl/narrowphase/collision_object.h>

#include <vector>

#include "downwash/problems/problem.hpp"

namespace downwash::bench {

/// Collisions as they are first written: FCL asked for every part of the robot and every obstacle, one pair after the
/// other. Not safe to share between threads.
class PlainCollisions {
 public:
    /// @throws std::invalid_argument for obstacles other than boxes, cylinders and spheres
    explicit PlainCollisions(const Problem& problem);

    /// Whether nothing touches. @param q (x, z, pitch, arm) [m, m, rad, rad]
    [[nodiscard]] bool is_free(const double q[4]);

 private:
    PlaneOfMotion plane_;
    std::vector<fcl::CollisionObjectd> obstacles_;
    std::vector<fcl::CollisionObjectd> parts_;  ///< the arm last
    std::vector<Eigen::Quaterniond> part_turns_;
    std::vector<Eigen::Vector3d> part_centers_m_;
    Eigen::Vector3d joint_m_;
    double arm_length_m_;
};

}  // namespace downwash::bench
