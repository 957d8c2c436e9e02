// The effect near triangle meshes and octrees: against the primitives they stand for, against counted rays, and what
// must not change it.

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "../support/hard_places.hpp"
#include "../support/meshes.hpp"
#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/scene/collision_checker.hpp"
#include "downwash/scene/mesh_file.hpp"
#include "scenes.hpp"

using namespace downwash;
using test::effect_of;
using test::scene_of;
using test::some_triangles;

namespace {

constexpr double radius = 0.2;

/// The largest difference of the two one-sided factors.
double difference(const DirectEffect::Factors& a, const DirectEffect::Factors& b) {
    return std::max(std::abs(a.ground - b.ground), std::abs(a.ceiling - b.ceiling));
}

Vector3 some_hub(test::Random& random) {
    return test::any_point(random, {0.6, 0.6, 0.8});
}

/// A box about as large as a rotor.
Obstacle some_box(test::Random& random, bool is_level) {
    const auto size = [&] { return random.uniform(0.1, 1); };
    const auto angle = [&] { return random.uniform(-3, 3); };
    const Vector3 rpy{is_level ? 0 : angle(), is_level ? 0 : angle(), angle()};
    return {"", Box{{size(), size(), size()}}, some_hub(random), rpy};
}

Obstacle as_mesh(const Obstacle& box) {
    Obstacle mesh = box;
    mesh.shape = test::box_mesh(std::get<Box>(box.shape).size_m);
    return mesh;
}

/// Draws hubs until `count` of them are flyable and feel something, and returns the largest difference of the two.
template <class Pair>
double worst_difference(int count, test::Random& random, const Pair& pair) {
    double worst = 0;
    while (count > 0) {
        const auto [one, other] = pair();
        for (int i = 0; i < 5 && count > 0; ++i) {
            const Vector3 hub = some_hub(random);
            const DirectEffect::Factors factors = one.factors(hub);
            if (one.is_flyable(hub) && factors.ground + factors.ceiling > 2.01) {
                worst = std::max(worst, difference(factors, other.factors(hub)));
                --count;
            }
        }
    }
    return worst;
}

}  // namespace

TEST_CASE("Boxes and a pipe of triangles are felt as the primitives that they stand for") {
    test::Random random(61);
    const double level_boxes = worst_difference(300, random, [&] {
        const Obstacle one = some_box(random, true);
        const Obstacle other = some_box(random, true);
        return std::pair(effect_of({one, other}), effect_of({as_mesh(one), as_mesh(other)}));
    });
    CHECK(level_boxes < 1e-9);
    // Within the errors of the two quadratures.
    const double tilted_box = worst_difference(300, random, [&] {
        const Obstacle box = some_box(random, false);
        return std::pair(effect_of({box}), effect_of({as_mesh(box)}));
    });
    CHECK(tilted_box < 4e-3);
    const Mesh fine = test::pipe_mesh(0.25, 10, 50, 100);
    REQUIRE(fine.surface->triangles.size() == 10100);
    const double pipe = worst_difference(60, random, [&] {
        const Vector3 rpy{random.uniform(-1.5, 1.5), 0, random.uniform(-3, 3)};
        return std::pair(effect_of({{"", Cylinder{0.25, 10, {0, 1, 0}}, {}, rpy}}), effect_of({{"", fine, {}, rpy}}));
    });
    CHECK(pipe < 5e-3);
}

TEST_CASE("Close to a pipe of triangles under a cap of ten the error grows no faster than what is at stake") {
    AeroSettings settings;
    settings.max_factor = 10;
    settings.min_distance_radii = 0;
    test::Random random(70);
    int strong = 0;
    for (int compared = 0; compared < 12;) {
        const Vector3 rpy{compared % 2 == 0 ? 0 : random.uniform(-1.5, 1.5), 0, random.uniform(-3, 3)};
        const DirectEffect effect = effect_of({{"", test::pipe_mesh(0.25, 3, 32, 6), {}, rpy}}, settings);
        const Vector3 hub = some_hub(random);
        const DirectEffect::Factors factors = effect.factors(hub);
        if (effect.is_flyable(hub) && factors.ground + factors.ceiling > 3) {
            CAPTURE(compared, factors.ground, factors.ceiling);
            REQUIRE(difference(factors, test::by_rays(effect, hub, 150)) < 9 * 5e-3);
            strong += std::max(factors.ground, factors.ceiling) > 4;
            ++compared;
        }
    }
    CHECK(strong > 3);
}

