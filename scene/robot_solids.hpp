#pragma once

// The solids of a robot, each fixed to one of its frames, for our own checker and for FCL. Private: not installed.

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/scene/convex.hpp"
#include "downwash/scene/planar_pose.hpp"
#include "downwash/scene/plane_of_motion.hpp"
#include "downwash/scene/scene_solids.hpp"
#include "downwash/scene/space_shape.hpp"

namespace downwash {

/// A solid that is fixed to one of a robot's frames: 0 is that of the multirotor, 1 that of the first link and so on.
struct FramedSolid {
    SpaceBodyShape solid;
    std::size_t frame = 0;
};

/// The same as a convex solid in its frame.
struct RobotPiece {
    Convex convex;
    std::size_t frame = 0;
};

/// Where a frame of a robot is in the world.
struct RobotFrame {
    Matrix3 rotation{};  ///< from its axes to those of the world
    Vector3 origin_m{};

    [[nodiscard]] Vector3 placed(const Vector3& p_m) const noexcept { return rotation * p_m + origin_m; }
    [[nodiscard]] Convex placed(const Convex& own) const noexcept {
        return downwash::placed(own, placed(own.center_m), [&](const Vector3& v) { return rotation * v; });
    }
};

/// The multirotor's bodies in frame 0 and the arm in frame 1, from its joint, x along the arm.
[[nodiscard]] DOWNWASH_EXPORT std::vector<FramedSolid> solids_of(const RobotShape& robot);

[[nodiscard]] std::vector<RobotPiece> pieces_of(const std::vector<FramedSolid>& solids);

/// Adds what is wrong with a solid, under keys such as `key`.box.size_m.
void inspect(const SpaceBodyShape& solid, const std::string& key, std::vector<KeyError>& errors);

/// The frames of a robot that moves in a plane. @param joint_m in the frame of the multirotor
[[nodiscard]] inline std::array<RobotFrame, 2> planar_frames(const PlaneOfMotion& plane, const Vector3& joint_m,
                                                             const PlanarPose& pose) noexcept {
    const auto turned_by = [&plane](double angle_rad) -> Matrix3 {
        const auto [sine, cosine] = lane::sin_cos(angle_rad);
        const double c = plane.cos_heading(), s = plane.sin_heading();
        return {{{c * cosine, -s, c * sine}, {s * cosine, c, s * sine}, {-sine, 0, cosine}}};
    };
    const RobotFrame body{turned_by(pose.pitch_rad), plane.to_world(pose.x_m, pose.lateral_m, pose.z_m)};
    return {body, {turned_by(pose.pitch_rad + pose.arm_rad), body.placed(joint_m)}};
}

/// Whether the box that holds a robot at any attitude keeps a margin from every obstacle.
[[nodiscard]] inline bool is_far_away(const SceneSolids& solids, const Vector3& center_m, double reach_m,
                                      double margin_m) {
    const Vector3 reach{reach_m, reach_m, reach_m};
    const BoundingBox everywhere{center_m - reach, center_m + reach};
    const auto gap = [&](const BoundingBox& box) { return gap_m(everywhere, box); };
    const auto is_near = [&](std::size_t part) { return gap(solids.parts.bounds(part)) <= margin_m; };
    return !solids.parts.any(gap, margin_m, is_near) && !solids.is_inside_mesh(center_m);
}

/// The least distance of a robot's pieces if it is below `enough_m`, else `enough_m`; <= 0 on contact.
/// @param any_piece calls a function with each piece in the world until it returns true
template <class AnyPiece>
[[nodiscard]] double clearance_of(const SceneSolids& solids, double enough_m, const AnyPiece& any_piece) {
    double min_m = enough_m;
    any_piece([&](const Convex& piece) {
        min_m = solids.clearance_m(piece, min_m);
        return false;
    });
    return min_m < contact_m ? std::min(min_m, 0.0) : min_m;
}

/// The number of the obstacle nearest to a robot's pieces, if it is nearer than `within_m`.
/// @param any_piece as of clearance_of
template <class AnyPiece>
[[nodiscard]] std::optional<std::size_t> nearest_of(const SceneSolids& solids, double within_m,
                                                    const AnyPiece& any_piece) {
    std::optional<NearObstacle> nearest;
    any_piece([&](const Convex& piece) {
        if (const auto nearer = solids.nearest(piece, nearest ? nearest->distance_m : within_m)) {
            nearest = nearer;
        }
        return nearest && nearest->distance_m <= 0;
    });
    return nearest ? std::optional(nearest->obstacle) : std::nullopt;
}

}  // namespace downwash
