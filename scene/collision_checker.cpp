#include "downwash/scene/collision_checker.hpp"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/fault.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/scene/convex.hpp"
#include "downwash/scene/solids.hpp"

// Everything here happens in the frame of the plane of motion (x along the heading, y to the left, z up), so that the
// robot's bounding boxes are tight at any heading.
//
// FCL decides contact. Its distances (version 0.7, solids of 0.05 to 1 m) were off by up to 5 mm between boxes,
// cylinders and capsules with its default solver, and by 13 mm with the other, so distances come from convex.hpp.

namespace downwash {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Solids farther apart than this are not shown to FCL: they do not touch, whatever its tolerances.
constexpr double contact_band_m = 1e-6;

Eigen::Vector3d eigen(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

/// A solid as FCL knows it, with the pose of FCL's own frame of it.
struct FclSolid {
    std::shared_ptr<const fcl::CollisionGeometryd> geometry;
    fcl::Transform3d pose;
};

std::shared_ptr<const fcl::CollisionGeometryd> fcl_geometry_of(const Convex& convex) {
    const auto length = [&](std::size_t i) { return 2 * eigen(convex.half_axes_m[i]).norm(); };
    if (convex.segment_count == 3) {
        return std::make_shared<fcl::Boxd>(length(0), length(1), length(2));
    }
    if (convex.segment_count == 0) {
        return std::make_shared<fcl::Sphered>(convex.ball_radius_m);
    }
    if (convex.disc_radius_m > 0) {
        return std::make_shared<fcl::Cylinderd>(convex.disc_radius_m, length(0));
    }
    return std::make_shared<fcl::Capsuled>(convex.ball_radius_m, length(0));
}

/// FCL's boxes have their edges along x, y, z, its cylinders and capsules their axis along z.
Eigen::Matrix3d fcl_rotation_of(const Convex& convex) {
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    if (convex.segment_count == 3) {
        for (std::size_t i = 0; i < 3; ++i) {
            rotation.col(static_cast<Eigen::Index>(i)) = eigen(convex.half_axes_m[i]).normalized();
        }
    } else if (convex.segment_count == 1) {
        const Eigen::Vector3d axis = eigen(convex.half_axes_m[0]);
        rotation = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
    }
    return rotation;
}

FclSolid fcl_solid_of(const Convex& convex) {
    FclSolid solid{fcl_geometry_of(convex), fcl::Transform3d::Identity()};
    solid.pose.linear() = fcl_rotation_of(convex);
    solid.pose.translation() = eigen(convex.center_m);
    return solid;
}

bool is_finite(const PlanarPose& pose) {
    return std::isfinite(pose.x_m + pose.z_m + pose.pitch_rad + pose.arm_rad);
}

/// A frame of the robot in the plane of motion: turned by an angle about the lateral axis, then moved within the plane.
struct Frame {
    double x_m, z_m, cosine, sine;

    Vector3 turned(const Vector3& v) const { return {cosine * v[0] + sine * v[2], v[1], cosine * v[2] - sine * v[0]}; }
    Vector3 placed(const Vector3& p_m) const {
        const Vector3 p = turned(p_m);
        return {x_m + p[0], p[1], z_m + p[2]};
    }
    Convex placed(const Convex& own) const {
        Convex convex = own;
        convex.center_m = placed(own.center_m);
        for (std::size_t i = 0; i < static_cast<std::size_t>(own.segment_count); ++i) {
            convex.half_axes_m[i] = turned(own.half_axes_m[i]);
        }
        convex.disc_normal = turned(own.disc_normal);
        return convex;
    }
    fcl::Transform3d placed(const fcl::Transform3d& own) const {
        fcl::Transform3d frame = fcl::Transform3d::Identity();
        frame.linear() << cosine, 0, sine, 0, 1, 0, -sine, 0, cosine;
        frame.translation() << x_m, 0, z_m;
        return frame * own;
    }
};

Frame frame_at(double x_m, double z_m, double angle_rad) {
    Frame frame{x_m, z_m, 0, 0};
    lane::sin_cos(angle_rad, frame.sine, frame.cosine);
    return frame;
}

/// A piece of the robot in its own frame: that of the multirotor, or that of the arm (from the joint, x along the arm).
struct Part {
    Convex convex;
    FclSolid fcl;
    bool is_arm = false;
};

/// An obstacle in the frame of the plane of motion.
struct Placed {
    Convex convex;
    FclSolid fcl;
};

void require_valid(const RobotShape& robot) {
    std::vector<Fault> faults;
    for (std::size_t i = 0; i < robot.bodies.size(); ++i) {
        inspect(robot.bodies[i].shape, "bodies[" + std::to_string(i) + "]", faults);
    }
    const auto inspect_length = [&](double length_m, const char* key) {
        if (!(std::isfinite(length_m) && length_m > 0)) {
            faults.push_back({key, "must be a finite length above 0 in metres"});
        }
    };
    inspect_length(robot.arm_length_m, "arm_length_m");
    inspect_length(robot.arm_radius_m, "arm_radius_m");
    if (!faults.empty()) {
        throw InputError(std::move(faults));
    }
}

std::vector<Part> parts_of(const RobotShape& robot) {
    std::vector<Part> parts;
    for (const BodyShape& body : robot.bodies) {
        const Matrix3 identity{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        const Convex convex = convex_of(body.shape, body.center_m, placement_of(body.shape, identity));
        parts.push_back({convex, fcl_solid_of(convex)});
    }
    const Vector3 half_arm{0.5 * robot.arm_length_m, 0, 0};
    const Convex arm{
        .center_m = half_arm, .segment_count = 1, .half_axes_m = {half_arm}, .ball_radius_m = robot.arm_radius_m};
    parts.push_back({arm, fcl_solid_of(arm), true});
    return parts;
}

Convex in_plane(const Scene::Solids& solids, std::size_t i, const PlaneOfMotion& plane) {
    const Matrix3& world_rotation = solids.placements[i].rotation;
    const Primitive& primitive = solids.primitives[i];
    const double c = plane.cos_heading();
    const double s = plane.sin_heading();
    Matrix3 rotation = world_rotation;
    for (std::size_t k = 0; k < 3; ++k) {
        rotation[0][k] = c * world_rotation[0][k] + s * world_rotation[1][k];
        rotation[1][k] = c * world_rotation[1][k] - s * world_rotation[0][k];
    }
    return convex_of(primitive, plane.from_world(solids.obstacles[i].center_m), placement_of(primitive, rotation));
}

/// Upper bound of the distance from the frame's origin to any point of the solid.
double reach_of(const Convex& convex) {
    const Scene::Bounds bounds = bounds_of(convex);
    double squared = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double farthest = std::max(std::abs(bounds.low_m[k]), std::abs(bounds.high_m[k]));
        squared += farthest * farthest;
    }
    return std::sqrt(squared);
}

bool fcl_says_contact(const Part& part, const Frame& frame, const Placed& obstacle) {
    const fcl::CollisionRequestd request(1, false);
    fcl::CollisionResultd result;
    fcl::collide(part.fcl.geometry.get(), frame.placed(part.fcl.pose), obstacle.fcl.geometry.get(), obstacle.fcl.pose,
                 request, result);
    return result.isCollision();
}

bool is_nearer(const Part& part, const Frame& frame, const Convex& placed, const Placed& obstacle, double margin_m) {
    if (margin_m > contact_band_m) {
        return is_nearer_than(placed, obstacle.convex, margin_m);
    }
    return is_nearer_than(placed, obstacle.convex, contact_band_m) &&
           (fcl_says_contact(part, frame, obstacle) || is_nearer_than(placed, obstacle.convex, margin_m));
}

}  // namespace

struct CollisionChecker::Impl {
    Impl(std::shared_ptr<const Scene> scene, const PlaneOfMotion& plane, const RobotShape& robot);

