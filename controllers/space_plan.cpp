#include <algorithm>

#include "downwash/controllers/space_reference.hpp"
#include "downwash/controllers/space_segment.hpp"

namespace downwash {

SpacePoint SpacePlan::at(std::int64_t tick) const {
    const auto next = std::upper_bound(reference.begin(), reference.end(), tick,
                                       [](std::int64_t at, const SpaceKnot& knot) { return at < knot.tick; });
    if (next == reference.begin() || next == reference.end()) {
        return next == reference.begin() ? reference.front().point : reference.back().point;
    }
    const auto knot = static_cast<std::size_t>(next - reference.begin());
    return segment_to(knot).at_tick(tick - reference[knot - 1].tick);
}

SpacePoint SpacePlan::at_time(double t_s) const {
    const auto begin_s = [this](const SpaceKnot& knot) { return static_cast<double>(knot.tick) * tick_s; };
    const auto next = std::upper_bound(reference.begin() + 1, reference.end(), t_s,
                                       [&](double at, const SpaceKnot& knot) { return at < begin_s(knot); });
    if (next == reference.end()) {
        return rest_at(reference.back().point);
    }
    const auto knot = static_cast<std::size_t>(next - reference.begin());
    const SpaceSegment segment = segment_to(knot);
    return segment.at((t_s - begin_s(reference[knot - 1])) * segment.inverse_duration_1_s());
}

SpaceSegment SpacePlan::segment_to(std::size_t knot) const {
    const SpaceKnot& from = reference[knot - 1];
    const SpaceKnot& to = reference[knot];
    return {from.point, to.point, to.tick - from.tick, tick_s};
}

std::vector<SpaceSegment> SpacePlan::segments() const {
    std::vector<SpaceSegment> segments;
    segments.reserve(reference.size());
    for (std::size_t knot = 1; knot < reference.size(); ++knot) {
        segments.push_back(segment_to(knot));
    }
    return segments;
}

SpacePlan SpacePlan::rest_after(std::int64_t tick) const {
    SpacePlan rest{{{0, at(tick)}}, tick_s, joints};
    for (const SpaceKnot& knot : reference) {
        if (knot.tick > tick) {
            rest.reference.push_back({knot.tick - tick, knot.point});
        }
    }
    return rest;
}

SpacePlan SpacePlan::beginning(std::int64_t ticks) const {
    SpacePlan part{{}, tick_s, joints};
    for (const SpaceKnot& knot : reference) {
        if (knot.tick < ticks) {
            part.reference.push_back(knot);
        }
    }
    part.reference.push_back({ticks, at(ticks)});
    return part;
}

SpacePlan SpacePlan::divided(std::int64_t max_ticks) const {
    SpacePlan parts{{reference.front()}, tick_s, joints};
    for (std::size_t knot = 1; knot < reference.size(); ++knot) {
        const SpaceSegment segment = segment_to(knot);
        const std::int64_t begin = reference[knot - 1].tick;
        for (std::int64_t tick = max_ticks; tick < segment.ticks(); tick += max_ticks) {
            parts.reference.push_back({begin + tick, segment.at_tick(tick)});
        }
        parts.reference.push_back(reference[knot]);
    }
    return parts;
}

SpacePlan SpacePlan::followed_by(const SpacePlan& next) const {
    if (reference.empty()) {
        return next;
    }
    SpacePlan whole = *this;
    const std::int64_t begin = reference.back().tick;
    for (std::size_t i = 1; i < next.reference.size(); ++i) {
        whole.reference.push_back({begin + next.reference[i].tick, next.reference[i].point});
    }
    return whole;
}

SpacePlan SpacePlan::held_for(std::int64_t ticks) const {
    SpacePlan held = *this;
    held.reference.push_back({reference.back().tick + ticks, reference.back().point});
    return held;
}

}  // namespace downwash
