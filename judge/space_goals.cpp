#include "downwash/judge/space_goals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>

#include "downwash/judge/placement.hpp"
#include "downwash/judge/space_surroundings.hpp"
#include "downwash/judge/space_touching.hpp"

namespace downwash::judge {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double infinity = std::numeric_limits<double>::infinity();
// docs/model.md 7.8 and 7.9.
constexpr double sight_radius_m = 0.001;
constexpr double sight_end_m = 0.02;
constexpr double touch_angle_rad = 5 * std::numbers::pi / 180;
constexpr double touch_hover_s = 2;
constexpr double flatness_m = 1e-3;
constexpr std::size_t max_points = 32;

/// Between two directions, by their half difference and half sum (Kahan).
double angle_between(const Vector3d& a, const Vector3d& b) {
    const Vector3d u = a.normalized();
    const Vector3d v = b.normalized();
    return 2 * std::atan2((u - v).norm(), (u + v).norm());
}

/// Modulo a turn.
double turn_between(double a_rad, double b_rad) {
    return std::abs(std::remainder(a_rad - b_rad, 2 * std::numbers::pi));
}

std::vector<SpaceGoal> choices_of(const SpaceGoal& goal) {
    return goal.any_of.empty() ? std::vector<SpaceGoal>{goal} : goal.any_of;
}

/// The corners of what is highest of the multirotor's bodies.
struct HighPoints {
    Vector3d center_m;
    double& top_m;
    std::vector<Vector3d>& points;
    bool& is_round;  ///< among them is a cylinder that lies: where it touches depends on the smallest tilt

    void add(const std::vector<Vector3d>& own, bool is_round_itself = false) const {
        for (const Vector3d& point : own) {
            const double height_m = center_m.z() + point.z();
            if (height_m > top_m + 1e-9) {
                points.clear();
                top_m = height_m;
                is_round = false;
            }
            if (height_m >= top_m - 1e-9) {
                points.emplace_back(center_m + point);
                is_round = is_round || is_round_itself;
            }
        }
    }
    void operator()(const Box& box) const {
        const Vector3d half = 0.5 * vector_of(box.size_m);
        std::vector<Vector3d> corners;
        for (const double x : {-1.0, 1.0}) {
            for (const double y : {-1.0, 1.0}) {
                corners.emplace_back(x * half.x(), y * half.y(), half.z());
            }
        }
        add(corners);
    }
    void operator()(const Sphere& sphere) const { add({{0, 0, sphere.radius_m}}); }
    void operator()(const Cylinder& can) const {
        const Vector3d axis = vector_of(can.axis).normalized();
        if (axis.head<2>() != Eigen::Vector2d::Zero()) {
            add({{0, 0, 0.5 * can.length_m * std::abs(axis.z()) + can.radius_m * axis.head<2>().norm()}}, true);
            return;
        }
        const double z = 0.5 * can.length_m;
        add({{can.radius_m, 0, z}, {-can.radius_m, 0, z}, {0, can.radius_m, z}, {0, -can.radius_m, z}});
    }
    void operator()(const Capsule& capsule) const {
        const Vector3d up = capsule.radius_m * Vector3d::UnitZ();
        add({vector_of(capsule.from_m) + up, vector_of(capsule.to_m) + up});
    }
};

Vector3 plain(const Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

}  // namespace

/// Where a robot is, as goals see it.
struct SpaceGoals::At {
    SpaceCoordinates coordinates;
    BodyMotions bodies;
    Vector3d tip_m, direction;
    Quaterniond attitude;  ///< of the last body
    SpaceWorld world;
};

/// A goal as a reference point meets it.
struct SpaceGoals::Candidate {
    SpaceGoalDistance off;
    double hold_s = 0;
    std::optional<SpaceTouch> touch;
};

struct SpaceGoals::Kinds {
    const SpaceGoals& all;
    const At& at;

