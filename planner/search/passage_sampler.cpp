#include "downwash/search/passage_sampler.hpp"

#include <cmath>
#include <numbers>

#include "downwash/base/lane_math.hpp"

namespace downwash::planning {
namespace {

constexpr int tries = 8;
constexpr int tries_for_a_bridge = 60;
constexpr int other_sides = 8;  ///< that are tried from one side
constexpr int tries_over_a_bridge = 20;
constexpr std::size_t max_known = 64;
constexpr double known_share = 0.7;       ///< share of the samples, once a way is known
constexpr double new_bridge_share = 0.5;  ///< share of the others, once a bridge is known
// How far beside a known way: of its place, and shares of the limits of speed and force.
constexpr double shift_m = 0.05;
constexpr double speed_change = 0.1;
constexpr double force_change = 0.1;
constexpr double spread_rad = 0.5;  ///< spread of the velocity about the direction through a passage
constexpr double run_ups_s[] = {0.3, 0.45, 0.6, 0.8, 1.1, 1.5};

std::size_t index_below(std::size_t count, Random& random) {
    return static_cast<std::size_t>(random.uniform(0, static_cast<double>(count)));
}

}  // namespace

Passage reversed(const Passage& passage) {
    Passage back{passage.run_out, passage.through, passage.run_up};
    for (double& speed : back.through.velocity) {
        speed = -speed;
    }
    return back;
}

PassageSampler::PassageSampler(const SearchTask& task)
    : space_(task.space),
      limits_(task.problem.motion),
      tick_s_(task.model.tick().tick_s),
      bridge_m_(2 * task.model.collisions().body_reach_m()) {}

double PassageSampler::tilt(const ReferencePoint& point) const {
    return limits_.max_thrust_ratio ? pitch_along(point) : 0;
}

bool PassageSampler::collides(const Configuration& at, double pitch_rad) const {
    return space_.rejection_at(at, pitch_rad) == Rejection::collision;
}

std::optional<PassageSampler::Bridge> PassageSampler::found(Random& random) const {
    // Tilted in any direction in which a multirotor can be flown.
    const double pitch_rad = limits_.max_thrust_ratio ? random.uniform(-0.95, 0.95) * unstable_pitch_rad : 0;
    for (int i = 0; i < tries_for_a_bridge; ++i) {
        const Configuration one_side = space_.sample(random);
        if (!collides(one_side, pitch_rad)) {
            continue;
        }
        for (int other = 0; other < other_sides; ++other) {
            const double across_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
            const double length_m = random.uniform(0, bridge_m_);
            const auto across = lane::sin_cos(across_rad);
            Configuration other_side = one_side;
            other_side[plane::x] += length_m * across.cosine;
            other_side[plane::z] += length_m * across.sine;
            const Configuration middle = between(one_side, other_side, 0.5);
            if (space_.rejection_at(middle, pitch_rad) == Rejection::none && collides(other_side, pitch_rad)) {
                return Bridge{middle, across_rad, pitch_rad};
            }
        }
    }
    return std::nullopt;
}

PassageSampler::Through PassageSampler::through(const Bridge& bridge, Random& random) const {
    ReferencePoint point = at_rest(bridge.middle);
    if (limits_.max_thrust_ratio) {
        const double force_m_s2 = random.uniform(0.1, 1) * *limits_.max_thrust_ratio * standard_gravity_m_s2;
        const auto direction = lane::sin_cos(bridge.pitch_rad);
        point.acceleration[plane::x] = force_m_s2 * direction.sine;
        point.acceleration[plane::z] = force_m_s2 * direction.cosine - standard_gravity_m_s2;
    }
    const double turned_rad = 0.5 * std::numbers::pi + random.uniform(-spread_rad, spread_rad);
    const auto direction = lane::sin_cos(bridge.across_rad + turned_rad);
    const double speed_m_s = random.uniform(0, limits_.max_speed_m_s);
    point.velocity[plane::x] = speed_m_s * direction.cosine;
    point.velocity[plane::z] = speed_m_s * direction.sine;
    const auto across = lane::sin_cos(bridge.across_rad);
    return {point, {-across.sine, across.cosine}};
}

PassageSampler::Through PassageSampler::beside_known(Random& random) const {
    Through through = known_[index_below(known_.size(), random)];
    ReferencePoint& point = through.point;
    const double force_m_s2 = force_change * limits_.max_thrust_ratio.value_or(0) * standard_gravity_m_s2;
    for (const std::size_t axis : space_.translations()) {
        point.position[axis] += shift_m * random.uniform(-1, 1);
        point.velocity[axis] += speed_change * limits_.max_speed_m_s * random.uniform(-1, 1);
        point.acceleration[axis] += force_m_s2 * random.uniform(-1, 1);
    }
    return through;
}

bool PassageSampler::is_free(const ReferenceSegment& segment) const {
    constexpr std::int64_t ticks_between_poses = 3;
    const auto is_free_at = [&](const ReferencePoint& point) {
        return space_.rejection_at(configuration_of(point), tilt(point)) == Rejection::none;
    };
    // The same poses forwards and backwards.
    for (std::int64_t tick = 0; 2 * tick <= segment.ticks(); tick += ticks_between_poses) {
        if (!is_free_at(segment.at_tick(tick)) || !is_free_at(segment.at_tick(segment.ticks() - tick))) {
            return false;
        }
    }
    return true;
}

bool PassageSampler::leads(const ReferencePoint& from, const ReferencePoint& to) const {
    const ReferenceSegment fastest(from, to, shortest_ticks(from, to, limits_, tick_s_), tick_s_);
    return is_free(fastest) && keeps_limits(fastest, limits_);
}

std::optional<ReferencePoint> PassageSampler::rest_beside(const Through& through, double side) const {
    const ReferencePoint& point = through.point;
    for (const double time_s : run_ups_s) {
        const auto ticks = static_cast<std::int64_t>(std::ceil(time_s / tick_s_));
        const double t = static_cast<double>(ticks) * tick_s_;
        ReferencePoint rest = at_rest(configuration_of(point));
        double ahead_m = 0;
        for (const std::size_t axis : space_.translations()) {
            // The way of the cubic of speed between both ends, which has the least jerk.
            const double step_m = side * point.velocity[axis] * t / 2 + point.acceleration[axis] * t * t / 12;
            rest.position[axis] += step_m;
            ahead_m += step_m * through.along[axis];
        }
        if (!(side * ahead_m > 0) || space_.rejection_at(configuration_of(rest)) != Rejection::none) {
            continue;
        }
        const ReferencePoint& from = side < 0 ? rest : point;
        const ReferencePoint& to = side < 0 ? point : rest;
        const ReferenceSegment segment(from, to, ticks, tick_s_);
        // The tree takes the fastest one, which may lead elsewhere.
        if (keeps_limits(segment, limits_) && is_free(segment) && leads(from, to)) {
            return rest;
        }
    }
    return std::nullopt;
}

std::optional<PassageSampler::FoundPassage> PassageSampler::passage_through(const Through& through) const {
    const ReferencePoint& point = through.point;
    if (!keeps_limits(point, limits_) || space_.rejection_at(configuration_of(point), tilt(point)) != Rejection::none) {
        return std::nullopt;
    }
    const std::optional<ReferencePoint> run_up = rest_beside(through, -1);
    const std::optional<ReferencePoint> run_out = run_up ? rest_beside(through, 1) : std::nullopt;
    if (!run_out || leads(*run_up, *run_out)) {
        return std::nullopt;
    }
    return FoundPassage{through, {*run_up, point, *run_out}};
}

std::optional<PassageSampler::FoundPassage> PassageSampler::passage_beside_known(Random& random) const {
    return passage_through(beside_known(random));
}

std::optional<PassageSampler::FoundPassage> PassageSampler::passage_over_bridge(Random& random) {
    if (bridges_.empty() || random.chance(new_bridge_share)) {
        const std::optional<Bridge> bridge = found(random);
        if (!bridge) {
            return std::nullopt;
        }
        if (bridges_.size() == max_known) {
            bridges_.erase(bridges_.begin());
        }
        bridges_.push_back(*bridge);
    }
    const Bridge& bridge = bridges_[index_below(bridges_.size(), random)];
    for (int i = 0; i < tries_over_a_bridge; ++i) {
        if (const std::optional<FoundPassage> way = passage_through(through(bridge, random))) {
            return way;
        }
    }
    return std::nullopt;
}

std::optional<Passage> PassageSampler::sample(Random& random, const std::function<bool(const Passage&)>& is_wanted) {
    for (int i = 0; i < tries; ++i) {
        const bool is_beside_known = !known_.empty() && random.chance(known_share);
        const std::optional<FoundPassage> way =
            is_beside_known ? passage_beside_known(random) : passage_over_bridge(random);
        if (!way || !is_wanted(way->passage)) {
            continue;
        }
        if (!is_beside_known && known_.size() < max_known) {
            known_.push_back(way->through);
        }
        return way->passage;
    }
    return std::nullopt;
}

}  // namespace downwash::planning
