#pragma once

#include <memory>
#include <string>
#include <vector>

#include "downwash/judge/space_bodies.hpp"
#include "downwash/scene/shapes.hpp"

// Distances to obstacles, and of a robot to itself, at full attitude by FCL. Private: not installed.

namespace downwash::judge {

/// Where the frames of a robot's bodies are: the multirotor's has its origin in the centre of mass of the robot file, a
/// link's in its joint.
struct BodyFrame {
    Eigen::Vector3d origin_m;
    Eigen::Matrix3d attitude;
};

/// The frames of bodies. @param world in which the vehicle flies: its obstacles see them where these nominally are
[[nodiscard]] DOWNWASH_EXPORT std::vector<BodyFrame> frames_of(const SpaceVehicle& vehicle, const BodyMotions& bodies,
                                                               const SpaceWorld& world);

/// The obstacles of a scene and a robot among them. See Obstacles for how far distances are trusted. Safe to share
/// between threads.
class SpaceObstacles {
 public:
    /// @pre Scene would take the obstacles
    DOWNWASH_EXPORT SpaceObstacles(const std::vector<Obstacle>& obstacles, const SpaceRobot& robot);
    DOWNWASH_EXPORT ~SpaceObstacles();
    SpaceObstacles(const SpaceObstacles&) = delete;
    SpaceObstacles& operator=(const SpaceObstacles&) = delete;

    /// Least distance from the robot to an obstacle [m]; 0 on contact, infinity without obstacles.
    [[nodiscard]] DOWNWASH_EXPORT double clearance_m(const std::vector<BodyFrame>& frames) const;
    /// Least distance of two bodies that may meet (docs/model.md 7.7) [m]; 0 on contact, infinity where none may.
    [[nodiscard]] DOWNWASH_EXPORT double self_clearance_m(const std::vector<BodyFrame>& frames) const;
    /// Whether a level rotor disc keeps a distance from all obstacles.
    [[nodiscard]] DOWNWASH_EXPORT bool disc_keeps(double distance_m, const Eigen::Vector3d& hub_m) const;

    /// Whether the line between two points keeps a distance from all obstacles.
    [[nodiscard]] DOWNWASH_EXPORT bool line_keeps(double distance_m, const Eigen::Vector3d& from_m,
                                                  const Eigen::Vector3d& to_m) const;
    /// How far the solids of a body reach beyond a point of theirs along a direction of length 1 [m], >= 0.
    [[nodiscard]] DOWNWASH_EXPORT double reach_beyond_m(const std::vector<BodyFrame>& frames, std::size_t body,
                                                        const Eigen::Vector3d& point_m,
                                                        const Eigen::Vector3d& direction) const;

    /// How far the solids of each body reach from the origin of its frame [m].
    [[nodiscard]] const std::vector<double>& reach_m() const noexcept { return reach_m_; }

 private:
    struct Solids;
    std::unique_ptr<const Solids> solids_;
    std::vector<double> reach_m_;
};

/// The obstacles of one name.
class NamedObstacle {
 public:
    DOWNWASH_EXPORT NamedObstacle(const std::vector<Obstacle>& all, const std::string& name);
    DOWNWASH_EXPORT ~NamedObstacle();
    NamedObstacle(const NamedObstacle&) = delete;
    NamedObstacle& operator=(const NamedObstacle&) = delete;

    /// How far a point is from them [m]; 0 within, infinity where there are none.
    [[nodiscard]] DOWNWASH_EXPORT double distance_m(const Eigen::Vector3d& at_m) const;

 private:
    struct Solids;
    std::unique_ptr<const Solids> solids_;
};

}  // namespace downwash::judge
