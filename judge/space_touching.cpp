#include "downwash/judge/space_touching.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>

#include "downwash/judge/placement.hpp"
#include "downwash/judge/space_surroundings.hpp"

namespace downwash::judge {
namespace {

using Eigen::Vector3d;

// docs/model.md 2.11.
constexpr double stiffness_n_m = 1e5;
constexpr double dissipation_s_m = 10;
constexpr double friction = 0.5;
constexpr double slip_speed_m_s = 0.02;

std::size_t body_of(const SpaceTouchPoint& point) {
    return static_cast<std::size_t>(point.link + 1);
}

/// What a law answers to a metre of error [1/s2].
struct Answers {
    Vector3d operator()(const SpaceInversion& law) const {
        return {law.horizontal.kp_1_s2, law.horizontal.kp_1_s2, law.height.kp_1_s2};
    }
    Vector3d operator()(const Px4Cascade& law) const {
        const double level = law.position_p_1_s * law.velocity.kp_1_s;
        return {level, level, law.height_p_1_s * law.vertical_velocity.kp_1_s};
    }
};

}  // namespace

Vector3d lever_of(const SpaceVehicle& vehicle, const SpaceTouchPoint& point) {
    const Vector3d at = vector_of(point.at_m);
    return point.link < 0 ? Vector3d(at - vehicle.center_of_mass_m)
                          : Vector3d(vehicle.joints[static_cast<std::size_t>(point.link)].in_outer_m + at);
}

SpaceTouchSurface::SpaceTouchSurface(const SpaceTouch& touch, const SpaceWorld& world) : touch_(&touch), world_(world) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(world.scene_yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
    surface_m_ = turn * vector_of(touch.surface_m) + vector_of(world.scene_m);
    normal_ = turn * vector_of(touch.normal);
}

double SpaceTouchSurface::depth_m(const SpaceVehicle& vehicle, const BodyMotions& bodies) const {
    double deepest_m = -std::numeric_limits<double>::infinity();
    for (const SpaceTouchPoint& point : touch_->points) {
        const BodyMotion& body = bodies[body_of(point)];
        const Vector3d place_m = body.position_m + body.attitude * lever_of(vehicle, point);
        deepest_m = std::max(deepest_m, normal_.dot(surface_m_ - place_m));
    }
    return deepest_m;
}

double SpaceTouchSurface::push(const SpaceVehicle& vehicle, const BodyMotions& bodies,
                               std::vector<BodyLoad>& loads) const {
    double sum_n = 0;
    for (const SpaceTouchPoint& point : touch_->points) {
        const BodyMotion& body = bodies[body_of(point)];
        const Vector3d lever_m = body.attitude * lever_of(vehicle, point);
        const double depth_m = normal_.dot(surface_m_ - body.position_m - lever_m);
        if (depth_m <= 0) {
            continue;
        }
        const Vector3d velocity_m_s = body.velocity_m_s + body.rate_rad_s.cross(lever_m);
        const double leaving_m_s = normal_.dot(velocity_m_s);
        const double force_n = std::max(0.0, stiffness_n_m * depth_m * (1 - dissipation_s_m * leaving_m_s));
        const Vector3d slip_m_s = velocity_m_s - leaving_m_s * normal_;
        const Vector3d drag = friction * slip_m_s / std::hypot(slip_m_s.norm(), slip_speed_m_s);
        loads[body_of(point)].push(lever_m, force_n * (normal_ - drag));
        sum_n += force_n;
    }
    return sum_n;
}

Vector3d SpaceTouchSurface::middle_m(const SpaceVehicle& vehicle, const BodyMotions& bodies) const {
    Vector3d sum_m = Vector3d::Zero();
    for (const SpaceTouchPoint& point : touch_->points) {
        const BodyMotion& body = bodies[body_of(point)];
        sum_m += body.position_m + body.attitude * lever_of(vehicle, point);
    }
    return nominal_place(world_, sum_m / static_cast<double>(touch_->points.size()));
}

double answer_1_s2(const SpaceTouch& touch, const SpaceRobot& robot) {
    return vector_of(touch.normal).cwiseAbs2().dot(std::visit(Answers{}, robot.controller.law));
}

TouchCourse course_of(const SpaceTouch& touch, const SpaceRobot& robot) {
    return {touch, robot.mass_kg(), answer_1_s2(touch, robot), 1 / robot.controller.rate_hz};
}

}  // namespace downwash::judge
