// Octrees as obstacles, and the boxes that stand for their cubes.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "../support/error_of.hpp"
#include "../support/meshes.hpp"
#include "downwash/scene/octree_boxes.hpp"
#include "reference.hpp"

using namespace downwash;

namespace {

using Cubes = std::vector<OccupiedCube>;

/// Cubes of 0.25 m and 0.5 m on their grids, about half of the places taken.
OccupancyTree some_tree(reference::Dice& dice) {
    OccupancyTree tree{0.25, {}};
    for (int i = 0; i < 60; ++i) {
        const double side = dice.coin() ? 0.25 : 0.5;
        const auto place = [&] { return (std::floor(dice.between(-1, 1) / side) + 0.5) * side; };
        tree.cubes.push_back({{place(), place(), place()}, side});
    }
    return tree;
}

Octomap octomap_of(OccupancyTree tree) {
    return {"", std::make_shared<const OccupancyTree>(std::move(tree))};
}

/// Each cube as an obstacle of its own, placed as the octree is.
std::vector<Obstacle> cubes_of(const OccupancyTree& tree, const Obstacle& place) {
    const reference::Solid frame = reference::solid_of({"", Box{{1, 1, 1}}, {}, place.rpy_rad});
    std::vector<Obstacle> cubes;
    for (const OccupiedCube& cube : tree.cubes) {
        Obstacle one = place;
        one.shape = Box{{cube.side_m, cube.side_m, cube.side_m}};
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                one.center_world_m[k] += cube.center_local_m[axis] * frame.axes[axis][k];
            }
        }
        cubes.push_back(one);
    }
    return cubes;
}

bool is_in(const Vector3& p, const Vector3& center, const Vector3& size) {
    return std::abs(p[0] - center[0]) <= 0.5 * size[0] && std::abs(p[1] - center[1]) <= 0.5 * size[1] &&
           std::abs(p[2] - center[2]) <= 0.5 * size[2];
}

/// Where a vertical line leaves the scene at the top; far below where it meets nothing.
double highest_at(const Scene& scene, const Vector3& p) {
    double highest_m = -1e9;
    for (std::size_t part = 0; part < scene.part_count(); ++part) {
        highest_m = std::max(highest_m, scene.vertical_extent(part, p[0], p[1]).high);
    }
    return highest_m;
}

std::string refusal_of(const Octomap& octomap) {
    return test::error_of([&] { return Scene({{"", octomap, {}, {}}}); });
}

}  // namespace

TEST_CASE("Octrees that cannot stand in a scene are errors with their place") {
    using Catch::Matchers::Contains;
    CHECK(refusal_of(octomap_of({1, {{{0, 0, 0}, 1}}})) == "none");
    CHECK_THAT(refusal_of({}), Contains("obstacles[0].octomap.file: must have been read"));
    CHECK_THAT(refusal_of(octomap_of({1, {}})), Contains("obstacles[0].octomap.file: has no occupied cube"));
    for (const OccupiedCube& bad :
         {OccupiedCube{{0, std::nan(""), 0}, 1}, {{0, 0, 0}, 0}, {{0, 0, 0}, std::nan("")}, {{2e6, 0, 0}, 1}}) {
        CHECK_THAT(refusal_of(octomap_of({1, {bad}})), Contains("has a cube with a centre or side"));
    }
    CHECK_THAT(refusal_of(octomap_of({1, std::vector<OccupiedCube>(2'000'001, {{0, 0, 0}, 1})})),
               Contains("at most 2000000 are allowed"));
}

TEST_CASE("Cubes that fill a block become one box, twice the same cube is one") {
    const Octomap block = test::octree_of([](const Vector3&) { return true; }, {-1, 0.5, 2}, {1, 2, 3.5}, 0.25);
    REQUIRE(block.tree->cubes.size() == 8 * 6 * 6);
    std::vector<LocalBox> boxes = merged_boxes(block.tree->cubes);
    REQUIRE(boxes.size() == 1);
    CHECK(boxes[0].center_m == Vector3{0, 1.25, 2.75});
    CHECK(boxes[0].size_m == Vector3{2, 1.5, 1.5});
    CHECK(merged_boxes(Cubes{{{0.5, 0.5, 0.5}, 1}, {{0.5, 0.5, 0.5}, 1}}).size() == 1);
    CHECK(merged_boxes(Cubes{{{0.5, 0.5, 0.5}, 1}, {{1.6, 0.5, 0.5}, 1}}).size() == 2);
}

