// Whether a scene parts the plane of motion, against a search on a fine grid of places, pitches and arm angles.

#include <catch2/catch.hpp>
#include <memory>
#include <numbers>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "../support/meshes.hpp"
#include "downwash/scene/parted_plane.hpp"
#include "reference.hpp"

using namespace downwash;

namespace {

constexpr Bounds bounds{-3, 3, 0.5, 4};

Obstacle box(const Vector3& size_m, const Vector3& center_m) {
    return {"", Box{size_m}, center_m, {}};
}

/// A flat box with a short arm.
RobotShape robot() {
    RobotShape shape;
    shape.bodies = {{Box{{0.5, 0.4, 0.24}}, {0.02, 0, -0.01}}};
    shape.arm_length_m = 0.3;
    shape.arm_radius_m = 0.02;
    return shape;
}

/// Everything to the right of an x.
MayBeIn beyond(double x_m) {
    return [x_m](const PlaneSquare& square) { return square.x_m + square.half_m >= x_m; };
}

std::vector<CutOffRegion> cut_off(const std::vector<Obstacle>& obstacles, const MayBeIn& region,
                                  const RobotShape& shape = robot()) {
    return cut_off_regions(Scene(obstacles), {}, shape, bounds, -2, 2, std::span(&region, 1));
}

/// The obstacles that part what is beyond x = 2 from the start; empty where nothing is proven.
std::vector<std::size_t> wall_in(const std::vector<Obstacle>& obstacles, const RobotShape& shape = robot()) {
    const std::vector<CutOffRegion> found = cut_off(obstacles, beyond(2), shape);
    return found.empty() ? std::vector<std::size_t>() : found.front().obstacles;
}

using Numbers = std::vector<std::size_t>;

/// Whether the vehicle fits at a place with one of some attitudes.
bool fits(const CollisionChecker& checker, double x_m, double z_m) {
    for (const double arm_rad : {0.0, 1.5, 3.1, -1.5}) {
        for (int i = 0; i < 8; ++i) {
            if (!checker.is_nearer_than({x_m, z_m, i * std::numbers::pi / 8, arm_rad}, 0)) {
                return true;
            }
        }
    }
    return false;
}

/// Whether ways along a grid lead from the start to what is beyond x = 2, at each centimetre of which the vehicle fits.
bool grid_leads_through(const std::vector<Obstacle>& obstacles) {
    constexpr int step = 5;  // cm
    const CollisionChecker checker(std::make_shared<const Scene>(obstacles), {}, robot());
    const auto fits_at = [&](int x_cm, int z_cm) { return fits(checker, 0.01 * x_cm, 0.01 * z_cm); };
    std::set<std::pair<int, int>> known{{-200, 200}};
    std::vector<std::pair<int, int>> open{{-200, 200}};
    while (!open.empty()) {
        const auto [x_cm, z_cm] = open.back();
        open.pop_back();
        if (x_cm >= 200) {
            return true;
        }
        for (const auto& [dx, dz] : {std::pair(0, 1), {0, -1}, {-1, 0}, {1, 0}}) {
            const std::pair next{x_cm + step * dx, z_cm + step * dz};
            bool is_open = next.first >= -300 && next.second >= 50 && next.second <= 400 && !known.contains(next);
            for (int i = 1; i <= step && is_open; ++i) {
                is_open = fits_at(x_cm + i * dx, z_cm + i * dz);
            }
            if (is_open) {
                known.insert(next);
                open.push_back(next);
            }
        }
    }
    return false;
}

}  // namespace

TEST_CASE("A wall across the bounds cuts off what is behind it, and is named alone") {
    const Obstacle wall = box({0.1, 2, 5}, {0, 0, 2});
    const Obstacle ground = box({20, 20, 1}, {0, 0, -0.1});
    const Obstacle aside = box({0.5, 0.5, 0.5}, {-1, 0, 3});
    CHECK(wall_in({ground, wall, aside}) == Numbers{1});
    CHECK(wall_in({}).empty());
    CHECK(wall_in({ground, aside}).empty());
    CHECK(cut_off({ground, wall}, beyond(-1)).empty());
    const Obstacle sheet{"", test::soup_of({{{{0, -2, -1}, {0, 2, -1}, {0, 0, 12}}}}), {}, {}};
    CHECK(wall_in({sheet}) == Numbers{0});
    const Obstacle mesh{"", test::box_mesh({0.5, 3, 6}), {0, 0, 2}, {}};
    CHECK(wall_in({mesh}) == Numbers{0});
    // Beside the plane, where half the width of the body reaches and where it does not.
    CHECK(wall_in({box({0.1, 2, 5}, {0, 1.19, 2})}) == Numbers{0});
    CHECK(wall_in({box({0.1, 2, 5}, {0, 1.21, 2})}).empty());
}

