#include "downwash/scene/space_frames.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "downwash/base/direction.hpp"
#include "downwash/base/lane_math.hpp"

namespace downwash {
namespace {

double distance_from_axis(const Vector3& p, const Vector3& axis) {
    return length_of(cross(axis, p));
}

/// The rotation by an angle about a vector of length 1 (Rodrigues).
Matrix3 rotation_about(const Vector3& axis, double angle_rad) {
    const auto [sine, cosine] = lane::sin_cos(angle_rad);
    const Vector3 s = sine * axis;
    const Vector3 c = (1 - cosine) * axis;
    return {{{cosine + c[0] * axis[0], c[0] * axis[1] - s[2], c[0] * axis[2] + s[1]},
             {c[1] * axis[0] + s[2], cosine + c[1] * axis[1], c[1] * axis[2] - s[0]},
             {c[2] * axis[0] - s[1], c[2] * axis[1] + s[0], cosine + c[2] * axis[2]}}};
}

/// First `b`, then `a`.
Matrix3 product(const Matrix3& a, const Matrix3& b) {
    Matrix3 both;
    for (std::size_t i = 0; i < 3; ++i) {
        both[i] = a[i][0] * b[0] + a[i][1] * b[1] + a[i][2] * b[2];
    }
    return both;
}

/// The greatest of a function of the corners of what a solid is without its disc and its ball, which is a sum of
/// segments. @param measure a convex function
template <class Measure>
double most_at_corners(const Convex& convex, const Measure& measure) {
    const auto segments = static_cast<unsigned>(convex.segment_count);
    double most = 0;
    for (unsigned signs = 0; signs < (1U << segments); ++signs) {
        Vector3 corner_m = convex.center_m;
        for (unsigned i = 0; i < segments; ++i) {
            corner_m = corner_m + ((signs >> i & 1U) != 0 ? -1.0 : 1.0) * convex.half_axes_m[i];
        }
        most = std::max(most, measure(corner_m));
    }
    return most;
}

}  // namespace

double reach_m(const Convex& convex) noexcept {
    return convex.ball_radius_m + most_at_corners(convex, [&](const Vector3& corner_m) {
               const double along = dot(convex.disc_normal, corner_m);
               const double across = distance_from_axis(corner_m, convex.disc_normal) + convex.disc_radius_m;
               return std::sqrt(along * along + across * across);
           });
}

double reach_about_m(const Convex& convex, const Vector3& axis) noexcept {
    const double around = most_at_corners(convex, [&](const Vector3& p_m) { return distance_from_axis(p_m, axis); });
    return std::min(convex.ball_radius_m + convex.disc_radius_m + around, reach_m(convex));
}

SpaceArm::SpaceArm(const SpaceRobotShape& robot) {
    std::transform(robot.links.begin(), robot.links.end(), std::back_inserter(joints_), [](const SpaceLinkShape& link) {
        return Joint{link.joint_m, unit(link.axis), link.lower_limit_rad, link.upper_limit_rad};
    });
}

RobotFrame SpaceArm::mounted(const RobotFrame& on, const Joint& joint, double angle_rad) noexcept {
    return {product(on.rotation, rotation_about(joint.axis, angle_rad)), on.placed(joint.at_m)};
}

SpaceFrames SpaceArm::frames_at(const SpacePose& pose) const noexcept {
    SpaceFrames frames;
    frames.count = links() + 1;
    frames.all[0] = {rotation_of(pose.attitude), pose.position_m};
    for (std::size_t i = 0; i < links(); ++i) {
        frames.all[i + 1] = mounted(frames.all[i], joints_[i], pose.joints_rad[i]);
    }
    return frames;
}

SpaceFrames SpaceArm::frames_seen_from(std::size_t from, std::size_t to,
                                       const std::array<double, max_links>& joints_rad) const noexcept {
    SpaceFrames frames;
    frames.count = to + 1;
    frames.all[from] = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {0, 0, 0}};
    for (std::size_t i = from; i < to; ++i) {
        frames.all[i + 1] = mounted(frames.all[i], joints_[i], joints_rad[i]);
    }
    return frames;
}

bool SpaceArm::is_within_limits(const std::array<double, max_links>& joints_rad) const noexcept {
    for (std::size_t i = 0; i < links(); ++i) {
        if (!(joints_rad[i] >= joints_[i].lower_rad - joint_swing_rad &&
              joints_rad[i] <= joints_[i].upper_rad + joint_swing_rad)) {
            return false;
        }
    }
    return true;
}

SpaceReach SpaceArm::reach_of(const std::vector<RobotPiece>& pieces) const noexcept {
    SpaceReach reach;
    reach.links = links();
    for (const RobotPiece& piece : pieces) {
        SpaceReach::Body& body = reach.bodies[piece.frame];
        body.can_touch = true;
        // From the body's own joint outward to the multirotor: what is on the way adds the distance between joints.
        double from_joint_m = reach_m(piece.convex);
        for (std::size_t joint = piece.frame; joint-- > 0;) {
            const bool is_own = joint + 1 == piece.frame;
            const double about_m =
                is_own ? reach_about_m(piece.convex, joints_[joint].axis)
                       : distance_from_axis(joints_[joint + 1].at_m, joints_[joint].axis) + from_joint_m;
            body.joint_m[joint] = std::max(body.joint_m[joint], about_m);
            from_joint_m += is_own ? 0 : length_of(joints_[joint + 1].at_m);
        }
        body.center_m = std::max(body.center_m, from_joint_m + (piece.frame > 0 ? length_of(joints_[0].at_m) : 0));
    }
    return reach;
}

}  // namespace downwash