TEST_CASE("An octree of a box is felt ever more like the box as its cubes shrink") {
    const Vector3 size{0.5, 0.37, 0.23};
    const auto is_inside = [&](const Vector3& p) {
        return std::abs(p[0]) < 0.5 * size[0] && std::abs(p[1]) < 0.5 * size[1] && std::abs(p[2]) < 0.5 * size[2];
    };
    const Vector3 rpy{0, 0, 0.3};
    const DirectEffect box = effect_of({{"", Box{size}, {}, rpy}});
    double last = 1;
    for (const double side : {0.1, 0.025, 0.00625}) {
        const DirectEffect octree =
            effect_of({{"", test::octree_of(is_inside, {-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3}, side), {}, rpy}});
        test::Random random(64);
        double worst = 0;
        for (int i = 0; i < 500; ++i) {
            const Vector3 hub = some_hub(random);
            if (box.is_flyable(hub)) {
                worst = std::max(worst, difference(box.factors(hub), octree.factors(hub)));
            }
        }
        CAPTURE(side, worst, last);
        CHECK(worst < 0.6 * last);
        last = worst;
    }
    CHECK(last < 0.05);
}

TEST_CASE("An octree of a tilted block is felt as rays count it") {
    const auto is_inside = [](const Vector3& p) { return std::abs(p[0] + 0.3 * p[1]) + std::abs(p[2]) < 0.2; };
    const Octomap octree = test::octree_of(is_inside, {-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4}, 0.05);
    const DirectEffect effect = effect_of({{"", octree, {0, 0, -0.25}, {0.2, 0.3, 0.4}}});
    for (const Vector3& hub : {Vector3{0, 0, 0.1}, Vector3{0.1, -0.2, 0.1}, Vector3{-0.1, 0.3, 0.1}}) {
        const DirectEffect::Factors counted = test::by_rays(effect, hub, 300);
        REQUIRE(counted.ground > 1.01);
        CHECK(difference(effect.factors(hub), counted) < 5e-3);
    }
}

TEST_CASE("Of more boxes than it keeps, an effect tells several threads at once the same to the bit") {
    // A porous plate, no two boxes of which merge: more than the 16384 whose footprints are kept.
    const auto is_inside = [](const Vector3& p) {
        const auto cell = [](double x) { return static_cast<int>(std::floor(x / 0.05 + 1e-6)); };
        return (cell(p[0]) + cell(p[1])) % 2 == 0;
    };
    const std::vector<Obstacle> plate{{"", test::octree_of(is_inside, {-4.8, -4.8, -0.05}, {4.8, 4.8, 0}, 0.05)}};
    REQUIRE(scene_of(plate)->part_count() > 18000);
    constexpr double small_radius = 0.08;  // few boxes over the disc
    const auto effect = [&] { return DirectEffect(scene_of(plate), {}, small_radius); };
    test::Random random(66);
    std::vector<Vector3> hubs(10000);
    std::generate(hubs.begin(), hubs.end(), [&] {
        return Vector3{random.uniform(-4.8, 4.8), random.uniform(-4.8, 4.8), random.uniform(0.05, 0.3)};
    });
    const auto factors_of = [&](const DirectEffect& asked, int threads) {
        std::vector<double> factors(hubs.size());
        run_parallel(hubs.size(), threads, [&](std::size_t i) { factors[i] = asked.factor(hubs[i]); });
        return factors;
    };
    const DirectEffect shared = effect();
    const std::vector<double> at_first = factors_of(shared, 4);
    CHECK(*std::max_element(at_first.begin(), at_first.end()) > 1.05);
    CHECK(factors_of(shared, 1) == at_first);
    CHECK(factors_of(effect(), 1) == at_first);
}

