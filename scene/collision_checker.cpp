#include "downwash/scene/collision_checker.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/infinity.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/scene/convex.hpp"
#include "downwash/scene/fcl_distances.hpp"
#include "downwash/scene/robot_solids.hpp"
#include "downwash/scene/scene_solids.hpp"

namespace downwash {
namespace {

constexpr std::size_t arm_frame = 1;

bool has_finite_pose(const PlanarPose& pose) {
    return std::isfinite(pose.x_m + pose.z_m + pose.pitch_rad + pose.arm_rad + pose.lateral_m);
}

/// A frame of the robot in the frame of the plane of motion (x along the heading, y to the left, z up): turned by an
/// angle about the lateral axis, then moved.
struct Frame {
    double x_m, lateral_m, z_m, cosine, sine;

    Vector3 turned(const Vector3& v) const { return {cosine * v[0] + sine * v[2], v[1], cosine * v[2] - sine * v[0]}; }
    Vector3 placed(const Vector3& p_m) const {
        const Vector3 p = turned(p_m);
        return {x_m + p[0], lateral_m + p[1], z_m + p[2]};
    }
    /// In the world.
    Convex placed(const Convex& own, const PlaneOfMotion& plane) const {
        const auto in_world = [&](const Vector3& own_direction) {
            const Vector3 v = turned(own_direction);
            return Vector3{v[0] * plane.cos_heading() - v[1] * plane.sin_heading(),
                           v[0] * plane.sin_heading() + v[1] * plane.cos_heading(), v[2]};
        };
        const Vector3 center = placed(own.center_m);
        return downwash::placed(own, plane.to_world(center[0], center[1], center[2]), in_world);
    }
};

Frame frame_at(const Vector3& origin_m, double angle_rad) {
    const auto [sine, cosine] = lane::sin_cos(angle_rad);
    return {origin_m[0], origin_m[1], origin_m[2], cosine, sine};
}

void require_valid(const RobotShape& robot) {
    std::vector<KeyError> errors;
    for (std::size_t i = 0; i < robot.bodies.size(); ++i) {
        inspect(robot.bodies[i].shape, "bodies[" + std::to_string(i) + "]", errors);
    }
    const auto inspect_length = [&](double length_m, const char* key) {
        if (!(std::isfinite(length_m) && length_m > 0)) {
            errors.push_back({key, "must be a finite length above 0 in metres"});
        }
    };
    inspect_length(robot.arm_length_m, "arm_length_m");
    inspect_length(robot.arm_radius_m, "arm_radius_m");
    throw_if_any(std::move(errors));
}

/// Upper bound of the distance from the frame's origin to any point of the solid.
double reach_of(const Convex& convex) {
    const BoundingBox bounds = bounds_of(convex);
    double squared = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double farthest = std::max(std::abs(bounds.low_m[k]), std::abs(bounds.high_m[k]));
        squared += farthest * farthest;
    }
    return std::sqrt(squared);
}

constexpr std::string_view kind_names[] = {"own", "fcl"};

}  // namespace

std::string_view name_of(CollisionCheckerKind kind) {
    return kind_names[static_cast<std::size_t>(kind)];
}

struct CollisionChecker::Impl {
    Impl(std::shared_ptr<const Scene> scene, const PlaneOfMotion& plane, RobotShape robot, CollisionCheckerKind kind);

    const FclDistances& fcl() const {
        std::call_once(is_fcl_made,
                       [this] { made_fcl = std::make_unique<const FclDistances>(scene, solids_of(robot), reach_m); });
        return *made_fcl;
    }

    /// Calls `visit(piece placed in the world)` until it returns true; whether it did.
    template <class Visit>
    bool any_piece(const PlanarPose& pose, const Visit& visit) const {
        const Frame body = frame_at({pose.x_m, pose.lateral_m, pose.z_m}, pose.pitch_rad);
        const Frame arm = frame_at(body.placed(joint_m), pose.pitch_rad + pose.arm_rad);
        return std::any_of(pieces.begin(), pieces.end(), [&](const RobotPiece& piece) {
            return visit((piece.frame == arm_frame ? arm : body).placed(piece.convex, plane));
        });
    }

