#include "reference.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

namespace reference {
namespace {

Vector3 plus(const Vector3& a, double s, const Vector3& b) {
    return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}
double dot(const Vector3& a, const Vector3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double norm(const Vector3& a) {
    return std::sqrt(dot(a, a));
}
Vector3 cross(const Vector3& a, const Vector3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Right-handed unit vectors whose third points along `direction`.
std::array<Vector3, 3> axes_along(const Vector3& direction) {
    const Vector3 z = plus({0, 0, 0}, 1 / norm(direction), direction);
    const Vector3 any = std::abs(z[0]) < 0.5 ? Vector3{1, 0, 0} : Vector3{0, 1, 0};
    const Vector3 x = cross(any, z);
    const Vector3 unit_x = plus({0, 0, 0}, 1 / norm(x), x);
    return {unit_x, cross(z, unit_x), z};
}

Vector3 rolled_pitched_yawed(Vector3 v, const Vector3& rpy_rad) {
    const auto turn = [&v](std::size_t i, std::size_t j, double angle) {
        const double vi = v[i];
        v[i] = std::cos(angle) * vi - std::sin(angle) * v[j];
        v[j] = std::sin(angle) * vi + std::cos(angle) * v[j];
    };
    turn(1, 2, rpy_rad[0]);
    turn(2, 0, rpy_rad[1]);
    turn(0, 1, rpy_rad[2]);
    return v;
}

/// A shape in its own frame, whose axes in the world are `frame`.
Solid placed(const downwash::Primitive& shape, const Vector3& center_m, const std::array<Vector3, 3>& frame) {
    Solid solid{Solid::Kind::box, center_m, frame, {0, 0, 0}, 0};
    if (const auto* box = std::get_if<downwash::Box>(&shape)) {
        solid.half_m = {box->size_m[0] / 2, box->size_m[1] / 2, box->size_m[2] / 2};
    } else if (const auto* cylinder = std::get_if<downwash::Cylinder>(&shape)) {
        Vector3 axis{0, 0, 0};
        for (std::size_t k = 0; k < 3; ++k) {
            axis = plus(axis, cylinder->axis[k], frame[k]);
        }
        solid.kind = Solid::Kind::cylinder;
        solid.axes = axes_along(axis);
        solid.half_m = {cylinder->radius_m, 0, cylinder->length_m / 2};
    } else {
        solid.ball_m = std::get<downwash::Sphere>(shape).radius_m;
    }
    return solid;
}

double support(const Solid& solid, const Vector3& n) {
    if (solid.kind == Solid::Kind::triangle) {
        return std::max({dot(solid.axes[0], n), dot(solid.axes[1], n), dot(solid.axes[2], n)});
    }
    const double x = dot(solid.axes[0], n);
    const double y = dot(solid.axes[1], n);
    const double z = dot(solid.axes[2], n);
    const double across = solid.kind == Solid::Kind::box ? std::abs(x) * solid.half_m[0] + std::abs(y) * solid.half_m[1]
                                                         : std::hypot(x, y) * solid.half_m[0];
    return dot(solid.center_m, n) + across + std::abs(z) * solid.half_m[2] + norm(n) * solid.ball_m;
}

/// The nearest point inside the triangle when the foot in its plane lies there, else on one of its edges.
Vector3 project_on_triangle(const std::array<Vector3, 3>& t, const Vector3& p) {
    const Vector3 ab = plus(t[1], -1, t[0]);
    const Vector3 ac = plus(t[2], -1, t[0]);
    const Vector3 ap = plus(p, -1, t[0]);
    const double bb = dot(ab, ab);
    const double bc = dot(ab, ac);
    const double cc = dot(ac, ac);
    const double whole = bb * cc - bc * bc;
    const double s = (cc * dot(ab, ap) - bc * dot(ac, ap)) / whole;
    const double r = (bb * dot(ac, ap) - bc * dot(ab, ap)) / whole;
    if (s >= 0 && r >= 0 && s + r <= 1) {
        return plus(plus(t[0], s, ab), r, ac);
    }
    Vector3 nearest{};
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const Vector3 edge = plus(t[(i + 1) % 3], -1, t[i]);
        const double part = std::clamp(dot(plus(p, -1, t[i]), edge) / dot(edge, edge), 0.0, 1.0);
        const Vector3 foot = plus(t[i], part, edge);
        const double distance = norm(plus(p, -1, foot));
        if (distance < least) {
            least = distance;
            nearest = foot;
        }
    }
    return nearest;
}

}  // namespace

Vector3 project(const Solid& solid, const Vector3& p_m) {
    if (solid.kind == Solid::Kind::triangle) {
        return project_on_triangle(solid.axes, p_m);
    }
    const Vector3 offset = plus(p_m, -1, solid.center_m);
    Vector3 local{dot(offset, solid.axes[0]), dot(offset, solid.axes[1]), dot(offset, solid.axes[2])};
    local[2] = std::clamp(local[2], -solid.half_m[2], solid.half_m[2]);
    if (solid.kind == Solid::Kind::box) {
        local[0] = std::clamp(local[0], -solid.half_m[0], solid.half_m[0]);
        local[1] = std::clamp(local[1], -solid.half_m[1], solid.half_m[1]);
    } else if (const double r = std::hypot(local[0], local[1]); r > solid.half_m[0]) {
        local[0] *= solid.half_m[0] / r;
        local[1] *= solid.half_m[0] / r;
    }
    Vector3 core = solid.center_m;
    for (std::size_t k = 0; k < 3; ++k) {
        core = plus(core, local[k], solid.axes[k]);
    }
    const Vector3 outward = plus(p_m, -1, core);
    const double distance = norm(outward);
    return distance <= solid.ball_m ? p_m : plus(core, solid.ball_m / distance, outward);
}

double distance_to_point(const Solid& solid, const Vector3& p_m) {
    return norm(plus(p_m, -1, project(solid, p_m)));
}

Enclosure distance(const Solid& a, const Solid& b) {
    Enclosure enclosure{0, std::numeric_limits<double>::infinity()};
    Vector3 p = a.center_m;
    for (int step = 0; step < 100000 && enclosure.high - enclosure.low > 1e-9; ++step) {
        const Vector3 q = project(b, p);
        p = project(a, q);
        const Vector3 apart = plus(q, -1, p);
        const double length = norm(apart);
        enclosure.high = std::min(enclosure.high, length);
        if (length > 0) {
            const Vector3 back{-apart[0], -apart[1], -apart[2]};
            enclosure.low = std::max(enclosure.low, (-support(b, back) - support(a, apart)) / length);
        }
    }
    return enclosure;
}

downwash::Shape shape_of(const downwash::Primitive& primitive) {
    return std::visit([](const auto& solid) { return downwash::Shape(solid); }, primitive);
}

namespace {

template <class AnyShape>
downwash::Primitive primitive_in(const AnyShape& shape) {
    if (const auto* box = std::get_if<downwash::Box>(&shape)) {
        return *box;
    }
    if (const auto* cylinder = std::get_if<downwash::Cylinder>(&shape)) {
        return *cylinder;
    }
    return std::get<downwash::Sphere>(shape);
}

}  // namespace

downwash::Primitive primitive_of(const downwash::Shape& shape) {
    return primitive_in(shape);
}

Solid solid_of(const downwash::Obstacle& obstacle) {
    const Vector3& rpy = obstacle.rpy_rad;
    return placed(primitive_of(obstacle.shape), obstacle.center_world_m,
                  {rolled_pitched_yawed({1, 0, 0}, rpy), rolled_pitched_yawed({0, 1, 0}, rpy),
                   rolled_pitched_yawed({0, 0, 1}, rpy)});
}

Solid triangle(const std::array<Vector3, 3>& corners_m) {
    return {Solid::Kind::triangle, {0, 0, 0}, corners_m, {0, 0, 0}, 0};
}

Solid disc(const Vector3& center_m, double radius_m) {
    return {Solid::Kind::cylinder, center_m, axes_along({0, 0, 1}), {radius_m, 0, 0}, 0};
}

std::vector<Solid> robot_at(const downwash::PlanarPose& pose, const downwash::PlaneOfMotion& plane,
                            const downwash::RobotShape& robot) {
    const double q = pose.pitch_rad;
    const double a = pose.pitch_rad + pose.arm_rad;
    const Vector3 origin = plane.to_world(0, 0, 0);
    const auto in_world = [&](double x, double lateral, double z) {
        return plus(plane.to_world(x, lateral, z), -1, origin);
    };
    const Vector3 b1 = in_world(std::cos(q), 0, -std::sin(q));
    const Vector3 b2 = in_world(0, 1, 0);
    const Vector3 b3 = in_world(std::sin(q), 0, std::cos(q));
    const Vector3 center = plane.to_world(pose.x_m, 0, pose.z_m);
    std::vector<Solid> solids;
    for (const downwash::BodyShape& body : robot.bodies) {
        const Vector3& c = body.center_body_m;
        solids.push_back(placed(body.shape, plus(plus(plus(center, c[0], b1), c[1], b2), c[2], b3), {b1, b2, b3}));
    }
    const Vector3 arm = in_world(std::cos(a), 0, -std::sin(a));
    const Vector3 joint = plus(plus(center, robot.joint_x_m, b1), robot.joint_z_m, b3);
    const double half = robot.arm_length_m / 2;
    solids.push_back(
        {Solid::Kind::cylinder, plus(joint, half, arm), axes_along(arm), {0, 0, half}, robot.arm_radius_m});
    return solids;
}

Vector3 Frame::turned(const Vector3& v) const {
    return plus(plus(plus({0, 0, 0}, v[0], axes[0]), v[1], axes[1]), v[2], axes[2]);
}

Vector3 Frame::placed(const Vector3& p_m) const {
    return plus(origin_m, 1, turned(p_m));
}

std::vector<Frame> frames_at(const downwash::SpacePose& pose, const downwash::SpaceRobotShape& robot) {
    /// v turned about a vector of length 1 by an angle with this cosine and sine.
    const auto turned_about = [](const Vector3& axis, double cosine, double sine, const Vector3& v) {
        const Vector3 across = plus(v, -dot(axis, v), axis);
        return plus(plus(plus(v, -1, across), cosine, across), sine, cross(axis, v));
    };
    const auto& q = pose.attitude;
    const Vector3 vector{q[1], q[2], q[3]};
    const double half = std::atan2(norm(vector), q[0]);
    const Vector3 axis = norm(vector) > 0 ? plus({0, 0, 0}, 1 / norm(vector), vector) : Vector3{1, 0, 0};
    std::vector<Frame> frames(1);
    frames[0].origin_m = pose.position_m;
    for (std::size_t k = 0; k < 3; ++k) {
        Vector3 own{0, 0, 0};
        own[k] = 1;
        frames[0].axes[k] = turned_about(axis, std::cos(2 * half), std::sin(2 * half), own);
    }
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        const downwash::SpaceLinkShape& link = robot.links[i];
        const Frame on = frames.back();
        const Vector3 hinge = plus({0, 0, 0}, 1 / norm(link.axis), on.turned(link.axis));
        Frame frame = on;
        frame.origin_m = on.placed(link.joint_m);
        for (Vector3& own : frame.axes) {
            own = turned_about(hinge, std::cos(pose.joints_rad[i]), std::sin(pose.joints_rad[i]), own);
        }
        frames.push_back(frame);
    }
    return frames;
}

std::vector<std::vector<Solid>> bodies_at(const downwash::SpacePose& pose, const downwash::SpaceRobotShape& robot) {
    const std::vector<Frame> frames = frames_at(pose, robot);
    std::vector<std::vector<Solid>> bodies(frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        for (const downwash::SpaceBodyShape& body : i == 0 ? robot.bodies : robot.links[i - 1].bodies) {
            const Frame frame{frames[i].axes, frames[i].placed(body.center_m)};
            if (const auto* capsule = std::get_if<downwash::Capsule>(&body.shape)) {
                const Vector3 from = frame.placed(capsule->from_m), line = plus(frame.placed(capsule->to_m), -1, from);
                bodies[i].push_back({Solid::Kind::cylinder,
                                     plus(from, 0.5, line),
                                     axes_along(norm(line) > 0 ? line : Vector3{0, 0, 1}),
                                     {0, 0, norm(line) / 2},
                                     capsule->radius_m});
            } else {
                const downwash::Primitive primitive = primitive_in(body.shape);
                bodies[i].push_back(reference::placed(primitive, frame.origin_m, frame.axes));
            }
        }
    }
    return bodies;
}

std::vector<Solid> robot_at(const downwash::SpacePose& pose, const downwash::SpaceRobotShape& robot) {
    std::vector<Solid> all;
    for (const std::vector<Solid>& body : bodies_at(pose, robot)) {
        all.insert(all.end(), body.begin(), body.end());
    }
    return all;
}

Enclosure clearance(const std::vector<Solid>& robot, const std::vector<Solid>& solids) {
    const double infinity = std::numeric_limits<double>::infinity();
    Enclosure least{infinity, infinity};
    for (const Solid& solid : solids) {
        for (const Solid& part : robot) {
            const Enclosure pair = distance(part, solid);
            least = {std::min(least.low, pair.low), std::min(least.high, pair.high)};
        }
    }
    return least;
}

Enclosure clearance(const std::vector<Solid>& robot, const std::vector<downwash::Obstacle>& obstacles) {
    std::vector<Solid> solids(obstacles.size());
    std::transform(obstacles.begin(), obstacles.end(), solids.begin(), solid_of);
    return clearance(robot, solids);
}

downwash::CollisionChecker checker_of(std::vector<downwash::Obstacle> obstacles, const downwash::RobotShape& robot,
                                      const downwash::PlaneOfMotion& plane) {
    return {std::make_shared<const downwash::Scene>(std::move(obstacles)), plane, robot};
}

int contacts_of_equals(const std::vector<downwash::Obstacle>& found, const std::vector<downwash::Obstacle>& expected,
                       Dice& dice) {
    const downwash::RobotShape robot = dice.robot();
    const downwash::PlaneOfMotion plane = dice.plane();
    const downwash::CollisionChecker checker = checker_of(found, robot, plane);
    const downwash::CollisionChecker other = checker_of(expected, robot, plane);
    const downwash::Scene scene(found), other_scene(expected);
    int contacts = 0;
    for (int i = 0; i < 20; ++i) {
        const downwash::PlanarPose pose = dice.pose();
        const double clearance = other.clearance_m(pose);
        CAPTURE(i);
        REQUIRE(std::max(0.0, checker.clearance_m(pose)) == about(std::max(0.0, clearance)));
        REQUIRE((checker.clearance_m(pose) <= 0) == (clearance <= 0));
        REQUIRE(checker.is_nearer_than(pose, 0) == (clearance <= 0));
        if (std::abs(clearance - 0.3) > 1e-8) {
            REQUIRE(checker.is_nearer_than(pose, 0.3) == (clearance < 0.3));
        }
        contacts += clearance <= 0 ? 1 : 0;

        const Vector3 hub = dice.vector(-2, 2);
        const double radius = dice.between(0.05, 0.5);
        const double distance = disc_clearance_m(other_scene, hub, radius);
        REQUIRE(disc_clearance_m(scene, hub, radius) == about(distance));
        if (std::abs(distance - 0.2) > 1e-8) {
            REQUIRE(disc_is_clear(scene, hub, radius, 0.2) == (distance >= 0.2));
        }
        REQUIRE(horizontal_clearance_m(scene, hub) ==
                Approx(horizontal_clearance_m(other_scene, hub)).epsilon(0).margin(1e-5));
    }
    return contacts;
}

downwash::Primitive Dice::shape(double least_m, double most_m) {
    const auto length = [&] { return between(least_m, most_m); };
    const double kind = between(0, 3);
    if (kind < 1) {
        return downwash::Box{{length(), length(), length()}};
    }
    if (kind < 2) {
        return downwash::Cylinder{length() / 2, length(), coin() ? Vector3{0, 1, 0} : vector(-1, 1)};
    }
    return downwash::Sphere{length() / 2};
}

downwash::Obstacle Dice::obstacle() {
    return {"obstacle", shape_of(shape(0.1, 1.5)), vector(-2, 2), coin() ? Vector3{0, 0, 0} : vector(-4, 4)};
}

downwash::Obstacle Dice::gridded_obstacle() {
    const auto steps = [&](double low, double high) { return std::round(between(low, high)); };
    const auto length = [&] { return 0.25 * steps(1, 6); };
    const double half_right = 0.78539816339744830962;
    downwash::Obstacle drawn = obstacle();
    if (coin()) {
        drawn.shape = downwash::Cylinder{length() / 2, length(), {steps(-1, 1), steps(-1, 1), 1}};
    } else if (coin()) {
        drawn.shape = downwash::Box{{length(), length(), length()}};
    } else {
        drawn.shape = downwash::Sphere{length() / 2};
    }
    drawn.center_world_m = {0.25 * steps(-6, 6), 0.25 * steps(-6, 6), 0.25 * steps(-6, 6)};
    drawn.rpy_rad = {half_right * steps(-2, 2), half_right * steps(-2, 2), half_right * steps(-2, 2)};
    return drawn;
}

std::vector<downwash::Obstacle> Dice::obstacles(int count) {
    std::vector<downwash::Obstacle> drawn;
    for (int i = 0; i < count; ++i) {
        drawn.push_back(obstacle());
    }
    return drawn;
}

downwash::RobotShape Dice::robot() {
    return {{{shape(0.05, 0.6), vector(-0.1, 0.1)}, {shape(0.05, 0.3), vector(-0.2, 0.2)}},
            between(-0.1, 0.1),
            between(-0.1, 0.1),
            between(0.1, 0.7),
            between(0.01, 0.05)};
}

downwash::SpaceRobotShape Dice::space_robot(int links) {
    const auto widened = [](const downwash::Primitive& primitive) {
        return std::visit([](const auto& solid) { return downwash::SpaceShape(solid); }, primitive);
    };
    downwash::SpaceRobotShape robot;
    robot.bodies = {{widened(shape(0.05, 0.5)), vector(-0.1, 0.1)}, {widened(shape(0.05, 0.3)), vector(-0.3, 0.3)}};
    for (int i = 0; i < links; ++i) {
        downwash::SpaceLinkShape link;
        link.joint_m = vector(-0.25, 0.25);
        link.axis = vector(-1, 1);
        link.bodies = {coin() ? downwash::SpaceBodyShape{widened(shape(0.05, 0.2)), vector(-0.1, 0.1)}
                              : downwash::SpaceBodyShape{
                                    downwash::Capsule{between(0.01, 0.05), vector(-0.1, 0.1), vector(-0.3, 0.3)},
                                    vector(-0.05, 0.05)}};
        robot.links.push_back(link);
    }
    return robot;
}

downwash::SpacePose Dice::space_pose() {
    downwash::SpacePose pose;
    pose.position_m = vector(-2.5, 2.5);
    double squared = 0;
    do {  // evenly over all rotations
        pose.attitude = {between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1)};
        squared = 0;
        for (const double number : pose.attitude) {
            squared += number * number;
        }
    } while (squared > 1 || squared < 0.01);
    for (double& number : pose.attitude) {
        number /= std::sqrt(squared);
    }
    for (double& angle : pose.joints_rad) {
        angle = between(-3.14, 3.14);
    }
    return pose;
}

downwash::PlanarPose Dice::pose() {
    return {between(-2.5, 2.5), between(-2.5, 2.5), between(-0.7, 0.7), between(-7, 7)};
}

downwash::PlaneOfMotion Dice::plane() {
    const Vector3 origin = vector(-0.5, 0.5);
    return {origin, between(-4, 4)};
}

}  // namespace reference