TEST_CASE("Among many triangles at random the effect agrees with counted rays") {
    test::Random random(65);
    double worst = 0;
    int compared = 0;
    for (int round = 0; compared < 30; ++round) {
        const int count = round % 2 == 0 ? 15 : 150;
        const DirectEffect effect =
            effect_of({{"", test::stretched(some_triangles(random, count), {1, 1, 0.2}), {}, {}}});
        Vector3 hub = some_hub(random);
        hub[2] *= 0.5;
        const DirectEffect::Factors factors = effect.factors(hub);
        if (factors.total > 1.05 && effect.is_flyable(hub)) {
            worst = std::max(worst, difference(factors, test::by_rays(effect, hub, 200)));
            ++compared;
        }
    }
    CHECK(worst < 5e-3);
}

TEST_CASE("A mesh behind a mesh changes nothing") {
    test::Random random(66);
    const Obstacle deck{"", test::box_mesh({4, 4, 0.1}), {}, {}};
    for (int round = 0; round < 30; ++round) {
        Obstacle hidden{"", some_triangles(random, 5), {0, 0, -1.5}, {}};
        const DirectEffect alone = effect_of({deck});
        const DirectEffect both = effect_of({deck, hidden});
        Vector3 hub = some_hub(random);
        hub[2] = 0.05 + random.uniform(0.3, 3) * radius;
        REQUIRE(both.factors(hub).ground == Approx(alone.factors(hub).ground).epsilon(0).margin(2e-3));
        hidden.shape = some_triangles(random, 200);
        REQUIRE(effect_of({deck, hidden}).factors(hub).ground ==
                Approx(alone.factors(hub).ground).epsilon(0).margin(5e-3));
    }
}

TEST_CASE("Moving or mirroring scene and rotor together changes nothing") {
    test::Random random(67);
    for (const int count : {8, 100}) {
        const double allowed = 2 * (count == 8 ? 2e-3 : 5e-3);
        for (int round = 0; round < 40; ++round) {
            const Mesh mesh = some_triangles(random, count);
            const Vector3 hub = some_hub(random);
            const DirectEffect::Factors before = effect_of({{"", mesh, {}, {}}}).factors(hub);

            const double angle = random.uniform(-3, 3);
            const PlaneOfMotion motion({random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)}, angle);
            const DirectEffect moved = effect_of({{"", mesh, motion.origin_m(), {0, 0, angle}}});
            REQUIRE(difference(moved.factors(motion.to_world(hub[0], hub[1], hub[2])), before) < allowed);

            const DirectEffect reflection = effect_of({{"", test::stretched(mesh, {1, -1, 1}), {}, {}}});
            REQUIRE(difference(reflection.factors({hub[0], -hub[1], hub[2]}), before) < allowed);
        }
    }
}

TEST_CASE(
    "A deck with a doorway as two polygons is felt as the boxes that it stands for, whichever corner comes first") {
    const std::vector<std::pair<int, int>> outline{{-12, -4}, {12, -4}, {12, 4}, {3, 4},
                                                   {3, -2},   {-3, -2}, {-3, 4}, {-12, 4}};
    const DirectEffect boxes = effect_of({{"", Box{{9, 8, 0.4}}, {-7.5, 0, 5.2}, {}},
                                          {"", Box{{9, 8, 0.4}}, {7.5, 0, 5.2}, {}},
                                          {"", Box{{6, 2, 0.4}}, {0, -3, 5.2}, {}}});
    const auto ceiling = [](const DirectEffect& effect, double x_m, double y_m) {
        return effect.factors({x_m, y_m, 4.7}).ceiling;
    };
    REQUIRE(ceiling(boxes, 7, 0) > 1.04);
    for (std::size_t first = 0; first < outline.size(); ++first) {
        std::string text;
        for (const char* height : {" 5\n", " 5.4\n"}) {
            for (std::size_t i = 0; i < outline.size(); ++i) {
                const auto& [x, y] = outline[(first + i) % outline.size()];
                text += "v " + std::to_string(x) + " " + std::to_string(y) + height;
            }
        }
        text += "f 8 7 6 5 4 3 2 1\nf 9 10 11 12 13 14 15 16\n";
        for (int i = 1; i <= 8; ++i) {
            const int next = i % 8 + 1;
            for (const int corner : {i, next, next + 8, i + 8}) {
                text += (corner == i ? "f " : " ") + std::to_string(corner);
            }
            text += "\n";
        }
        const auto surface = std::make_shared<const TriangleMesh>(parse_mesh(text, "deck.obj"));
        const auto scene = scene_of({{"", Mesh{"", 1, surface}, {}, {}}});
        CHECK(scene->facts(0).solid_pieces == 1);
        const DirectEffect mesh = effect_of(scene->obstacles());
        CAPTURE(first);
        CHECK(ceiling(mesh, 0, 1) == Approx(1).margin(1e-4));
        for (int i = 0; i <= 20; ++i) {
            for (const double y_m : {-3., -1.9, 0., 3.9}) {
                CHECK(ceiling(mesh, -5 + 0.5 * i, y_m) == Approx(ceiling(boxes, -5 + 0.5 * i, y_m)).margin(5e-3));
            }
        }
    }
}

