#include "downwash/controllers/space_segment.hpp"

#include <cassert>

#include "downwash/controllers/quintic.hpp"

namespace downwash {

SpaceSegment::SpaceSegment(const SpacePoint& from, const SpacePoint& to, std::int64_t ticks, double tick_s) noexcept
    : from_(from),
      to_(to),
      ticks_(ticks),
      tick_s_(tick_s),
      duration_s_(static_cast<double>(ticks) * tick_s),
      inverse_duration_1_s_(1 / duration_s_) {
    assert(ticks >= 1 && tick_s > 0);
    for (int axis = 0; axis < space_axes<max_joints>; ++axis) {
        controllers::quintic_between<double>({from.position[axis], from.velocity[axis], from.acceleration[axis]},
                                             {to.position[axis], to.velocity[axis], to.acceleration[axis]}, duration_s_,
                                             coefficient_[axis]);
    }
}

SpacePoint SpaceSegment::at_tick(std::int64_t tick) const noexcept {
    if (tick <= 0) {
        return from_;
    }
    if (tick >= ticks_) {
        return to_;
    }
    return at(static_cast<double>(tick) * tick_s_ * inverse_duration_1_s_);
}

SpacePoint SpaceSegment::at(double s) const noexcept {
    SpacePoint point;
    for (int axis = 0; axis < space_axes<max_joints>; ++axis) {
        const auto at = controllers::quintic_at(coefficient_[axis], s, inverse_duration_1_s_);
        point.position[axis] = at.position;
        point.velocity[axis] = at.velocity;
        point.acceleration[axis] = at.acceleration;
    }
    return point;
}

}  // namespace downwash