TEST_CASE("Boxes fill exactly what the cubes fill") {
    reference::Dice dice(41);
    for (int round = 0; round < 40; ++round) {
        const OccupancyTree tree = some_tree(dice);
        const std::vector<LocalBox> boxes = merged_boxes(tree.cubes);
        REQUIRE(boxes.size() <= tree.cubes.size());
        for (int i = 0; i < 2000; ++i) {
            const Vector3 p = dice.vector(-1.6, 1.6);
            const bool is_occupied = std::any_of(tree.cubes.begin(), tree.cubes.end(), [&](const OccupiedCube& cube) {
                return is_in(p, cube.center_local_m, {cube.side_m, cube.side_m, cube.side_m});
            });
            const bool is_filled = std::any_of(boxes.begin(), boxes.end(),
                                               [&](const LocalBox& box) { return is_in(p, box.center_m, box.size_m); });
            REQUIRE(is_occupied == is_filled);
        }
    }
}

TEST_CASE("An octree is as near as all of its cubes one by one") {
    reference::Dice dice(42);
    int contacts = 0;
    for (int round = 0; round < 60; ++round) {
        const OccupancyTree tree = some_tree(dice);
        const Obstacle octree{"", octomap_of(tree), dice.vector(-1, 1), dice.coin() ? Vector3{} : dice.vector(-4, 4)};
        const std::vector<Obstacle> cubes = cubes_of(tree, octree);
        CAPTURE(round);
        contacts += reference::contacts_of_equals({octree}, cubes, dice);
        const Scene scene({octree}), expected(cubes);
        for (int i = 0; i < 20; ++i) {
            const Vector3 p = dice.vector(-2, 2);
            REQUIRE(highest_at(scene, p) == reference::about(highest_at(expected, p)));
        }
    }
    CHECK(contacts < 1000);
}

TEST_CASE("Unseen space is solid where it counts as occupied, and a scene of its own where it is free") {
    OccupancyTree tree{0.5, {{{0.25, 0.25, 0.25}, 0.5}}, {{{2, 0, 1}, {1, 3, 2}}}, {}, 0.5, true};
    Octomap octomap = octomap_of(tree);
    const Obstacle ground{"ground", Box{{1, 1, 1}}, {0, 0, -9}, {}};
    const Scene free({ground, {"scan", octomap, {1, 0, 0}, {}}});
    octomap.unknown = UnknownSpace::occupied;
    const Scene filled({ground, {"scan", octomap, {1, 0, 0}, {}}});
    CHECK(free.part_count() == 2);
    CHECK(free.bounds(1).high_m[0] == 1.5);
    REQUIRE(filled.part_count() == 3);
    CHECK(filled.bounds(1).high_m[0] == 3.5);
    CHECK(filled.vertical_extent(2, 3, 0).high == 2);
    CHECK(filled.obstacle_of(0) == 0);
    CHECK(filled.obstacle_of(2) == 1);
    CHECK(filled.unseen_space() == nullptr);
    const std::shared_ptr<const Scene> unseen = free.unseen_space();
    REQUIRE(unseen != nullptr);
    CHECK(unseen->part_count() == 1);
    CHECK(unseen->bounds(0).low_m == Vector3{2.5, -1.5, 0});
    CHECK(unseen->bounds(0).high_m == Vector3{3.5, 1.5, 2});
    tree.has_free_leaf = false;  // then nobody knows what a sensor saw
    CHECK(Scene({{"", octomap_of(tree), {}, {}}}).unseen_space() == nullptr);
    octomap = octomap_of({0.5, tree.cubes, {}, {}, 0.5, true, false});
    octomap.unknown = UnknownSpace::occupied;
    CHECK_THAT(refusal_of(octomap), Catch::Contains("obstacles[0].octomap.unknown: is occupied, and the unseen space"));
}
