#include "downwash/simulation/space_touch_flight.hpp"

#include <algorithm>
#include <cstddef>
#include <variant>

#include "downwash/base/lane_math.hpp"
#include "downwash/simulation/space_touch_place.hpp"
#include "downwash/simulation/space_world.hpp"

namespace downwash {

std::string_view name_of(SpaceTouchEnd end) noexcept {
    constexpr std::string_view names[] = {"met",     "missed", "wrong_place", "wrong_force",
                                          "slipped", "stuck",  "too_deep",    "cut_short"};
    return names[static_cast<std::size_t>(end)];
}

namespace simulation {
namespace {

dynamics::LaneVector<double> lane_vector(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

/// A vector of the nominal scene as the world has it.
Vector3 turned(const Vector3& v, double yaw_rad) {
    const auto [sine, cosine] = lane::sin_cos(yaw_rad);
    return {cosine * v[0] - sine * v[1], sine * v[0] + cosine * v[1], v[2]};
}

dynamics::SpaceContact contact_of(const SpaceTouch& touch, const SpaceWorld& world) {
    dynamics::SpaceContact contact;
    contact.surface_m = lane_vector(world.scene_m + turned(touch.surface_m, world.scene_yaw_rad));
    contact.normal = lane_vector(turned(touch.normal, world.scene_yaw_rad));
    for (const SpaceTouchPoint& point : touch.points) {
        contact.point[contact.point_count++] = {point.link, lane_vector(point.at_m)};
    }
    return contact;
}

/// What a law answers to a metre along a vector of length 1 [1/s2].
double stiffness_1_s2(const SpaceLaw& law, const Vector3& along) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double share = along[static_cast<std::size_t>(axis)];
        sum += share * share * std::visit([axis](const auto& own) { return own.position_stiffness_1_s2(axis); }, law);
    }
    return sum;
}

/// How long a vector is without its part along another one of length 1.
double length_across(const Vector3& v, const Vector3& normal) {
    const Vector3 across = v - dot(v, normal) * normal;
    return lane::sqrt(dot(across, across));
}

}  // namespace

SpaceTouchFlight::SpaceTouchFlight(const SpaceRobot& robot, const SpaceTouch& touch, const SpaceWorld& world,
                                   const SpacePoint& base)
    : robot_(robot),
      touch_(touch),
      world_(world),
      base_(rest_at(base)),
      contact_(contact_of(touch, world)),
      course_(touch, robot.mass_kg(), stiffness_1_s2(robot.controller.law, touch.normal), 1 / robot.controller.rate_hz),
      force_(touch, 1 / robot.controller.rate_hz),
      depth_m_(-touch.standoff_m) {}

SpacePoint SpaceTouchFlight::reference() const {
    SpacePoint point = base_;
    for (int axis = 0; axis < 3; ++axis) {
        const double normal = touch_.normal[static_cast<std::size_t>(axis)];
        point.position[axis] -= course_.ahead_m() * normal;
        point.velocity[axis] = -course_.along_m_s() * normal;
    }
    return point;
}

void SpaceTouchFlight::saw(const dynamics::SpaceContactRecord& seen, const SpaceMotion& motion, double end_s,
                           double energy_j) {
    depth_m_ = seen.depth_m;
    const bool is_holding = course_.is_holding();
    force_.saw(seen.normal_impulse_n_s, seen.depth_m, end_s, energy_j, is_holding);
    if (is_holding) {
        const SpacePose pose{motion.position_m, motion.attitude, motion.joints_rad};
        const Vector3 place_m = among_obstacles(middle_of(touch_, robot_, pose), world_);
        held_m_ = held_m_.value_or(place_m);
        slip_m_ = std::max(slip_m_, length_across(place_m - *held_m_, touch_.normal));
    }
    course_.next(seen.normal_impulse_n_s * robot_.controller.rate_hz);
}

SpacePose SpaceTouchFlight::off_surface(SpacePose pose) const {
    constexpr double air_m = 5e-4;
    pose.position_m = pose.position_m + std::max(0.0, depth_m_ + air_m) * touch_.normal;
    return pose;
}

SpaceTouchRecord SpaceTouchFlight::record(bool is_at_end) const {
    SpaceTouchRecord record;
    static_cast<TouchRecord&>(record) = force_.record(is_at_end);
    record.place_m = held_m_.value_or(Vector3{});
    record.slip_m = slip_m_;
    record.end = end_of(record, is_at_end);
    record.is_met = record.end == SpaceTouchEnd::met;
    return record;
}

SpaceTouchEnd SpaceTouchFlight::end_of(const SpaceTouchRecord& record, bool is_at_end) const {
    if (!is_at_end) {
        return is_too_deep() ? SpaceTouchEnd::too_deep : SpaceTouchEnd::cut_short;
    }
    if (course_.is_stuck() || depth_m_ >= 0) {
        return SpaceTouchEnd::stuck;
    }
    if (record.touched_s == 0) {
        return SpaceTouchEnd::missed;
    }
    if (touch_.wanted_m && held_m_ && length_across(*held_m_ - *touch_.wanted_m, touch_.normal) > touch_.tolerance_m) {
        return SpaceTouchEnd::wrong_place;
    }
    if (slip_m_ > touch_.tolerance_m) {
        return SpaceTouchEnd::slipped;
    }
    return record.is_met ? SpaceTouchEnd::met : SpaceTouchEnd::wrong_force;
}

}  // namespace simulation
}  // namespace downwash
