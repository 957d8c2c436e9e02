#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <vector>

#include "../support/random.hpp"
#include "downwash/controllers/space_segment.hpp"
#include "downwash/controllers/yaw_mode.hpp"
#include "space_motion.hpp"

using namespace downwash;
using test::Random;

namespace {

constexpr double tick_s = 0.01;
constexpr double half_turn = 3.14159265358979323846;

double yaw_at(const SpaceKnot& knot) {
    return knot.point.position[space::yaw];
}

double yaw_rate_at(const SpaceKnot& knot) {
    return knot.point.velocity[space::yaw];
}

/// Knots at rest, a second apart.
std::vector<SpaceKnot> rest_at_corners(const std::vector<std::array<double, 3>>& corners, double yaw_rad) {
    std::vector<SpaceKnot> knots;
    for (const auto& corner : corners) {
        SpaceKnot& knot = knots.emplace_back();
        knot.tick = 100 * static_cast<std::int64_t>(knots.size() - 1);
        std::copy(corner.begin(), corner.end(), knot.point.position);
        knot.point.position[space::yaw] = yaw_rad;
    }
    return knots;
}

/// A level circle of radius 2 m around (1, -1), counterclockwise, one turn in 16 s, a knot every half second.
std::vector<SpaceKnot> circle() {
    constexpr double rate = 2 * half_turn / 16;
    std::vector<SpaceKnot> knots(33);
    for (std::size_t i = 0; i < knots.size(); ++i) {
        const double angle = rate * 0.5 * static_cast<double>(i);
        const double across[2] = {std::cos(angle), std::sin(angle)};
        const double along[2] = {-across[1], across[0]};
        knots[i].tick = 50 * static_cast<std::int64_t>(i);
        for (int axis = 0; axis < 2; ++axis) {
            knots[i].point.position[axis] = (axis == 0 ? 1 : -1) + 2 * across[axis];
            knots[i].point.velocity[axis] = 2 * rate * along[axis];
            knots[i].point.acceleration[axis] = -2 * rate * rate * across[axis];
        }
        knots[i].point.position[space::z] = 3;
    }
    return knots;
}

/// Nothing but the yaw of knots differs.
bool are_same_but_for_yaw(std::vector<SpaceKnot> a, const std::vector<SpaceKnot>& b) {
    bool are_same = a.size() == b.size();
    for (std::size_t i = 0; are_same && i < a.size(); ++i) {
        a[i].point.position[space::yaw] = b[i].point.position[space::yaw];
        a[i].point.velocity[space::yaw] = b[i].point.velocity[space::yaw];
        a[i].point.acceleration[space::yaw] = b[i].point.acceleration[space::yaw];
        are_same = a[i].tick == b[i].tick && a[i].point == b[i].point;
    }
    return are_same;
}

}  // namespace

