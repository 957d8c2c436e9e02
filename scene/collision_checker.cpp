#include "downwash/scene/collision_checker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/scene/convex.hpp"
#include "downwash/scene/fcl_distances.hpp"
#include "downwash/scene/scene_solids.hpp"

namespace downwash {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool is_finite(const PlanarPose& pose) {
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
        Convex convex = own;
        convex.center_m = plane.to_world(center[0], center[1], center[2]);
        for (std::size_t i = 0; i < static_cast<std::size_t>(own.segment_count); ++i) {
            convex.half_axes_m[i] = in_world(own.half_axes_m[i]);
        }
        convex.disc_normal = in_world(own.disc_normal);
        return convex;
    }
};

Frame frame_at(const Vector3& origin_m, double angle_rad) {
    const auto [sine, cosine] = lane::sin_cos(angle_rad);
    return {origin_m[0], origin_m[1], origin_m[2], cosine, sine};
}

/// A piece of the robot in its own frame: that of the multirotor, or that of the arm (from the joint, x along the arm).
struct Piece {
    Convex convex;
    bool is_arm = false;
};

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

std::vector<Piece> pieces_of(const RobotShape& robot) {
    std::vector<Piece> pieces;
    for (const BodyShape& body : robot.bodies) {
        const Matrix3 identity{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        pieces.push_back({convex_of(body.shape, body.center_body_m, placement_of(body.shape, identity))});
    }
    const Vector3 half_arm{0.5 * robot.arm_length_m, 0, 0};
    const Convex arm{
        .center_m = half_arm, .segment_count = 1, .half_axes_m = {half_arm}, .ball_radius_m = robot.arm_radius_m};
    pieces.push_back({arm, true});
    return pieces;
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
        std::call_once(is_fcl_made, [this] { made_fcl = std::make_unique<const FclDistances>(scene, plane, robot); });
        return *made_fcl;
    }

    /// Calls `visit(piece placed in the world)` until it returns true; whether it did.
    template <class Visit>
    bool any_piece(const PlanarPose& pose, const Visit& visit) const {
        const Frame body = frame_at({pose.x_m, pose.lateral_m, pose.z_m}, pose.pitch_rad);
        const Frame arm = frame_at(body.placed(joint_m), pose.pitch_rad + pose.arm_rad);
        return std::any_of(pieces.begin(), pieces.end(), [&](const Piece& piece) {
            return visit((piece.is_arm ? arm : body).placed(piece.convex, plane));
        });
    }

    /// Whether the box that holds the robot at any attitude keeps `margin_m` from every obstacle.
    bool is_far_away(const PlanarPose& pose, double margin_m) const {
        const Vector3 center = plane.to_world(pose.x_m, pose.lateral_m, pose.z_m);
        const Vector3 reach{reach_m, reach_m, reach_m};
        const BoundingBox everywhere{center - reach, center + reach};
        const auto gap = [&](const BoundingBox& box) { return gap_m(everywhere, box); };
        const auto is_near = [&](std::size_t part) { return gap(solids.parts.bounds(part)) <= margin_m; };
        return !solids.parts.any(gap, margin_m, is_near) && !solids.is_inside_mesh(center);
    }

    std::shared_ptr<const Scene> scene;
    const SceneSolids& solids;
    PlaneOfMotion plane;
    RobotShape robot;
    CollisionCheckerKind kind;
    std::vector<Piece> pieces;
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
    pieces = pieces_of(robot);
    for (const Piece& piece : pieces) {
        const double offset =
            piece.is_arm ? std::sqrt(robot.joint_x_m * robot.joint_x_m + robot.joint_z_m * robot.joint_z_m) : 0;
        reach_m = std::max(reach_m, offset + reach_of(piece.convex));
        body_reach_m = piece.is_arm ? body_reach_m : std::max(body_reach_m, reach_of(piece.convex));
    }
}

CollisionChecker::CollisionChecker(std::shared_ptr<const Scene> scene, const PlaneOfMotion& plane,
                                   const RobotShape& robot, CollisionCheckerKind kind)
    : impl_(std::make_shared<const Impl>(std::move(scene), plane, robot, kind)) {}

CollisionCheckerKind CollisionChecker::kind() const noexcept {
    return impl_->kind;
}

bool CollisionChecker::is_nearer_than(const PlanarPose& pose, double margin_m) const {
    if (!is_finite(pose)) {
        return true;
    }
    if (impl_->kind == CollisionCheckerKind::fcl) {
        return impl_->fcl().is_nearer_than(pose, margin_m);
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
    if (!is_finite(pose)) {
        return -infinity;
    }
    if (impl_->kind == CollisionCheckerKind::fcl) {
        return impl_->fcl().clearance_m(pose);
    }
    double min_m = infinity;
    impl_->any_piece(pose, [&](const Convex& piece) {
        min_m = impl_->solids.clearance_m(piece, min_m);
        return false;
    });
    return min_m < contact_m ? std::min(min_m, 0.0) : min_m;
}

std::optional<std::size_t> CollisionChecker::nearest_obstacle(const PlanarPose& pose, double within_m) const {
    if (!is_finite(pose)) {
        return std::nullopt;
    }
    std::optional<NearObstacle> nearest;
    impl_->any_piece(pose, [&](const Convex& piece) {
        if (const auto nearer = impl_->solids.nearest(piece, nearest ? nearest->distance_m : within_m)) {
            nearest = nearer;
        }
        return nearest && nearest->distance_m <= 0;
    });
    return nearest ? std::optional(nearest->obstacle) : std::nullopt;
}

}  // namespace downwash