TEST_CASE("Only a gap that no pitch fits closes a wall, and all that it takes are named") {
    const auto with_gap = [](double gap_m) {
        return std::vector<Obstacle>{box({0.2, 2, 2}, {0, 0, 1.0}), box({0.2, 2, 4}, {0, 0, 4 + gap_m})};
    };
    CHECK(wall_in(with_gap(0.05)) == Numbers{0, 1});
    CHECK(wall_in(with_gap(0.3)).empty());  // the core fits
    CHECK(wall_in(with_gap(1.0)).empty());
    CHECK(wall_in({box({0.2, 2, 2.6}, {0, 0, 1.3}), box({0.2, 2, 2.6}, {0.1, 0, 3.4}), box({9, 9, 1}, {0, 0, -0.2})}) ==
          Numbers{0, 1});
    // Either of two walls closes the plane: one is enough.
    CHECK(wall_in({box({0.1, 2, 5}, {0, 0, 2}), box({0.1, 2, 5}, {1, 0, 2})}).size() == 1);
}

TEST_CASE("A body that does not contain its centre of mass proves nothing") {
    RobotShape shape = robot();
    shape.bodies = {{Box{{0.2, 0.4, 0.2}}, {0.3, 0, 0}}};
    CHECK(wall_in({box({0.1, 2, 5}, {0, 0, 2})}, shape).empty());
    shape.bodies = {{Cylinder{0.3, 0.2, {0, 0, 1}}, {0, 0, 0}}};
    CHECK(wall_in({box({0.1, 2, 5}, {0, 0, 2})}, shape) == Numbers{0});
    shape.bodies = {{Sphere{0.1}, {0, 0, 0.05}}};
    CHECK(wall_in({box({0.1, 2, 5}, {0, 0, 2})}, shape) == Numbers{0});
}

TEST_CASE("Nothing is cut off that a vehicle can reach") {
    reference::Dice dice(61);
    int proven = 0;
    int open = 0;
    for (int round = 0; round < 20; ++round) {
        CAPTURE(round);
        std::vector<Obstacle> obstacles;
        for (int i = 0; i < 5; ++i) {
            const Vector3 size{dice.between(0.05, 0.6), dice.between(0.1, 2), dice.between(0.5, 2)};
            Obstacle one = box(size, {dice.between(-0.35, 0.35), dice.between(-0.5, 0.5), 0.4 + 0.9 * i});
            one.rpy_rad = {0, dice.between(-0.4, 0.4), 0};
            obstacles.push_back(one);
        }
        const bool is_proven = !wall_in(obstacles).empty();
        const bool leads_through = grid_leads_through(obstacles);
        CHECK_FALSE((is_proven && leads_through));
        proven += is_proven ? 1 : 0;
        open += leads_through ? 1 : 0;
    }
    CHECK(proven > 2);
    CHECK(open > 2);
}

TEST_CASE("A wall up to the edge of the bounds closes the plane, and so does one that ends a little below") {
    constexpr Bounds wide{-14, 14, 0.5, 11};  // squares of 5.5 cm
    const MayBeIn region = beyond(2);
    const auto closes = [&](double top_m) {
        const std::vector<Obstacle> wall{box({1, 40, top_m}, {0, 0, 0.5 * top_m})};
        return !cut_off_regions(Scene(wall), {}, robot(), wide, -12, 3, std::span(&region, 1)).empty();
    };
    // The core reaches 0.105 m below a centre of mass, which may be 5 cm above the bounds.
    CHECK(closes(11.0));
    CHECK(closes(10.975));  // half a square more than these
    CHECK_FALSE(closes(10.94));
    CHECK_FALSE(closes(10.8));
}
