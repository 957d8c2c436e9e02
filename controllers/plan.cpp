#include "downwash/controllers/plan.hpp"

#include <algorithm>

#include "downwash/controllers/quintic.hpp"

namespace downwash {

ReferencePoint Plan::at(std::int64_t tick) const {
    const auto next = std::upper_bound(reference.begin(), reference.end(), tick,
                                       [](std::int64_t at, const ReferenceKnot& knot) { return at < knot.tick; });
    if (next == reference.begin() || next == reference.end()) {
        return next == reference.begin() ? reference.front().point : reference.back().point;
    }
    const auto knot = static_cast<std::size_t>(next - reference.begin());
    return segment_to(knot).at_tick(tick - reference[knot - 1].tick);
}

ReferencePoint Plan::at_time(double t_s) const {
    const auto begin_s = [this](const ReferenceKnot& knot) { return static_cast<double>(knot.tick) * tick_s; };
    const auto next = std::upper_bound(reference.begin() + 1, reference.end(), t_s,
                                       [&](double at, const ReferenceKnot& knot) { return at < begin_s(knot); });
    if (next == reference.end()) {
        return at_rest(last());
    }
    const auto knot = static_cast<std::size_t>(next - reference.begin());
    const ReferenceSegment segment = segment_to(knot);
    const double s = (t_s - begin_s(reference[knot - 1])) * segment.inverse_duration_1_s();
    ReferencePoint point;
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
        const auto at = controllers::quintic_at(segment.coefficients()[axis], s, segment.inverse_duration_1_s());
        point.position[axis] = at.position;
        point.velocity[axis] = at.velocity;
        point.acceleration[axis] = at.acceleration;
    }
    return point;
}

ReferenceSegment Plan::segment_to(std::size_t knot) const {
    const ReferenceKnot& from = reference[knot - 1];
    const ReferenceKnot& to = reference[knot];
    return {from.point, to.point, to.tick - from.tick, tick_s};
}

std::vector<ReferenceSegment> Plan::segments() const {
    std::vector<ReferenceSegment> segments;
    segments.reserve(reference.size());
    for (std::size_t knot = 1; knot < reference.size(); ++knot) {
        segments.push_back(segment_to(knot));
    }
    return segments;
}

Plan Plan::rest_after(std::int64_t tick) const {
    Plan rest{{{0, at(tick)}}, tick_s, axes};
    for (const ReferenceKnot& knot : reference) {
        if (knot.tick > tick) {
            rest.reference.push_back({knot.tick - tick, knot.point});
        }
    }
    return rest;
}

Plan Plan::beginning(std::int64_t ticks) const {
    Plan part{{}, tick_s, axes};
    for (const ReferenceKnot& knot : reference) {
        if (knot.tick < ticks) {
            part.reference.push_back(knot);
        }
    }
    part.reference.push_back({ticks, at(ticks)});
    return part;
}

Plan Plan::divided(std::int64_t most_ticks) const {
    Plan parts{{reference.front()}, tick_s, axes};
    for (std::size_t knot = 1; knot < reference.size(); ++knot) {
        const ReferenceSegment segment = segment_to(knot);
        const std::int64_t begin = reference[knot - 1].tick;
        for (std::int64_t tick = most_ticks; tick < segment.ticks(); tick += most_ticks) {
            parts.reference.push_back({begin + tick, segment.at_tick(tick)});
        }
        parts.reference.push_back(reference[knot]);
    }
    return parts;
}

Plan Plan::followed_by(const Plan& next) const {
    if (reference.empty()) {
        return next;
    }
    Plan whole = *this;
    const std::int64_t begin = reference.back().tick;
    for (std::size_t i = 1; i < next.reference.size(); ++i) {
        whole.reference.push_back({begin + next.reference[i].tick, next.reference[i].point});
    }
    return whole;
}

Plan Plan::held_for(std::int64_t ticks) const {
    Plan held = *this;
    held.reference.push_back({reference.back().tick + ticks, reference.back().point});
    return held;
}

}  // namespace downwash
