#include "downwash/judge/touching.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/judge/position_loop.hpp"

namespace downwash::judge {
namespace {

// docs/model.md 2.6.
constexpr double stiffness_n_m = 1e5;
constexpr double dissipation_s_m = 10;
constexpr double friction = 0.5;
constexpr double slip_speed_m_s = 0.02;

double planar_dot(PlaneVector a, Planar b) {
    return a.x * b.x + a.z * b.z;
}

}  // namespace

std::vector<TouchSurface::Place> TouchSurface::places(const Vehicle& vehicle, const Motion& motion) const {
    std::vector<Place> all;
    for (const PlaneVector& point : touch_->frame_points_m) {
        const Planar lever = from_body(Planar{point.x, point.z} - vehicle.center_of_mass_m, motion.pitch_rad);
        all.push_back({motion.position_m + lever, motion.velocity_m_s + turned(motion.pitch_rate_rad_s, lever), lever});
    }
    if (all.empty()) {
        const Planar joint = from_body(vehicle.joint_m, motion.pitch_rad);
        const Planar arm = arm_direction(motion.pitch_rad, motion.arm_rad);
        const Planar tip = vehicle.arm_length_m * arm;
        all.push_back({motion.position_m + joint + tip,
                       motion.velocity_m_s + turned(motion.pitch_rate_rad_s, joint) +
                           turned(motion.pitch_rate_rad_s + motion.arm_rate_rad_s, tip),
                       (vehicle.arm_length_m - vehicle.arm_center_of_mass_m) * arm});
    }
    return all;
}

double TouchSurface::depth_m(const Place& place) const {
    const Planar surface = Planar{touch_->surface_m.x, touch_->surface_m.z} + shift_;
    return planar_dot(touch_->normal, surface - place.position_m);
}

double TouchSurface::depth_m(const Vehicle& vehicle, const Motion& motion) const {
    double deepest = -std::numeric_limits<double>::infinity();
    for (const Place& place : places(vehicle, motion)) {
        deepest = std::max(deepest, depth_m(place));
    }
    return deepest;
}

double TouchSurface::push(const Vehicle& vehicle, const Motion& motion, Loads& loads) const {
    double sum_n = 0;
    for (const Place& place : places(vehicle, motion)) {
        const double depth = depth_m(place);
        if (depth <= 0) {
            continue;
        }
        const Planar out{touch_->normal.x, touch_->normal.z};
        const double leaving_m_s = planar_dot(touch_->normal, place.velocity_m_s);
        const double normal_n = std::max(0.0, stiffness_n_m * depth * (1 - dissipation_s_m * leaving_m_s));
        const Planar slip = place.velocity_m_s - leaving_m_s * out;
        const double speed = std::hypot(slip.x, slip.z, slip_speed_m_s);
        const Planar force = normal_n * out + (-friction * normal_n / speed) * slip;
        if (touch_->frame_points_m.empty()) {
            loads.arm_force_n = loads.arm_force_n + force;
            loads.arm_moment_nm += moment_of(place.lever_m, force);
        } else {
            loads.body_force_n = loads.body_force_n + force;
            loads.body_moment_nm += moment_of(place.lever_m, force);
        }
        sum_n += normal_n;
    }
    return sum_n;
}

TouchCourse course_of(const Touch& touch, const Robot& robot) {
    return {touch, robot.multirotor.mass_kg + robot.arm.mass_kg, answer_1_s2(robot.controller.law, touch.normal.x == 0),
            1 / robot.controller.rate_hz};
}

ReferencePoint reference_of(const TouchCourse& course, const Touch& touch, ReferencePoint from) {
    const double out[] = {touch.normal.x, touch.normal.z};
    for (int axis = 0; axis < 2; ++axis) {
        from.position[axis] -= course.beyond_m() * out[axis];
        from.velocity[axis] = -course.speed_m_s() * out[axis];
    }
    return from;
}

}  // namespace downwash::judge
