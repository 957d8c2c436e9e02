#include "downwash/simulation/space_arm_angles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "downwash/base/direction.hpp"
#include "downwash/base/lane_math.hpp"

namespace downwash {
namespace {

constexpr double full_turn_rad = 2 * std::numbers::pi;
/// Vectors of length 1 that are nearer to each other are the same.
constexpr double rounding = 1e-12;
constexpr Vector3 up{0, 0, 1};

/// Rodrigues.
Vector3 turned_about(const Vector3& axis, double angle_rad, const Vector3& v) {
    const auto [sine, cosine] = lane::sin_cos(angle_rad);
    return cosine * v + sine * cross(axis, v) + ((1 - cosine) * dot(axis, v)) * axis;
}

/// u . R(axis, q) v as q grows.
JointWave wave_of(const Vector3& u, const Vector3& axis, const Vector3& v) {
    const double along = dot(axis, v);
    const double a = dot(u, axis) * along;
    return {a, dot(u, v) - a, dot(u, cross(axis, v))};
}

/// The angle whose cosine is x; beyond [-1, 1] that of the nearer end.
double arc_cosine(double x) {
    const double inside = std::clamp(x, -1.0, 1.0);
    return lane::atan2(lane::sqrt((1 - inside) * (1 + inside)), inside);
}

double elevation_of(const Vector3& v) {
    return lane::atan2(v[2], lane::sqrt(v[0] * v[0] + v[1] * v[1]));
}

/// The turns by whole circles that bring a range into another one.
void add_within(AngleRanges& found, const AngleRange& one, const AngleRange& range) {
    for (double turns = std::ceil((range.low_rad - one.high_rad) / full_turn_rad - rounding);
         one.low_rad + turns * full_turn_rad <= range.high_rad + rounding && found.count < AngleRanges::most; ++turns) {
        const double low = std::clamp(one.low_rad + turns * full_turn_rad, range.low_rad, range.high_rad);
        const double high = std::clamp(one.high_rad + turns * full_turn_rad, range.low_rad, range.high_rad);
        found.all[found.count++] = {low, high};
    }
}

}  // namespace

std::optional<double> AngleRanges::drawn(Random& random) const {
    if (count == 0) {
        return std::nullopt;
    }
    double sum_rad = 0;
    for (std::size_t i = 0; i < count; ++i) {
        sum_rad += all[i].high_rad - all[i].low_rad;
    }
    if (sum_rad <= 0) {
        return all[random.index(count)].low_rad;
    }
    double rest_rad = random.uniform(0, sum_rad);
    for (std::size_t i = 0; i < count; ++i) {
        const double width_rad = all[i].high_rad - all[i].low_rad;
        if (rest_rad < width_rad) {
            return all[i].low_rad + rest_rad;
        }
        rest_rad -= width_rad;
    }
    return all[count - 1].high_rad;
}

std::optional<double> AngleRanges::nearest(double to_rad) const {
    std::optional<double> best;
    for (std::size_t i = 0; i < count; ++i) {
        const double angle_rad = std::clamp(to_rad, all[i].low_rad, all[i].high_rad);
        if (!best || std::abs(angle_rad - to_rad) < std::abs(*best - to_rad)) {
            best = angle_rad;
        }
    }
    return best;
}

AngleRanges JointWave::within(double least, double most, const AngleRange& range) const {
    AngleRanges found;
    const double size = lane::sqrt(b * b + c * c);
    if (size <= rounding) {
        if (a >= least - rounding && a <= most + rounding) {
            found.all[found.count++] = range;
        }
        return found;
    }
    // Beside the peak by an angle of which the cosine lies between these two. Where rounding puts the peak itself just
    // short of them, it is taken: what it comes to is checked by those who ask.
    constexpr double short_of = 1e-9;
    const double low = (least - a) / size, high = (most - a) / size;
    if (low > 1 + short_of || high < -1 - short_of) {
        return found;
    }
    const double peak_rad = lane::atan2(c, b);
    const double near_rad = arc_cosine(high), far_rad = arc_cosine(low);
    add_within(found, {peak_rad + near_rad, peak_rad + far_rad}, range);
    add_within(found, {peak_rad - far_rad, peak_rad - near_rad}, range);
    return found;
}

double JointWave::nearest_to(double wanted, const AngleRange& range) const {
    const auto off = [&](double angle_rad) {
        const auto [sine, cosine] = lane::sin_cos(angle_rad);
        return std::abs(a + b * cosine + c * sine - wanted);
    };
    double best = range.low_rad;
    const auto consider = [&](double angle_rad) {
        if (off(angle_rad) < off(best)) {
            best = angle_rad;
        }
    };
    consider(range.high_rad);
    const double size = lane::sqrt(b * b + c * c);
    if (size > rounding) {
        const double peak_rad = lane::atan2(c, b), beside_rad = arc_cosine((wanted - a) / size);
        AngleRanges peaks;
        add_within(peaks, {peak_rad + beside_rad, peak_rad + beside_rad}, range);
        add_within(peaks, {peak_rad - beside_rad, peak_rad - beside_rad}, range);
        for (std::size_t i = 0; i < peaks.count; ++i) {
            consider(peaks.all[i].low_rad);
        }
    }
    return best;
}

SpaceArmAngles::SpaceArmAngles(const SpaceRobot& robot)
    : joints_(robot.plant.links.size()), end_m_(robot.plant.end_effector_m), tool_(unit(robot.tool_direction)) {
    for (std::size_t i = 0; i < joints_; ++i) {
        axis_[i] = unit(robot.plant.links[i].axis);
        joint_m_[i] = robot.plant.links[i].joint_m;
        const SpaceLinkLimits& limits = robot.links[i];
        is_limited_[i] = limits.is_limited;
        range_[i] = limits.is_limited ? AngleRange{limits.lower_limit_rad, limits.upper_limit_rad}
                                      : AngleRange{-std::numbers::pi, std::numbers::pi};
    }
}

AngleRange SpaceArmAngles::range_about(std::size_t joint, double angle_rad) const noexcept {
    return is_limited_[joint] ? range_[joint] : AngleRange{angle_rad - std::numbers::pi, angle_rad + std::numbers::pi};
}

Vector3 SpaceArmAngles::outward(const JointAngles& at, Vector3 v, std::size_t first, std::size_t last) const noexcept {
    for (std::size_t i = last; i-- > first;) {
        v = turned_about(axis_[i], at[i], v);
    }
    return v;
}

Vector3 SpaceArmAngles::inward(const JointAngles& at, Vector3 v, std::size_t first, std::size_t last) const noexcept {
    for (std::size_t i = first; i < last; ++i) {
        v = turned_about(axis_[i], -at[i], v);
    }
    return v;
}

Vector3 SpaceArmAngles::outward(const JointAngles& at, const Vector3& of_hand) const noexcept {
    return outward(at, of_hand, 0, joints_);
}

Vector3 SpaceArmAngles::inward(const JointAngles& at, const Vector3& of_body) const noexcept {
    return inward(at, of_body, 0, joints_);
}

Vector3 SpaceArmAngles::end_effector_m(const JointAngles& at) const noexcept {
    Vector3 p_m = end_m_;
    for (std::size_t i = joints_; i-- > 0;) {
        p_m = joint_m_[i] + turned_about(axis_[i], at[i], p_m);
    }
    return p_m;
}

double SpaceArmAngles::elevation_rad(const JointAngles& at, const Vector3& of_hand) const noexcept {
    return elevation_of(outward(at, of_hand));
}

JointWave SpaceArmAngles::upright(const JointAngles& at, std::size_t joint, const Vector3& of_hand) const noexcept {
    return wave_of(inward(at, up, 0, joint), axis_[joint], outward(at, of_hand, joint + 1, joints_));
}

JointAngles SpaceArmAngles::drawn(Random& random) const {
    JointAngles at{};
    for (std::size_t i = 0; i < joints_; ++i) {
        at[i] = random.uniform(range_[i].low_rad, range_[i].high_rad);
    }
    return at;
}

bool SpaceArmAngles::has(const JointAngles& at, const Vector3& of_hand, const AngleRange& elevation) const {
    const double is_rad = elevation_rad(at, of_hand);
    return is_rad >= elevation.low_rad - rounding && is_rad <= elevation.high_rad + rounding;
}

std::optional<JointAngles> SpaceArmAngles::mended(JointAngles at, std::size_t joint, const Vector3& of_hand,
                                                  const AngleRange& elevation) const {
    // Near the vertical the upright part alone says little about the angle: Newton's steps on the elevation.
    for (int step = 0; step < 3; ++step) {
        const Vector3 v = outward(at, of_hand);
        const double is_rad = elevation_of(v);
        const double off_rad = is_rad - std::clamp(is_rad, elevation.low_rad, elevation.high_rad);
        if (off_rad == 0) {
            return at;
        }
        const JointWave wave = upright(at, joint, of_hand);
        const auto [sine, cosine] = lane::sin_cos(at[joint]);
        const double level = lane::sqrt(v[0] * v[0] + v[1] * v[1]);
        const double slope = (wave.c * cosine - wave.b * sine) / level;
        constexpr double least_slope = 0.01;
        if (!(std::abs(slope) >= least_slope)) {
            break;
        }
        const AngleRange range = range_about(joint, at[joint]);
        JointAngles better = at;
        better[joint] = std::clamp(at[joint] - off_rad / slope, range.low_rad, range.high_rad);
        const double now_rad = elevation_rad(better, of_hand);
        if (!(std::abs(now_rad - std::clamp(now_rad, elevation.low_rad, elevation.high_rad)) < std::abs(off_rad))) {
            break;
        }
        at = better;
    }
    return has(at, of_hand, elevation) ? std::optional(at) : std::nullopt;
}

std::optional<JointAngles> SpaceArmAngles::turned(const JointAngles& from, std::size_t joint, const Vector3& of_hand,
                                                  const AngleRange& elevation) const {
    const double least = lane::sin_cos(elevation.low_rad).sine, most = lane::sin_cos(elevation.high_rad).sine;
    const std::optional<double> angle_rad =
        upright(from, joint, of_hand).within(least, most, range_about(joint, from[joint])).nearest(from[joint]);
    if (!angle_rad) {
        return std::nullopt;
    }
    JointAngles at = from;
    at[joint] = *angle_rad;
    return mended(at, joint, of_hand, elevation);
}

std::optional<JointAngles> SpaceArmAngles::turned_in_turn(const JointAngles& from, std::size_t first,
                                                          const Vector3& of_hand, const AngleRange& elevation) const {
    JointAngles at = from;
    for (std::size_t i = 0; i < joints_; ++i) {
        const std::size_t joint = (first + i) % joints_;
        if (const std::optional<JointAngles> found = turned(at, joint, of_hand, elevation)) {
            return found;
        }
        const double now_rad = elevation_rad(at, of_hand);
        const double wanted_rad = std::clamp(now_rad, elevation.low_rad, elevation.high_rad);
        at[joint] =
            upright(at, joint, of_hand).nearest_to(lane::sin_cos(wanted_rad).sine, range_about(joint, at[joint]));
    }
    return std::nullopt;
}

template <class Choose>
std::optional<JointAngles> SpaceArmAngles::solved(JointAngles at, std::size_t inner, std::size_t outer,
                                                  const Vector3& up_in_hand, const Choose& choose) const {
    // Paden and Kahan's second subproblem with turns between both axes: R_o v, seen from the inner joint, has to lie on
    // the circle of u about the inner axis.
    const Vector3 u = inward(at, up, 0, inner);
    const Vector3 v = outward(at, up_in_hand, outer + 1, joints_);
    const Vector3 axis_in_outer = inward(at, axis_[inner], inner + 1, outer);
    const double along = dot(axis_[inner], u);
    const JointWave wave = wave_of(axis_in_outer, axis_[outer], v);
    const std::optional<double> outer_rad = choose(wave.within(along, along, range_about(outer, at[outer])), at[outer]);
    if (!outer_rad) {
        return std::nullopt;
    }
    at[outer] = *outer_rad;
    const Vector3 w = outward(at, turned_about(axis_[outer], at[outer], v), inner + 1, outer);
    const double beside = dot(w, u) - along * dot(axis_[inner], w);
    const double across = dot(axis_[inner], cross(w, u));
    const AngleRange range = range_about(inner, at[inner]);
    AngleRanges ranges;
    if (lane::sqrt(beside * beside + across * across) <= rounding) {
        ranges.all[ranges.count++] = range;
    } else {
        const double angle_rad = lane::atan2(across, beside);
        add_within(ranges, {angle_rad, angle_rad}, range);
    }
    const std::optional<double> inner_rad = choose(ranges, at[inner]);
    if (!inner_rad) {
        return std::nullopt;
    }
    at[inner] = *inner_rad;
    const Vector3 off = inward(at, up) - up_in_hand;
    return dot(off, off) <= rounding * rounding ? std::optional(at) : std::nullopt;
}

std::optional<JointAngles> SpaceArmAngles::turned(const JointAngles& from, std::size_t inner, std::size_t outer,
                                                  const Vector3& up_in_hand) const {
    // Each of up to two angles of the outer joint, in and beyond the nearer turn.
    std::optional<JointAngles> best;
    double best_way_rad = HUGE_VAL;
    for (std::size_t number = 0; number < AngleRanges::most; ++number) {
        bool is_outer = true, is_there = false;
        const std::optional<JointAngles> one =
            solved(from, inner, outer, up_in_hand, [&](const AngleRanges& ranges, double before_rad) {
                if (!is_outer) {
                    return ranges.nearest(before_rad);
                }
                is_outer = false;
                is_there = number < ranges.count;
                return is_there ? std::optional(
                                      std::clamp(before_rad, ranges.all[number].low_rad, ranges.all[number].high_rad))
                                : std::nullopt;
            });
        if (!is_there) {
            break;
        }
        if (one) {
            const double way_rad =
                std::max(std::abs((*one)[inner] - from[inner]), std::abs((*one)[outer] - from[outer]));
            if (way_rad < best_way_rad) {
                best = one;
                best_way_rad = way_rad;
            }
        }
    }
    return best;
}

std::optional<JointAngles> SpaceArmAngles::drawn_with(const Vector3& of_hand, const AngleRange& elevation,
                                                      Random& random) const {
    JointAngles at = drawn(random);
    if (joints_ == 0) {
        return has(at, of_hand, elevation) ? std::optional(at) : std::nullopt;
    }
    // Where few of all angles will do: first each joint as near to the elevation as it gets.
    constexpr double approaches = 0.25;
    if (random.chance(approaches)) {
        const double wanted = lane::sin_cos(random.uniform(elevation.low_rad, elevation.high_rad)).sine;
        const std::size_t first = random.index(joints_);
        for (std::size_t i = 0; i < joints_; ++i) {
            const std::size_t joint = (first + i) % joints_;
            at[joint] = upright(at, joint, of_hand).nearest_to(wanted, range_[joint]);
        }
    }
    if (joints_ == 1 || random.chance(0.5)) {
        const std::size_t joint = random.index(joints_);
        const double least = lane::sin_cos(elevation.low_rad).sine, most = lane::sin_cos(elevation.high_rad).sine;
        const std::optional<double> angle_rad =
            upright(at, joint, of_hand).within(least, most, range_[joint]).drawn(random);
        if (!angle_rad) {
            return std::nullopt;
        }
        at[joint] = *angle_rad;
        return mended(at, joint, of_hand, elevation);
    }
    // The vertical anywhere on the circle about the vector from which that has its elevation.
    std::size_t inner = random.index(joints_), outer = random.index(joints_ - 1);
    outer += outer >= inner ? 1 : 0;
    if (inner > outer) {
        std::swap(inner, outer);
    }
    for (const std::size_t joint : {inner, outer}) {
        at[joint] = is_limited_[joint] ? at[joint] : 0;  // about which its range is
    }
    const auto [sine, cosine] = lane::sin_cos(random.uniform(elevation.low_rad, elevation.high_rad));
    const auto [roll_sine, roll_cosine] = lane::sin_cos(random.uniform(-std::numbers::pi, std::numbers::pi));
    const Vector3 first = across(of_hand), second = cross(of_hand, first);
    const Vector3 up_in_hand = sine * of_hand + cosine * (roll_cosine * first + roll_sine * second);
    return solved(at, inner, outer, up_in_hand,
                  [&](const AngleRanges& ranges, double /*before*/) { return ranges.drawn(random); });
}

}  // namespace downwash