    /// Whether the box that holds the robot at any attitude keeps `margin_m` from every obstacle.
    bool is_far_away(const PlanarPose& pose, double margin_m) const {
        return downwash::is_far_away(solids, plane.to_world(pose.x_m, pose.lateral_m, pose.z_m), reach_m, margin_m);
    }

    std::shared_ptr<const Scene> scene;
    const SceneSolids& solids;
    PlaneOfMotion plane;
    RobotShape robot;
    CollisionCheckerKind kind;
    std::vector<RobotPiece> pieces;
    Vector3 joint_m;          ///< in the body frame
    double reach_m = 0;       ///< the reach of all pieces
    double body_reach_m = 0;  ///< the reach of the pieces of the multirotor
    mutable std::once_flag is_fcl_made;
    mutable std::unique_ptr<const FclDistances> made_fcl;
};

CollisionChecker::Impl::Impl(std::shared_ptr<const Scene> the_scene, const PlaneOfMotion& the_plane,
                             RobotShape the_robot, CollisionCheckerKind the_kind)
    : scene(std::move(the_scene)),
      solids(scene->solids()),
      plane(the_plane),
      robot(std::move(the_robot)),
      kind(the_kind),
      joint_m{robot.joint_x_m, 0, robot.joint_z_m} {
    require_valid(robot);
    pieces = pieces_of(solids_of(robot));
    for (const RobotPiece& piece : pieces) {
        const bool is_arm = piece.frame == arm_frame;
        const double offset =
            is_arm ? std::sqrt(robot.joint_x_m * robot.joint_x_m + robot.joint_z_m * robot.joint_z_m) : 0;
        reach_m = std::max(reach_m, offset + reach_of(piece.convex));
        body_reach_m = is_arm ? body_reach_m : std::max(body_reach_m, reach_of(piece.convex));
    }
}

CollisionChecker::CollisionChecker(std::shared_ptr<const Scene> scene, const PlaneOfMotion& plane,
                                   const RobotShape& robot, CollisionCheckerKind kind)
    : impl_(std::make_shared<const Impl>(std::move(scene), plane, robot, kind)) {}

CollisionCheckerKind CollisionChecker::kind() const noexcept {
    return impl_->kind;
}

bool CollisionChecker::is_nearer_than(const PlanarPose& pose, double margin_m) const {
    if (!has_finite_pose(pose)) {
        return true;
    }
    if (impl_->kind == CollisionCheckerKind::fcl) {
        const double margins_m[] = {margin_m, margin_m};
        return impl_->fcl().is_nearer_than(planar_frames(impl_->plane, impl_->joint_m, pose), margins_m);
    }
    return !impl_->is_far_away(pose, std::max(margin_m, contact_m)) &&
           impl_->any_piece(pose, [&](const Convex& piece) { return impl_->solids.are_near(piece, margin_m); });
}

double CollisionChecker::body_reach_m() const noexcept {
    return impl_->body_reach_m;
}

double CollisionChecker::robot_reach_m() const noexcept {
    return impl_->reach_m;
}

double CollisionChecker::clearance_m(const PlanarPose& pose) const {
    if (!has_finite_pose(pose)) {
        return -infinity;
    }
    if (impl_->kind == CollisionCheckerKind::fcl) {
        return impl_->fcl().clearance_m(planar_frames(impl_->plane, impl_->joint_m, pose), infinity);
    }
    return clearance_of(impl_->solids, infinity, [&](const auto& visit) { impl_->any_piece(pose, visit); });
}

std::optional<std::size_t> CollisionChecker::nearest_obstacle(const PlanarPose& pose, double within_m) const {
    if (!has_finite_pose(pose)) {
        return std::nullopt;
    }
    return nearest_of(impl_->solids, within_m, [&](const auto& visit) { impl_->any_piece(pose, visit); });
}

}  // namespace downwash
