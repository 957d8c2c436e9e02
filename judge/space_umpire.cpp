#include "downwash/judge/space_umpire.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "downwash/judge/placement.hpp"

namespace downwash::judge {
namespace {

constexpr double unstable_tilt_rad = 80 * std::numbers::pi / 180;
constexpr double unstable_error_m = 3;
constexpr double max_number = 1e20;
/// Between two poses a tick apart contact is looked for down to stretches in which nothing moves farther [m].
constexpr double unseen_motion_m = 1e-4;

double error_m(const SpaceCoordinates& at, const SpacePoint& reference) {
    return (at.position_m - Eigen::Map<const Eigen::Vector3d>(reference.position)).norm();
}

/// Whether no number is NaN or beyond what can be computed with.
bool is_usable(const SpaceCoordinates& at) {
    const auto is_small = [](const auto& numbers) { return (numbers.array().abs() <= max_number).all(); };
    return is_small(at.position_m) && is_small(at.attitude.coeffs()) && is_small(at.velocity_m_s) &&
           is_small(at.body_rate_rad_s) && is_small(at.joints_rad) && is_small(at.joint_rates_rad_s);
}

Vector3 vector3_of(const Eigen::Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

}  // namespace

SpaceJudgedMotion motion_of(const SpaceCoordinates& at) {
    SpaceJudgedMotion motion;
    motion.position_m = vector3_of(at.position_m);
    motion.attitude = {at.attitude.w(), at.attitude.x(), at.attitude.y(), at.attitude.z()};
    std::copy_n(at.joints_rad.data(), at.joints_rad.size(), motion.joints_rad.begin());
    motion.velocity_m_s = vector3_of(at.velocity_m_s);
    motion.body_rates_rad_s = vector3_of(at.body_rate_rad_s);
    std::copy_n(at.joint_rates_rad_s.data(), at.joint_rates_rad_s.size(), motion.joint_rates_rad_s.begin());
    return motion;
}

bool SpaceStability::is_stable(const SpaceCoordinates& at, const SpacePoint& reference) {
    if (!is_usable(at)) {
        return false;
    }
    const double up = (at.attitude.normalized() * Eigen::Vector3d::UnitZ()).z();
    const bool is_upright = std::acos(std::clamp(up, -1.0, 1.0)) < unstable_tilt_rad;
    const bool falls_over = was_upright_ && !is_upright;
    was_upright_ = was_upright_ || is_upright;
    return !falls_over && error_m(at, reference) <= unstable_error_m;
}

bool SpaceUmpire::sees(const SpaceLoop& loop, const SpacePoint& reference) {
    const bool is_stable = stability_.is_stable(loop.coordinates(), reference);
    if (!is_usable(loop.coordinates())) {  // no row: nothing follows from it
        flight_.outcome = Outcome::unstable;
        return false;
    }
    const bool is_first = flight_.rows.empty();
    const std::vector<BodyFrame> frames = frames_of(loop.plant().vehicle(), loop.state().bodies, world_);
    const double clearance_m = obstacles_.clearance_m(frames);
    const double self_m = obstacles_.self_clearance_m(frames);
    const Instant now{tick_s_, loop.state().bodies, std::min(clearance_m, 0.5 * self_m)};
    add_row(loop, reference, clearance_m);
    if (!is_stable) {
        flight_.outcome = Outcome::unstable;
    } else if (now.clearance_m <= 0 || (!is_first && touches_between(loop, last_, now))) {
        flight_.outcome = Outcome::collision;
        flight_.is_self_collision = clearance_m > 0 && self_m <= 0;
        flight_.min_clearance_m = 0;
    } else if (!is_flyable(loop)) {
        flight_.outcome = Outcome::left_flyable_area;
    }
    last_ = now;
    last_.since_s = 0;
    return flight_.outcome == Outcome::ok;
}

bool SpaceUmpire::sees_touch(const SpaceLoop& loop, const SpacePoint& reference, const SpaceTouchSurface& surface,
                             bool is_holding) {
    constexpr double max_depth_m = 0.002;
    constexpr double air_m = 5e-4;
    const bool is_stable = stability_.is_stable(loop.coordinates(), reference);
    if (!is_usable(loop.coordinates())) {
        flight_.outcome = Outcome::unstable;
        return false;
    }
    const SpaceVehicle& vehicle = loop.plant().vehicle();
    const BodyMotions& bodies = loop.state().bodies;
    const double depth_m = surface.depth_m(vehicle, bodies);
    const double before_m = flight_.min_clearance_m;
    std::vector<BodyFrame> frames = frames_of(vehicle, bodies, world_);
    add_row(loop, reference, obstacles_.clearance_m(frames));
    flight_.min_clearance_m = before_m;  // the touch does not count
    // All but the surface sees a vehicle that is off it.
    for (BodyFrame& frame : frames) {
        frame.origin_m += std::max(0.0, depth_m + air_m) * vector_of(surface.touch().normal);
    }
    const double beside_m = obstacles_.clearance_m(frames);
    const double self_m = obstacles_.self_clearance_m(frames);
    if (!is_stable) {
        flight_.outcome = Outcome::unstable;
    } else if (depth_m > max_depth_m || beside_m <= 0 || self_m <= 0) {
        flight_.outcome = Outcome::collision;
        flight_.is_self_collision = depth_m <= max_depth_m && beside_m > 0;
        flight_.min_clearance_m = 0;
    } else if (!is_flyable(loop)) {
        flight_.outcome = Outcome::left_flyable_area;
    }
    is_apart_ = depth_m < 0;
    if (is_holding) {
        const Eigen::Vector3d place_m = surface.middle_m(vehicle, bodies);
        held_m_ = held_m_.value_or(place_m);
        const Eigen::Vector3d way_m = place_m - *held_m_;
        slip_m_ = std::max(slip_m_, way_m.cross(vector_of(surface.touch().normal)).norm());
    }
    last_ = {0, bodies, std::min(beside_m, 0.5 * self_m)};
    return flight_.outcome == Outcome::ok;
}

SpaceJudgedTouch SpaceUmpire::touch(const SpaceTouch& touch, const std::optional<TouchCourse::Hold>& hold) {
    SpaceJudgedTouch judged;
    judged.is_free = std::exchange(is_apart_, true);
    judged.slip_m = std::exchange(slip_m_, 0.0);
    const std::optional<Eigen::Vector3d> held_m = std::exchange(held_m_, std::nullopt);
    if (held_m) {
        judged.place_m = vector3_of(*held_m);
        const bool is_near =
            !touch.wanted_m ||
            (*held_m - vector_of(*touch.wanted_m)).cross(vector_of(touch.normal)).norm() <= touch.tolerance_m;
        judged.is_place_met = is_near && judged.slip_m <= touch.tolerance_m;
    }
    if (hold) {
        judged.force_n = hold->mean_n;
        judged.is_force_met = hold->worst_second_n <= touch.force_tolerance_n;
    }
    return judged;
}

SpaceUmpire::Instant SpaceUmpire::instant_at(const SpaceLoop& loop, double since_s, BodyMotions bodies) const {
    const std::vector<BodyFrame> frames = frames_of(loop.plant().vehicle(), bodies, world_);
    return {since_s, std::move(bodies),
            std::min(obstacles_.clearance_m(frames), 0.5 * obstacles_.self_clearance_m(frames))};
}

bool SpaceUmpire::touches_between(const SpaceLoop& loop, const Instant& from, const Instant& to) const {
    const double motion_m = max_speed_m_s(loop.plant().vehicle(), from.bodies, to.bodies) * (to.since_s - from.since_s);
    if (from.clearance_m + to.clearance_m > motion_m || motion_m < unseen_motion_m) {
        return false;
    }
    const double middle_s = 0.5 * (from.since_s + to.since_s);
    const Instant middle = instant_at(loop, middle_s, loop.bodies_within(middle_s));
    return middle.clearance_m <= 0 || touches_between(loop, from, middle) || touches_between(loop, middle, to);
}

double SpaceUmpire::max_speed_m_s(const SpaceVehicle& vehicle, const BodyMotions& a, const BodyMotions& b) const {
    double most_m_s = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Eigen::Vector3d lever =
            i == 0 ? Eigen::Vector3d(-vehicle.center_of_mass_m) : vehicle.joints[i - 1].in_outer_m;
        const double reach_m = lever.norm() + obstacles_.reach_m()[i];  // from the centre of mass
        const auto speed = [&](const Eigen::Vector3d& velocity, const Eigen::Vector3d& rate) {
            return velocity.norm() + reach_m * rate.norm();
        };
        most_m_s = std::max(
            most_m_s, std::max(speed(a[i].velocity_m_s, a[i].rate_rad_s), speed(b[i].velocity_m_s, b[i].rate_rad_s)) +
                          speed(b[i].velocity_m_s - a[i].velocity_m_s, b[i].rate_rad_s - a[i].rate_rad_s));
    }
    return most_m_s;
}

bool SpaceUmpire::is_flyable(const SpaceLoop& loop) const {
    if (surfaces_.surfaces() == nullptr) {
        return true;
    }
    const double distance_m = surfaces_.surfaces()->settings().min_distance_radii * robot_.rotor_radius_m;
    const BodyMotion& body = loop.state().bodies.front();
    const std::vector<FlyingRotor>& rotors = loop.plant().vehicle().rotors;
    return std::all_of(rotors.begin(), rotors.end(), [&](const FlyingRotor& rotor) {
        const Eigen::Vector3d hub_m = body.position_m + body.attitude * rotor.hub_m;
        return obstacles_.disc_keeps(distance_m, nominal_place(world_, hub_m)) && surfaces_.is_given_map_flyable(hub_m);
    });
}

void SpaceUmpire::add_row(const SpaceLoop& loop, const SpacePoint& reference, double clearance_m) {
    const SpaceCoordinates& at = loop.coordinates();
    SpaceJudgedRow row;
    row.t_s = static_cast<double>(flight_.rows.size()) * tick_s_;
    row.motion = motion_of(at);
    row.reference = reference;
    row.clearance_m = clearance_m;
    row.energy_j = loop.state().energy_j;
    flight_.rows.push_back(row);
    flight_.min_clearance_m = std::min(flight_.min_clearance_m, clearance_m);
    flight_.max_tracking_error_m = std::max(flight_.max_tracking_error_m, error_m(at, reference));
    flight_.energy_j = row.energy_j;
    flight_.duration_s = row.t_s;
}

}  // namespace downwash::judge