TEST_CASE("Decks with notches of any depth as two polygons are felt as the boxes side by side") {
    test::Random random(71);
    double worst = 0;
    int notched = 0;
    for (int round = 0; round < 12; ++round) {
        // Strips along y, from -4 m up to some height each; the polygon runs along their ends.
        std::vector<std::array<double, 2>> outline;
        std::vector<Obstacle> strips;
        double x = -3;
        for (int i = 0; i < 4; ++i) {
            const double next = x + random.uniform(0.5, 2);
            const double end = random.uniform(-1.5, 1.5);
            outline.push_back({x, end});
            outline.push_back({next, end});
            strips.push_back({"", Box{{next - x, end + 4, 0.3}}, {(x + next) / 2, (end - 4) / 2, 0.15}, {}});
            x = next;
        }
        outline.push_back({x, -4});
        outline.push_back({-3, -4});
        if (round % 2 == 0) {
            std::reverse(outline.begin(), outline.end());
        }
        std::rotate(outline.begin(), outline.begin() + random.integer(0, 9), outline.end());
        // Every third file has its y axis up.
        const bool is_y_up = round % 3 == 0;
        std::string text;
        std::string low = "f";
        std::string high = "f";
        const std::size_t count = outline.size();
        for (const double height : {0., 0.3}) {
            for (const auto& [px, py] : outline) {
                const Vector3 v = is_y_up ? Vector3{px, height, -py} : Vector3{px, py, height};
                text += "v " + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) + "\n";
            }
        }
        for (std::size_t i = 1; i <= count; ++i) {
            low += " " + std::to_string(i);
            high += " " + std::to_string(2 * count + 1 - i);
        }
        text += low + "\n" + high + "\n";
        for (std::size_t i = 1; i <= count; ++i) {
            const std::size_t next = i % count + 1;
            text += "f " + std::to_string(next) + " " + std::to_string(i) + " " + std::to_string(i + count) + " " +
                    std::to_string(next + count) + "\n";
        }
        const auto surface = std::make_shared<const TriangleMesh>(parse_mesh(text, "deck.obj"));
        const Vector3 rpy{is_y_up ? 1.5707963267948966 : 0, 0, 0};
        const auto scene = scene_of({{"", Mesh{"", 1, surface}, {}, rpy}});
        REQUIRE(scene->facts(0).solid_pieces == 1);
        const DirectEffect mesh = effect_of(scene->obstacles());
        const DirectEffect boxes = effect_of(strips);
        for (int i = 0; i < 40; ++i) {
            const Vector3 hub{random.uniform(-3, x), random.uniform(-2, 2), random.uniform(-0.5, -0.1)};
            const DirectEffect::Factors factors = boxes.factors(hub);
            worst = std::max(worst, difference(mesh.factors(hub), factors));
            notched += factors.ceiling < 1.001 ? 1 : 0;
        }
    }
    CHECK(worst < 5e-3);
    CHECK(notched > 40);
}