    SpaceGoalDistance operator()(const SpaceConfigurationGoal& goal) const {
        double square = 0;
        double angle_rad = 0;
        const auto place = [&](const std::optional<double>& wanted, double is) {
            square += wanted ? (is - *wanted) * (is - *wanted) : 0;
        };
        place(goal.x_m, at.coordinates.position_m.x());
        place(goal.y_m, at.coordinates.position_m.y());
        place(goal.z_m, at.coordinates.position_m.z());
        if (goal.yaw_rad) {
            const Vector3d ahead = at.bodies.front().attitude * Vector3d::UnitX();
            angle_rad = turn_between(std::atan2(ahead.y(), ahead.x()), *goal.yaw_rad);
        }
        for (std::size_t i = 0; i < goal.joints_rad.size(); ++i) {
            angle_rad = std::max(
                angle_rad, turn_between(at.coordinates.joints_rad[static_cast<Eigen::Index>(i)], goal.joints_rad[i]));
        }
        const double distance_m = std::sqrt(square);
        return {distance_m, std::max(distance_m / goal.tolerance_m, angle_rad / goal.tolerance_rad)};
    }
    SpaceGoalDistance operator()(const SpaceEndEffectorGoal& goal) const {
        const double distance_m = (at.tip_m - vector_of(goal.position_m)).norm();
        const double angle_rad = goal.direction ? angle_between(at.direction, vector_of(*goal.direction)) : 0;
        return {distance_m, std::max(distance_m / goal.tolerance_m, angle_rad / goal.direction_tolerance_rad)};
    }
    SpaceGoalDistance operator()(const SpacePoseGoal& goal) const {
        using Turn = Eigen::AngleAxisd;
        const double distance_m = (at.tip_m - vector_of(goal.position_m)).norm();
        const Quaterniond wanted = Turn(goal.rpy_rad[2], Vector3d::UnitZ()) * Turn(goal.rpy_rad[1], Vector3d::UnitY()) *
                                   Turn(goal.rpy_rad[0], Vector3d::UnitX());
        return {distance_m,
                std::max(distance_m / goal.tolerance_m, wanted.angularDistance(at.attitude) / goal.tolerance_rad)};
    }
    /// What a camera looks at goes with the scene.
    SpaceGoalDistance operator()(const SpaceCameraGoal& goal) const {
        const Vector3d camera_m = nominal_place(at.world, at.tip_m);
        const Vector3d looks =
            Eigen::AngleAxisd(-at.world.scene_yaw_rad, Vector3d::UnitZ()).toRotationMatrix() * at.direction;
        const Vector3d line = vector_of(goal.target_m) - camera_m;
        const double length_m = line.norm();
        const double range = (goal.farthest_m - goal.nearest_m) / 2;
        double share = std::max(length_m - goal.nearest_m - range, goal.farthest_m - range - length_m) / range;
        share = std::max(share, angle_between(looks, line) / goal.aim_tolerance_rad);
        if (goal.direction) {
            share = std::max(share, angle_between(vector_of(*goal.direction), line) / goal.view_cone_rad);
        }
        const double seen_m = length_m - sight_end_m;
        if (goal.sees && seen_m > 0 &&
            !all.obstacles_.line_keeps(sight_radius_m, camera_m, camera_m + seen_m * line.normalized())) {
            share = infinity;
        }
        return {std::max({0.0, goal.nearest_m - length_m, length_m - goal.farthest_m}), share};
    }
    /// A contact is met in front of its surface, which stay says.
    SpaceGoalDistance operator()(const SpaceContactGoal& /*goal*/) const { return {0, infinity}; }
};

SpaceGoals::SpaceGoals(const SpaceRobot& robot, const std::vector<Obstacle>& all, const SpaceObstacles& obstacles,
                       const std::vector<SpaceGoal>& goals, bool in_any_order)
    : robot_(robot),
      obstacles_(obstacles),
      nominal_(vehicle_in(SpaceWorld{}, robot)),
      goals_(goals),
      in_any_order_(in_any_order) {
    for (const SpaceGoal& goal : goals) {
        auto& named = named_.emplace_back();
        for (const SpaceGoal& each : choices_of(goal)) {
            const auto* contact = std::get_if<SpaceContactGoal>(&each.kind);
            named.push_back(contact != nullptr ? std::make_unique<NamedObstacle>(all, contact->obstacle) : nullptr);
        }
    }
}

SpaceGoals::~SpaceGoals() = default;

SpaceGoals::At SpaceGoals::at(const SpaceJudgedMotion& motion, const SpaceWorld& world) const {
    const auto& q = motion.attitude;
    At here;
    here.coordinates = {vector_of(motion.position_m),
                        Quaterniond(q[0], q[1], q[2], q[3]).normalized(),
                        vector_of(motion.velocity_m_s),
                        vector_of(motion.body_rates_rad_s),
                        Eigen::Map<const Eigen::VectorXd>(motion.joints_rad.data(), nominal_.joint_count()),
                        Eigen::Map<const Eigen::VectorXd>(motion.joint_rates_rad_s.data(), nominal_.joint_count())};
    here.bodies = bodies_at(nominal_, here.coordinates);
    here.attitude = here.bodies.back().attitude;
    here.tip_m = here.bodies.back().position_m + here.attitude * nominal_.end_effector_m;
    here.direction = here.attitude * vector_of(robot_.tool_direction).normalized();
    here.world = world;
    return here;
}

SpaceGoalDistance SpaceGoals::single(const SpaceGoal& goal, const At& at) const {
    return std::visit(Kinds{*this, at}, goal.kind);
}

SpaceGoalDistance SpaceGoals::from_touch(const SpaceTouch& touch, const At& at) const {
    const Vector3d middle_m = SpaceTouchSurface(touch, SpaceWorld{}).middle_m(nominal_, at.bodies);
    const double distance_m = (middle_m - vector_of(touch.waiting_m)).norm();
    const double angle_rad =
        touch.part == TouchingPart::end_effector ? angle_between(at.direction, -vector_of(touch.normal)) : 0;
    return {distance_m, std::max(distance_m / touch.tolerance_m, angle_rad / touch_angle_rad)};
}

std::optional<SpaceTouch> SpaceGoals::touch_from(const SpaceContactGoal& goal, double hold_s, const At& at,
                                                 const NamedObstacle& obstacle) const {
    SpaceTouch touch;
    touch.force_n = goal.force_n;
    touch.force_tolerance_n = goal.force_tolerance_n.value_or(goal.force_n / 5);
    touch.standoff_m = goal.standoff_m;
    touch.speed_m_s = goal.speed_m_s;
    touch.hold_s = hold_s;
    touch.part = goal.part;
    touch.tolerance_m = goal.tolerance_m;
    const bool is_frame = goal.part == TouchingPart::frame;
    if (is_frame) {
        double top_m = -infinity;
        std::vector<Vector3d> points;
        bool is_round = false;
        for (const SpaceBodyShape& body : robot_.body) {
            std::visit(HighPoints{vector_of(body.center_m), top_m, points, is_round}, body.shape);
        }
        if (is_round || points.size() > max_points) {
            return std::nullopt;
        }
        for (const Vector3d& point : points) {
            touch.points.push_back({-1, plain(point)});
        }
    } else {
        touch.points.push_back({nominal_.joint_count() - 1, robot_.plant.end_effector_m});
    }
    if (touch.points.empty()) {
        return std::nullopt;
    }
    const Vector3d middle_m = SpaceTouchSurface(touch, SpaceWorld{}).middle_m(nominal_, at.bodies);
    const double away_m = obstacle.distance_m(middle_m);
    if (!(away_m > 0 && away_m < infinity)) {
        return std::nullopt;
    }
    // The slope of the distance from the corners of a tetrahedron: the sum of their outer products is 4/3.
    const Vector3d corners[] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    const double step_m = std::min(0.01, 0.5 * away_m);
    Vector3d slope = Vector3d::Zero();
    for (const Vector3d& corner : corners) {
        slope += 0.75 / step_m * obstacle.distance_m(middle_m + step_m * corner.normalized()) * corner.normalized();
    }
    if (!(std::abs(slope.norm() - 1) <= 2e-3)) {
        return std::nullopt;
    }
    const Vector3d normal = slope.normalized();
    const Vector3d points_at = is_frame ? Vector3d(at.bodies.front().attitude * Vector3d::UnitZ()) : at.direction;
    if (!(angle_between(points_at, -normal) <= touch_angle_rad)) {
        return std::nullopt;
    }
    // Flat all around, as far as a corner of what touches reaches along each way and the tolerance farther.
    constexpr int ways = 24;
    const double near_m = std::min(0.01, away_m);
    const Vector3d foot_m = middle_m - away_m * normal;  // on the true surface
    for (int i = 0; i < ways; ++i) {
        const Eigen::AngleAxisd turn(2 * std::numbers::pi * i / ways, normal);
        const Vector3d way = turn * normal.unitOrthogonal();
        double reach_m = 0;
        for (const SpaceTouchPoint& point : touch.points) {
            const BodyMotion& body = at.bodies[static_cast<std::size_t>(point.link + 1)];
            reach_m =
                std::max(reach_m, way.dot(body.position_m + body.attitude * lever_of(nominal_, point) - middle_m));
        }
        for (const double share : {0.25, 0.5, 0.75, 1.0}) {
            const Vector3d there_m = foot_m + near_m * normal + share * (reach_m + goal.tolerance_m) * way;
            if (!(std::abs(obstacle.distance_m(there_m) - near_m) <= flatness_m)) {
                return std::nullopt;
            }
        }
    }
    const std::vector<BodyFrame> frames = frames_of(nominal_, at.bodies, SpaceWorld{});
    const double beyond_m = is_frame ? 0 : obstacles_.reach_beyond_m(frames, frames.size() - 1, at.tip_m, -normal);
    Vector3d touched_m = foot_m;
    if (goal.position_m) {
        const double above_m = normal.dot(vector_of(*goal.position_m) - foot_m);
        if (std::abs(above_m) > goal.tolerance_m) {
            return std::nullopt;
        }
        touched_m = vector_of(*goal.position_m) - above_m * normal;
        touch.wanted_m = plain(touched_m + beyond_m * normal);
    }
    touch.normal = plain(normal);
    touch.surface_m = plain(foot_m + beyond_m * normal);
    touch.waiting_m = plain(touched_m + (beyond_m + goal.standoff_m) * normal);
    return touch;
}

SpaceGoals::Candidate SpaceGoals::candidate(std::size_t goal, const SpacePoint& point) const {
    SpaceJudgedMotion level;
    std::copy_n(point.position, 3, level.position_m.begin());
    const double half_rad = point.position[space::yaw] / 2;
    level.attitude = {std::cos(half_rad), 0, 0, std::sin(half_rad)};
    std::copy_n(point.position + space::first_joint, max_joints, level.joints_rad.begin());
    const At here = at(level, SpaceWorld{});
    std::optional<Candidate> best;
    const std::vector<SpaceGoal> choices = choices_of(goals_[goal]);
    for (std::size_t i = 0; i < choices.size(); ++i) {
        Candidate one{single(choices[i], here), choices[i].hold_s, {}};
        if (const auto* contact = std::get_if<SpaceContactGoal>(&choices[i].kind)) {
            one.touch = touch_from(*contact, choices[i].hold_s, here, *named_[goal][i]);
            one.hold_s = touch_hover_s;
            one.off = one.touch ? from_touch(*one.touch, here) : one.off;
        }
        if (!best || one.off.used_share < best->off.used_share) {
            best = std::move(one);
        }
    }
    return *best;
}

std::vector<SpaceStay> SpaceGoals::stays(const SpacePlan& plan) const {
    const auto ticks_of = [&](double hold_s) {
        return std::max<std::int64_t>(1, std::llround(std::ceil(hold_s / plan.tick_s - 1e-9)));
    };
    const auto rests = [](const SpacePoint& point) {
        const auto is_zero = [](double x) { return x == 0; };
        return std::all_of(std::begin(point.velocity), std::end(point.velocity), is_zero) &&
               std::all_of(std::begin(point.acceleration), std::end(point.acceleration), is_zero);
    };
    std::vector<bool> is_visited(goals_.size());
    const auto left = [&] { return std::count(is_visited.begin(), is_visited.end(), false); };
    // Goals that may be next.
    const auto next = [&] {
        std::vector<std::size_t> goals;
        for (std::size_t i = 0; i < goals_.size() && (in_any_order_ || goals.empty()); ++i) {
            if (!is_visited[i]) {
                goals.push_back(i);
            }
        }
        return goals;
    };
    std::vector<SpaceStay> stays;
    const auto stay = [&](std::size_t goal, std::int64_t end, const Candidate& by) {
        is_visited[goal] = true;
        stays.push_back({goal, end, by.touch});
    };
    for (std::size_t k = 1; k < plan.reference.size() && left() > 1; ++k) {
        const SpaceKnot& to = plan.reference[k];
        const std::int64_t lasts = to.tick - plan.reference[k - 1].tick;
        if (!(plan.reference[k - 1].point == to.point) || !rests(to.point)) {
            continue;
        }
        for (const std::size_t goal : next()) {
            const Candidate by = candidate(goal, to.point);
            if (by.off.used_share <= 1 && lasts >= ticks_of(by.hold_s)) {
                stay(goal, to.tick, by);
                break;
            }
        }
    }
    std::optional<Candidate> last;
    std::size_t last_goal = 0;
    for (const std::size_t goal : next()) {
        Candidate by = candidate(goal, plan.reference.back().point);
        if (!last || by.off.used_share < last->off.used_share) {
            last = std::move(by);
            last_goal = goal;
        }
    }
    stay(last_goal, plan.reference.back().tick + ticks_of(last->hold_s), *last);
    return stays;
}

SpaceGoalDistance SpaceGoals::distance(const SpaceStay& stay, const SpaceJudgedMotion& motion,
                                       const SpaceWorld& world) const {
    const At here = at(motion, world);
    if (stay.touch) {
        return from_touch(*stay.touch, here);
    }
    std::optional<SpaceGoalDistance> nearest;
    for (const SpaceGoal& each : choices_of(goals_[stay.goal])) {
        const SpaceGoalDistance one = single(each, here);
        if (!nearest || one.used_share < nearest->used_share) {
            nearest = one;
        }
    }
    return *nearest;
}

}  // namespace downwash::judge
