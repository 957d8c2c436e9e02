#include "downwash/simulation/space_touch_place.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/base/direction.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/base/text.hpp"
#include "downwash/dynamics/ceiling_contact.hpp"
#include "downwash/scene/collision_checker.hpp"
#include "downwash/simulation/space_tool.hpp"

namespace downwash {
namespace {

constexpr double nothing_m = std::numeric_limits<double>::infinity();
/// Distances around a point, from a flat surface, may differ so much [m].
constexpr double flatness_m = 1e-3;

double distance_m(const Scene& obstacle, const Vector3& at_m) {
    constexpr double dot_m = 1e-7;
    return disc_clearance_m(obstacle, at_m, dot_m);
}

/// How far a solid reaches along a direction, both in the axes of its body [m].
struct ReachAlong {
    Vector3 d;  ///< of length 1

    double operator()(const Box& box) const {
        return 0.5 * (std::abs(d[0]) * box.size_m[0] + std::abs(d[1]) * box.size_m[1] + std::abs(d[2]) * box.size_m[2]);
    }
    double operator()(const Sphere& sphere) const { return sphere.radius_m; }
    double operator()(const Cylinder& can) const {
        const double along = dot(d, can.axis) / length_of(can.axis);
        return 0.5 * can.length_m * std::abs(along) + can.radius_m * lane::sqrt(std::max(0.0, 1 - along * along));
    }
    double operator()(const Capsule& capsule) const {
        return std::max(dot(d, capsule.from_m), dot(d, capsule.to_m)) + capsule.radius_m;
    }
};

/// Points that are highest of a solid, from the centre of its frame; none of a cylinder that does not stand upright,
/// whose highest points depend on the smallest tilt.
struct Top {
    std::vector<Vector3> operator()(const Box& box) const {
        const Vector3 half = 0.5 * box.size_m;
        return {{half[0], half[1], half[2]},
                {-half[0], half[1], half[2]},
                {-half[0], -half[1], half[2]},
                {half[0], -half[1], half[2]}};
    }
    std::vector<Vector3> operator()(const Sphere& sphere) const { return {{0, 0, sphere.radius_m}}; }
    std::vector<Vector3> operator()(const Cylinder& can) const {
        if (can.axis[0] != 0 || can.axis[1] != 0) {
            return {};
        }
        const double r = can.radius_m, h = 0.5 * can.length_m;
        return {{r, 0, h}, {0, r, h}, {-r, 0, h}, {0, -r, h}};
    }
    std::vector<Vector3> operator()(const Capsule& capsule) const {
        std::vector<Vector3> points;
        const double high_m = std::max(capsule.from_m[2], capsule.to_m[2]);
        for (const Vector3& end : {capsule.from_m, capsule.to_m}) {
            if (end[2] == high_m) {
                points.push_back({end[0], end[1], end[2] + capsule.radius_m});
            }
        }
        return points;
    }
};

/// What of the multirotor's bodies is highest; none where that is a cylinder which lies.
std::vector<Vector3> highest_points(const SpaceRobot& robot) {
    constexpr double level_m = 1e-9;
    const Vector3 up{0, 0, 1};
    double top_m = -nothing_m;
    for (const SpaceBodyShape& body : robot.body) {
        top_m = std::max(top_m, body.center_m[2] + std::visit(ReachAlong{up}, body.shape));
    }
    std::vector<Vector3> points;
    for (const SpaceBodyShape& body : robot.body) {
        if (body.center_m[2] + std::visit(ReachAlong{up}, body.shape) < top_m - level_m) {
            continue;
        }
        const std::vector<Vector3> own = std::visit(Top{}, body.shape);
        if (own.empty()) {
            return {};
        }
        for (const Vector3& point : own) {
            points.push_back(body.center_m + point);
        }
    }
    return points;
}

/// How far the solids around the end effector reach beyond it along a direction [m], >= 0.
double beyond_tip_m(const SpaceRobot& robot, const SpacePose& pose, const Vector3& direction) {
    const int link = robot.joints() - 1;
    const Matrix3 axes = rotation_of(link_at(robot, pose, link).attitude);
    Vector3 own{};  // the direction in the axes of the link
    for (std::size_t i = 0; i < 3; ++i) {
        own[i] = axes[0][i] * direction[0] + axes[1][i] * direction[1] + axes[2][i] * direction[2];
    }
    double beyond_m = 0;
    for (const SpaceBodyShape& body : link < 0 ? robot.body : robot.links[static_cast<std::size_t>(link)].body) {
        beyond_m = std::max(
            beyond_m, dot(own, body.center_m - robot.plant.end_effector_m) + std::visit(ReachAlong{own}, body.shape));
    }
    return beyond_m;
}

/// The slope of the distance at a point: the normal of the surface in front of it where that is flat.
Vector3 slope_at(const Scene& obstacle, const Vector3& at_m, double step_m) {
    Vector3 slope{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Vector3 ahead = at_m, behind = at_m;
        ahead[axis] += step_m;
        behind[axis] -= step_m;
        slope[axis] = (distance_m(obstacle, ahead) - distance_m(obstacle, behind)) / (2 * step_m);
    }
    return slope;
}

/// Whether the surface is flat around a point's foot: points a little in front of it are as far away everywhere.
/// @param points that touch, from their middle, in the world
bool is_flat(const Scene& obstacle, const Vector3& at_m, const Vector3& normal, double away_m, double around_m,
             const std::vector<Vector3>& points) {
    const Vector3 u = across(normal), v = cross(normal, u);
    constexpr double nearest_m = 0.01;
    const double near_m = std::min(away_m, nearest_m);
    const Vector3 foot_m = at_m - (away_m - near_m) * normal;
    constexpr int ways = 8;
    for (int i = 0; i < ways; ++i) {
        const auto [sine, cosine] = lane::sin_cos(i * (6.283185307179586 / ways));
        const Vector3 way = cosine * u + sine * v;
        double reach_m = 0;
        for (const Vector3& point : points) {
            reach_m = std::max(reach_m, dot(point, way));
        }
        for (const double share : {0.5, 1.0}) {
            const double there_m = distance_m(obstacle, foot_m + share * (reach_m + around_m) * way);
            if (!(std::abs(there_m - near_m) <= flatness_m)) {
                return false;
            }
        }
    }
    return true;
}

FoundTouch no_touch(const std::string& why, double away_m) {
    return {{}, "has no place to touch: " + why, away_m};
}

}  // namespace

Vector3 middle_of(const SpaceTouch& touch, const SpaceRobot& robot, const SpacePose& pose) {
    Vector3 sum_m{};
    for (const SpaceTouchPoint& point : touch.points) {
        sum_m = sum_m + link_at(robot, pose, point.link).placed(point.at_m);
    }
    return (1 / static_cast<double>(touch.points.size())) * sum_m;
}

FoundTouch find_touch(const SpaceContactGoal& goal, double hold_s, const SpaceRobot& robot, const SpacePose& waiting,
                      const Scene& obstacle) {
    SpaceTouch touch;
    touch.force_n = goal.force_n;
    touch.force_tolerance_n = goal.tolerance_n();
    touch.standoff_m = goal.standoff_m;
    touch.speed_m_s = goal.speed_m_s;
    touch.hold_s = hold_s;
    touch.tolerance_m = goal.tolerance_m;
    touch.wanted_m = goal.position_m;
    touch.part = goal.part;
    const bool is_frame = goal.part == TouchingPart::frame;
    if (is_frame) {
        for (const Vector3& point : highest_points(robot)) {
            touch.points.push_back({-1, point});
        }
        if (touch.points.empty() || touch.points.size() > dynamics::max_contact_points) {
            return no_touch(
                "the top of the multirotor is no box, sphere, capsule or upright cylinder, or has more than " +
                    std::to_string(dynamics::max_contact_points) + " corners",
                nothing_m);
        }
    } else {
        touch.points.push_back({robot.joints() - 1, robot.plant.end_effector_m});
    }
    const Vector3 middle_m = middle_of(touch, robot, waiting);
    const double away_m = distance_m(obstacle, middle_m);
    const Vector3 way = is_frame ? rotation_of(waiting.attitude) * Vector3{0, 0, 1} : tool_at(robot, waiting).direction;
    const double gap_m = goal.position_m ? length_of(*goal.position_m - middle_m) : away_m;
    const double ahead_m = goal.standoff_m + (is_frame ? 0 : beyond_tip_m(robot, waiting, way));
    const auto none = [far_m = std::max(0.0, gap_m - ahead_m)](const std::string& why) { return no_touch(why, far_m); };
    if (!(away_m > 0 && away_m < nothing_m)) {
        return none("what should touch is inside the obstacle");
    }
    constexpr double longest_step_m = 0.01;
    touch.normal = slope_at(obstacle, middle_m, std::min(longest_step_m, 0.5 * away_m));
    const double steepness = length_of(touch.normal);
    constexpr double rounding = 1e-3;
    if (!(std::abs(steepness - 1) <= rounding)) {
        return none("its surface is not flat where the robot waits");
    }
    touch.normal = (1 / steepness) * touch.normal;
    const double angle_rad = angle_between_rad(way, -1 * touch.normal);
    if (!(angle_rad <= touch_angle_rad)) {
        return none(std::string(is_frame ? "the top of the multirotor" : "the end effector") + " points " +
                    to_text(angle_rad * degrees_per_radian, 3) +
                    " degrees off the way to the nearest point of the obstacle: expected at most " +
                    to_text(touch_angle_rad * degrees_per_radian, 3));
    }
    std::vector<Vector3> points;
    for (const SpaceTouchPoint& point : touch.points) {
        points.push_back(link_at(robot, waiting, point.link).placed(point.at_m) - middle_m);
    }
    if (!is_flat(obstacle, middle_m, touch.normal, away_m, goal.tolerance_m, points)) {
        return none("its surface is not flat for the width of what touches and tolerance_m");
    }
    const double beyond_m = is_frame ? 0 : beyond_tip_m(robot, waiting, -1 * touch.normal);
    touch.surface_m = middle_m + (beyond_m - away_m) * touch.normal;
    touch.waiting_m = touch.surface_m + touch.standoff_m * touch.normal;
    if (touch.wanted_m) {
        const Vector3 true_surface_m = touch.surface_m - beyond_m * touch.normal;
        const double above_m = dot(*touch.wanted_m - true_surface_m, touch.normal);
        if (std::abs(above_m) > goal.tolerance_m) {
            return none("position_m is " + to_text(std::abs(above_m), 3) +
                        " m off the surface that is nearest to the waiting robot");
        }
        touch.wanted_m = *touch.wanted_m + (beyond_m - above_m) * touch.normal;
        touch.waiting_m = *touch.wanted_m + touch.standoff_m * touch.normal;
    }
    return {touch, "", 0};
}

}  // namespace downwash