TEST_CASE("An opening within a deck that a bridge of its polygon joins to the edge is felt as the boxes around it") {
    test::Random random(72);
    double worst = 0;
    double least_under_deck = 10;
    for (int round = 0; round < 8; ++round) {
        const double x0 = random.uniform(-2, -1);
        const double x1 = random.uniform(1, 2);
        const double y0 = random.uniform(-1.5, -0.8);
        const double y1 = random.uniform(0.8, 1.5);
        std::string text;
        for (const char* height : {" 0\n", " 0.4\n"}) {
            for (const auto& [x, y] : {std::pair(-4., -3.), std::pair(4., -3.), std::pair(4., 3.), std::pair(-4., 3.),
                                       std::pair(x0, y0), std::pair(x0, y1), std::pair(x1, y1), std::pair(x1, y0)}) {
                text += "v " + std::to_string(x) + " " + std::to_string(y) + height;
            }
        }
        // Around the edge, over the bridge, around the opening the other way, and back.
        std::vector<int> outline{1, 2, 3, 4, 1, 5, 6, 7, 8, 5};
        std::rotate(outline.begin(), outline.begin() + random.integer(0, 9), outline.end());
        for (const int level : {8, 0}) {
            text += "f";
            for (const int corner : outline) {
                text += " " + std::to_string(corner + level);
            }
            text += "\n";
            std::reverse(outline.begin(), outline.end());
        }
        for (int i = 0; i < 8; ++i) {
            const int corner = i + 1;
            const int next = i / 4 * 4 + (i + 1) % 4 + 1;
            text += "f " + std::to_string(corner) + " " + std::to_string(next) + " " + std::to_string(next + 8) + " " +
                    std::to_string(corner + 8) + "\n";
        }
        const auto surface = std::make_shared<const TriangleMesh>(parse_mesh(text, "deck.obj"));
        const auto scene = scene_of({{"", Mesh{"", 1, surface}, {}, {}}});
        REQUIRE(scene->facts(0).solid_pieces == 1);
        REQUIRE(scene->facts(0).open_edges == 0);
        const DirectEffect mesh = effect_of(scene->obstacles());
        const DirectEffect boxes =
            effect_of({{"", Box{{x0 + 4, 6, 0.4}}, {(x0 - 4) / 2, 0, 0.2}, {}},
                       {"", Box{{4 - x1, 6, 0.4}}, {(x1 + 4) / 2, 0, 0.2}, {}},
                       {"", Box{{x1 - x0, y0 + 3, 0.4}}, {(x0 + x1) / 2, (y0 - 3) / 2, 0.2}, {}},
                       {"", Box{{x1 - x0, 3 - y1, 0.4}}, {(x0 + x1) / 2, (y1 + 3) / 2, 0.2}, {}}});
        CHECK(mesh.factors({0, 0, -0.2}).ceiling == Approx(1).margin(1e-4));
        least_under_deck = std::min(least_under_deck, mesh.factors({3, 0, -0.2}).ceiling);
        for (int i = 0; i < 40; ++i) {
            const Vector3 hub{random.uniform(-3, 3), random.uniform(-2, 2), random.uniform(-0.5, -0.1)};
            worst = std::max(worst, difference(mesh.factors(hub), boxes.factors(hub)));
        }
    }
    CHECK(worst < 5e-3);
    CHECK(least_under_deck > 1.04);
}

TEST_CASE("Rotors that may come as near as they like are forbidden where they would touch, and nowhere else") {
    AeroSettings settings;
    settings.min_distance_radii = 0;
    settings.ground = EffectModel::none;
    settings.ceiling = EffectModel::none;
    const auto scene = scene_of({{"pipe", test::pipe_mesh(0.25, 4, 16, 4), {-1, 0, 0}, {0.1, 0, 0.2}},
                                 {"box", Box{{0.4, 0.4, 0.4}}, {0.8, 0, 0.3}, {0, 0.4, 0}}});
    const auto effect = test::effect_in(scene->obstacles(), radius, settings);
    const AeroMap map(test::layers(effect, {0}), {}, {-1.6, 1.5, -0.4, 0.8});
    test::Random random(69);
    int forbidden = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vector3 hub_m{random.uniform(-1.6, 1.5), 0, random.uniform(-0.4, 0.8)};
        const double clearance_m = disc_clearance_m(*scene, hub_m, radius);
        if (clearance_m == 0 || clearance_m > 1e-5) {
            REQUIRE(effect->is_flyable(hub_m) == (clearance_m > 0));
        }
        REQUIRE(map.is_flyable(0, hub_m[0], hub_m[2]) == effect->is_flyable(hub_m));
        forbidden += effect->is_flyable(hub_m) ? 0 : 1;
    }
    CHECK(forbidden > 3000);
    CHECK(forbidden < 17000);
}
