#include "downwash/judge/space_reference.hpp"

#include <algorithm>

#include "downwash/judge/reference.hpp"

namespace downwash::judge {

SpacePoint reference_at(const SpacePlan& plan, std::int64_t tick) {
    const auto after = std::upper_bound(plan.reference.begin(), plan.reference.end(), tick,
                                        [](std::int64_t t, const SpaceKnot& knot) { return t < knot.tick; });
    if (after == plan.reference.end() || after == plan.reference.begin()) {
        return after == plan.reference.begin() ? plan.reference.front().point : plan.reference.back().point;
    }
    const SpaceKnot& from = *(after - 1);
    const double ticks = static_cast<double>(after->tick - from.tick);
    SpacePoint point;
    for (int axis = 0; axis < space_axes<max_joints>; ++axis) {
        const auto course = [&](const SpacePoint& p) {
            return Course{p.position[axis], p.velocity[axis], p.acceleration[axis]};
        };
        const Course at = between(course(from.point), course(after->point), ticks * plan.tick_s,
                                  static_cast<double>(tick - from.tick) / ticks);
        point.position[axis] = at.position;
        point.velocity[axis] = at.velocity;
        point.acceleration[axis] = at.acceleration;
    }
    return point;
}

}  // namespace downwash::judge