TEST_CASE("Free yaw turns to what goals ask by the shorter way, unwrapped, and stays there") {
    const auto knots = rest_at_corners({{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {3, 0, 1}, {4, 0, 1}}, 3);
    const std::vector<std::optional<double>> asked{{}, {}, -3.0, 0.5, {}};
    const auto filled = with_yaw(knots, tick_s, {}, asked);
    CHECK(are_same_but_for_yaw(filled, knots));
    CHECK(filled[0].point == knots[0].point);
    CHECK(yaw_at(filled[2]) == Approx(2 * half_turn - 3));
    CHECK(yaw_at(filled[3]) == Approx(0.5));  // 2.78 rad back, not 3.5 on
    CHECK(yaw_at(filled[4]) == yaw_at(filled[3]));
    // On the way to the first goal the turn is one motion: half of it at the knot halfway.
    CHECK(yaw_at(filled[1]) == Approx(half_turn));
    CHECK(yaw_rate_at(filled[1]) == Approx(15.0 / 8 * (2 * half_turn - 6) / 2));
    for (const std::size_t at_rest : {2, 3, 4}) {
        CHECK(yaw_rate_at(filled[at_rest]) == 0);
        CHECK(filled[at_rest].point.acceleration[space::yaw] == 0);
    }
    // Half a turn goes left.
    CHECK(yaw_at(with_yaw({{0, {}}, {9, {}}}, tick_s, {}, std::vector<std::optional<double>>{{}, half_turn})[1]) > 0);
    CHECK(yaw_at(with_yaw({{0, {}}, {9, {}}}, tick_s, {}, std::vector<std::optional<double>>{{}, -half_turn})[1]) > 0);
}

TEST_CASE("Free yaw between goals is one quintic, however many knots lie on it, from a vehicle that turns already") {
    std::vector<SpaceKnot> knots{{0, {}}, {130, {}}, {170, {}}, {400, {}}};
    knots[0].point.velocity[space::yaw] = 0.4;
    knots[0].point.acceleration[space::yaw] = -0.1;
    const auto filled = with_yaw(knots, tick_s, {}, std::vector<std::optional<double>>{{}, {}, {}, 1.0});
    const SpaceSegment whole(filled[0].point, filled[3].point, 400, tick_s);
    const SpacePlan plan{filled, tick_s, 0};
    for (std::int64_t tick = 0; tick <= 400; tick += 10) {
        CHECK(plan.at(tick).position[space::yaw] == Approx(whole.at_tick(tick).position[space::yaw]).margin(1e-12));
    }
    // Without a goal it comes to rest where it was.
    const auto alone = with_yaw(knots, tick_s, {});
    CHECK(alone[0].point == knots[0].point);
    CHECK(yaw_at(alone[1]) == 0);
    CHECK(yaw_rate_at(alone[1]) == 0);
}

TEST_CASE("Held yaw stays, but for what goals ask") {
    const auto knots = circle();
    const auto held = with_yaw(knots, tick_s, {YawMode::hold, {}});
    CHECK(are_same_but_for_yaw(held, knots));
    CHECK(std::all_of(held.begin(), held.end(), [](const SpaceKnot& knot) { return yaw_at(knot) == 0; }));
    std::vector<std::optional<double>> asked(knots.size());
    asked[10] = 1;
    const auto filled = with_yaw(knots, tick_s, {YawMode::hold, {}}, asked);
    CHECK(yaw_at(filled[9]) == 0);
    CHECK(yaw_at(filled[10]) == 1);
    CHECK(yaw_at(filled[32]) == 1);
}

TEST_CASE("Yaw along the way follows the velocity, turn after turn") {
    auto knots = circle();
    const auto again = circle();
    for (std::size_t i = 1; i < again.size(); ++i) {  // twice around
        knots.push_back({1600 + again[i].tick, again[i].point});
    }
    knots[0].point.position[space::yaw] = half_turn / 2;
    knots[0].point.velocity[space::yaw] = half_turn / 8;
    const auto filled = with_yaw(knots, tick_s, {YawMode::along, {}});
    CHECK(are_same_but_for_yaw(filled, knots));
    const SpacePlan plan{filled, tick_s, 0};
    for (std::size_t i = 0; i < filled.size(); ++i) {
        CHECK(yaw_at(filled[i]) == Approx(half_turn / 2 + half_turn / 16 * static_cast<double>(i)));
        CHECK(yaw_rate_at(filled[i]) == Approx(half_turn / 8));
    }
    // Between the knots, too.
    for (std::int64_t tick = 0; tick < 3200; tick += 23) {
        const SpacePoint point = plan.at(tick);
        const double direction = std::atan2(point.velocity[1], point.velocity[0]);
        CHECK(std::abs(std::remainder(point.position[space::yaw] - direction, 2 * half_turn)) < 1e-3);
    }
}

TEST_CASE("Yaw along a way with stops is the direction from the knot before, and straight up it stays") {
    const auto knots = rest_at_corners({{0, 0, 1}, {1, 1, 1}, {1, 1, 3}, {0, 1, 3}, {0, 0, 3}, {0, 0, 3}}, 0);
    const auto filled = with_yaw(knots, tick_s, {YawMode::along, {}});
    const double expected[6] = {0, half_turn / 4, half_turn / 4, half_turn, 1.5 * half_turn, 1.5 * half_turn};
    for (std::size_t i = 0; i < 6; ++i) {
        CHECK(yaw_at(filled[i]) == Approx(expected[i]));
        CHECK(yaw_rate_at(filled[i]) == 0);
    }
    // What a goal asks comes before the direction.
    const auto asked =
        with_yaw(knots, tick_s, {YawMode::along, {}}, std::vector<std::optional<double>>{{}, {}, 0.1, {}, {}, {}});
    CHECK(yaw_at(asked[2]) == Approx(0.1));
    CHECK(yaw_at(asked[3]) == Approx(half_turn));
}

TEST_CASE("Yaw toward a point keeps looking at it, with its derivatives") {
    Random random(1);
    const std::array<double, 2> target_m{0.5, -0.7};
    for (int i = 0; i < 200; ++i) {
        // One quintic in x and y, cut at three places: yaw's derivatives are those of the direction along it.
        const SpacePoint from = test::random_space_point(random, 0, 2, 0.5, 0.3);
        const SpacePoint to = test::random_space_point(random, 0, 2, 0.5, 0.3);
        const SpaceSegment segment(from, to, 400, tick_s);
        const double s = random.uniform(0.1, 0.9);
        constexpr double h_s = 1e-3;
        const double h = h_s / segment.duration_s();
        double direction[3];
        double distance_m = 0;
        for (int k = 0; k < 3; ++k) {
            const SpacePoint point = segment.at(s + (k - 1) * h);
            const double d[2] = {target_m[0] - point.position[0], target_m[1] - point.position[1]};
            direction[k] = std::atan2(d[1], d[0]);
            distance_m = std::hypot(d[0], d[1]);
        }
        const auto filled = with_yaw({{0, from}, {100, segment.at(s)}}, tick_s, {YawMode::toward, target_m});
        CHECK(filled[0].point == from);
        const double before = std::remainder(direction[1] - direction[0], 2 * half_turn);
        const double after = std::remainder(direction[2] - direction[1], 2 * half_turn);
        CHECK(std::abs(std::remainder(yaw_at(filled[1]) - direction[1], 2 * half_turn)) < 1e-12);
        CHECK(std::abs(yaw_at(filled[1]) - yaw_at(filled[0])) <= half_turn);
        if (distance_m > 0.3) {
            CHECK(yaw_rate_at(filled[1]) == Approx((before + after) / (2 * h_s)).margin(1e-4));
            CHECK(filled[1].point.acceleration[space::yaw] == Approx((after - before) / (h_s * h_s)).margin(1e-3));
        }
    }
    // Around the target yaw turns as the vehicle goes around; above it, it stays.
    const auto around = with_yaw(circle(), tick_s, {YawMode::toward, {1, -1}});
    CHECK(yaw_at(around[32]) - yaw_at(around[1]) == Approx(2 * half_turn * 31 / 32));
    CHECK(yaw_rate_at(around[5]) == Approx(half_turn / 8));
    CHECK(around[5].point.acceleration[space::yaw] == Approx(0).margin(1e-12));
    const auto above = with_yaw(rest_at_corners({{0, 0, 1}, {2, 0, 1}}, 0.3), tick_s, {YawMode::toward, {2, 0}});
    CHECK(yaw_at(above[1]) == 0.3);
    CHECK(yaw_rate_at(above[1]) == 0);
}

TEST_CASE("Yaw is filled in no knot and in one") {
    for (const YawMode mode : {YawMode::free, YawMode::hold, YawMode::along, YawMode::toward}) {
        CHECK(with_yaw({}, tick_s, {mode, {}}).empty());
        SpacePoint point;
        point.position[space::yaw] = 7;
        CHECK(with_yaw({{0, point}}, tick_s, {mode, {}})[0].point == point);
    }
}
