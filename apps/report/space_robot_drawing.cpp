#include "downwash/report/space_robot_drawing.hpp"

#include <cmath>
#include <cstddef>

#include "downwash/base/lane_math.hpp"
#include "downwash/report/obstacle_outline.hpp"

namespace downwash {
namespace {

/// Where the axes of a body are in the world.
struct Frame {
    Matrix3 rotation;
    Vector3 origin_m;

    [[nodiscard]] Vector3 at(const Vector3& own_m) const { return origin_m + rotation * own_m; }
};

Vector3 unit(const Vector3& v) {
    return 1 / std::sqrt(dot(v, v)) * v;
}

Matrix3 product(const Matrix3& a, const Matrix3& b) {
    Matrix3 both;
    for (std::size_t i = 0; i < 3; ++i) {
        both[i] = a[i][0] * b[0] + a[i][1] * b[1] + a[i][2] * b[2];
    }
    return both;
}

/// The multirotor, then the links, each from its joint.
std::vector<Frame> frames_at(const SpaceRobot& robot, const SpacePose& pose) {
    std::vector<Frame> frames{{rotation_of(pose.attitude), pose.position_m}};
    for (std::size_t i = 0; i < robot.plant.links.size(); ++i) {
        const SpaceLink& link = robot.plant.links[i];
        const Frame on = frames.back();
        const auto [sine, cosine] = lane::sin_cos(pose.joints_rad[i] / 2);
        const Vector3 axis = sine * unit(link.axis);
        const std::array<double, 4> turn{cosine, axis[0], axis[1], axis[2]};
        frames.push_back({product(on.rotation, rotation_of(turn)), on.at(link.joint_m)});
    }
    return frames;
}

PlanePoint seen(const Matrix3& view, const Vector3& p_m) {
    const Vector3 turned = view * p_m;
    return {turned[0], turned[2]};
}

Ring disc_of(const SpaceRotor& rotor, double radius_m, const Frame& body, const Matrix3& view) {
    constexpr int corners = 48;
    constexpr double whole_turn_rad = 6.283185307179586;
    const Vector3 axis = unit(rotor.axis);
    const Vector3 across = unit(cross(axis, std::abs(axis[0]) < 0.6 ? Vector3{1, 0, 0} : Vector3{0, 1, 0}));
    const Vector3 other = cross(axis, across);
    Ring ring;
    for (int i = 0; i <= corners; ++i) {
        const auto [sine, cosine] = lane::sin_cos(whole_turn_rad * i / corners);
        ring.push_back(seen(view, body.at(rotor.position_m + radius_m * cosine * across + radius_m * sine * other)));
    }
    return ring;
}

}  // namespace

std::vector<Ring> robot_lines(const SpaceRobot& robot, const SpacePose& pose, const Matrix3& view) {
    const std::vector<Frame> frames = frames_at(robot, pose);
    std::vector<Ring> lines;
    const auto add_bodies = [&](const std::vector<SpaceBodyShape>& bodies, const Frame& frame) {
        for (const SpaceBodyShape& body : bodies) {
            Ring ring = seen_outline(body, frame.rotation, frame.origin_m, view);
            if (!ring.empty()) {
                ring.push_back(ring.front());
                lines.push_back(std::move(ring));
            }
        }
    };
    add_bodies(robot.body, frames.front());
    for (const SpaceRotor& rotor : robot.plant.rotors) {
        lines.push_back(disc_of(rotor, robot.rotor_radius_m, frames.front(), view));
    }
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        const Frame& frame = frames[i + 1];
        add_bodies(robot.links[i].body, frame);
        if (robot.links[i].body.empty()) {
            const bool is_last = i + 1 == robot.links.size();
            const Vector3 end_m = is_last ? frame.at(robot.plant.end_effector_m) : frames[i + 2].origin_m;
            lines.push_back({seen(view, frame.origin_m), seen(view, end_m)});
        }
    }
    return lines;
}

Vector3 end_effector_at(const SpaceRobot& robot, const SpacePose& pose) {
    return frames_at(robot, pose).back().at(robot.plant.end_effector_m);
}

}  // namespace downwash