    /// Calls `visit(part, frame, placed part, its bounds)` until it returns true; whether it did.
    template <class Visit>
    bool any_part(const PlanarPose& pose, const Visit& visit) const {
        const Frame body = frame_at(pose.x_m, pose.z_m, pose.pitch_rad);
        const Vector3 joint = body.placed(joint_m);
        const Frame arm = frame_at(joint[0], joint[2], pose.pitch_rad + pose.arm_rad);
        return std::any_of(parts.begin(), parts.end(), [&](const Part& part) {
            const Frame& frame = part.is_arm ? arm : body;
            const Convex placed = frame.placed(part.convex);
            return visit(part, frame, placed, bounds_of(placed));
        });
    }

    /// Whether the box that holds the robot at any attitude keeps `margin_m` from every obstacle.
    bool is_far_away(const PlanarPose& pose, double margin_m) const {
        const Scene::Bounds everywhere{{pose.x_m - reach_m, -reach_m, pose.z_m - reach_m},
                                       {pose.x_m + reach_m, reach_m, pose.z_m + reach_m}};
        return std::all_of(bounds.begin(), bounds.end(),
                           [&](const Scene::Bounds& obstacle) { return gap_m(everywhere, obstacle) > margin_m; });
    }

    std::vector<Part> parts;
    Vector3 joint_m;  ///< in the body frame
    double reach_m = 0;
    std::vector<Placed> obstacles;
    std::vector<Scene::Bounds> bounds;  ///< of the obstacles, apart from them to be near one another in memory
};

CollisionChecker::Impl::Impl(std::shared_ptr<const Scene> scene, const PlaneOfMotion& plane, const RobotShape& robot)
    : joint_m{robot.joint_x_m, 0, robot.joint_z_m} {
    require_valid(robot);
    parts = parts_of(robot);
    for (const Part& part : parts) {
        const double offset =
            part.is_arm ? std::sqrt(robot.joint_x_m * robot.joint_x_m + robot.joint_z_m * robot.joint_z_m) : 0;
        reach_m = std::max(reach_m, offset + reach_of(part.convex));
    }
    const Scene::Solids& solids = scene->solids();
    for (std::size_t i = 0; i < solids.obstacles.size(); ++i) {
        const Convex convex = in_plane(solids, i, plane);
        obstacles.push_back({convex, fcl_solid_of(convex)});
        bounds.push_back(bounds_of(convex));
    }
    // FCL fills its static tables in the first query; later threads only read them.
    fcl_says_contact(parts.back(), Frame{0, 0, 1, 0}, {parts.back().convex, parts.back().fcl});
}

CollisionChecker::CollisionChecker(std::shared_ptr<const Scene> scene, const PlaneOfMotion& plane,
                                   const RobotShape& robot)
    : impl_(std::make_unique<const Impl>(std::move(scene), plane, robot)) {}
CollisionChecker::~CollisionChecker() = default;
CollisionChecker::CollisionChecker(CollisionChecker&&) noexcept = default;
CollisionChecker& CollisionChecker::operator=(CollisionChecker&&) noexcept = default;

bool CollisionChecker::is_nearer_than(const PlanarPose& pose, double margin_m) const {
    if (!is_finite(pose)) {
        return true;
    }
    const double near_m = std::max(margin_m, contact_band_m);
    if (impl_->is_far_away(pose, near_m)) {
        return false;
    }
    return impl_->any_part(pose, [&](const Part& part, const Frame& frame, const Convex& placed, const auto& bounds) {
        for (std::size_t i = 0; i < impl_->obstacles.size(); ++i) {
            if (gap_m(bounds, impl_->bounds[i]) <= near_m &&
                is_nearer(part, frame, placed, impl_->obstacles[i], margin_m)) {
                return true;
            }
        }
        return false;
    });
}

double CollisionChecker::clearance_m(const PlanarPose& pose) const {
    if (!is_finite(pose)) {
        return -infinity;
    }
    double least = infinity;
    impl_->any_part(pose, [&](const Part& part, const Frame& frame, const Convex& placed, const auto& bounds) {
        for (std::size_t i = 0; i < impl_->obstacles.size(); ++i) {
            if (gap_m(bounds, impl_->bounds[i]) >= least) {
                continue;
            }
            const Placed& obstacle = impl_->obstacles[i];
            double distance = distance_m(placed, obstacle.convex, least);
            if (distance > 0 && distance < contact_band_m && fcl_says_contact(part, frame, obstacle)) {
                distance = 0;
            }
            least = std::min(least, distance);
        }
        return false;
    });
    return least;
}

}  // namespace downwash
