// Direct evaluation in scenes of so many parts that discs are averaged over rows (Footprints::few_parts). The oracle is
// the evaluation part by part: in a scene of those parts alone that are near a hub, which are few.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "../support/meshes.hpp"
#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/aeromap/row_average.hpp"
#include "downwash/base/parallel.hpp"
#include "scenes.hpp"

using namespace downwash;
using test::effect_of;

namespace {

constexpr double radius = 0.2;
constexpr std::size_t few_parts = 2048;
/// What direct_effect.hpp allows an average over rows.
constexpr double rows_error = 1e-3;

/// A sheet over [-half, half]^2 with heights between 0 and `bumps_m`.
Mesh sheet(test::Random& random, std::uint32_t cells, double half_m, double bumps_m) {
    std::vector<Vector3> vertices;
    for (std::uint32_t j = 0; j <= cells; ++j) {
        for (std::uint32_t i = 0; i <= cells; ++i) {
            const auto at = [&](std::uint32_t k) { return half_m * (2.0 * k / cells - 1); };
            vertices.push_back({at(i), at(j), bumps_m > 0 ? random.uniform(0, bumps_m) : 0});
        }
    }
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t j = 0; j < cells; ++j) {
        for (std::uint32_t i = 0; i < cells; ++i) {
            const std::uint32_t a = j * (cells + 1) + i;
            const std::uint32_t d = a + cells + 1;
            triangles.push_back({a, a + 1, d + 1});
            triangles.push_back({a, d + 1, d});
        }
    }
    return test::mesh_of(std::move(vertices), std::move(triangles));
}

/// What is over or under a disc.
constexpr double disc_reach = 1.01 * radius;

bool is_near(const BoundingBox& box, const Vector3& hub_m, double reach) {
    return box.low_m[0] < hub_m[0] + reach && box.high_m[0] > hub_m[0] - reach && box.low_m[1] < hub_m[1] + reach &&
           box.high_m[1] > hub_m[1] - reach;
}

/// The triangles of a mesh over and under a hub.
Mesh near_part(const Mesh& mesh, const Vector3& hub_m, double reach = disc_reach) {
    return test::edited(mesh, [&](TriangleMesh& surface) {
        std::erase_if(surface.triangles, [&](const std::array<std::uint32_t, 3>& triangle) {
            BoundingBox box = BoundingBox::around(surface.vertices_m[triangle[0]], surface.vertices_m[triangle[1]]);
            box.include({surface.vertices_m[triangle[2]], surface.vertices_m[triangle[2]]});
            return !is_near(box, hub_m, reach);
        });
    });
}

/// Obstacles over and under a hub.
std::vector<Obstacle> near_part(const std::vector<Obstacle>& all, const std::vector<BoundingBox>& bounds,
                                const Vector3& hub_m) {
    std::vector<Obstacle> near;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (is_near(bounds[i], hub_m, disc_reach)) {
            near.push_back(all[i]);
        }
    }
    return near;
}

std::vector<BoundingBox> bounds_of(const DirectEffect& effect) {
    std::vector<BoundingBox> bounds;
    for (std::size_t i = 0; i < effect.scene().obstacles().size(); ++i) {
        bounds.push_back(effect.scene().bounds(i));
    }
    return bounds;
}

double difference(const DirectEffect::Factors& a, const DirectEffect::Factors& b) {
    return std::max(std::abs(a.ground - b.ground), std::abs(a.ceiling - b.ceiling));
}

/// Obstacles of one kind at random over a field, of which some are over any place.
template <class Make>
std::vector<Obstacle> field_of(test::Random& random, int count, double half_m, const Make& make) {
    std::vector<Obstacle> all;
    for (int i = 0; i < count; ++i) {
        const Vector3 center = test::any_point(random, {half_m, half_m, 0.6});
        all.push_back(make(random, center));
    }
    return all;
}

Obstacle level_box(test::Random& random, const Vector3& center_m) {
    return {"",
            Box{{random.uniform(0.05, 0.4), random.uniform(0.05, 0.4), random.uniform(0.02, 0.3)}},
            center_m,
            {0, 0, random.uniform(-3, 3)}};
}

Obstacle girder(test::Random& random, const Vector3& center_m) {
    return {"",
            Box{{random.uniform(0.5, 1.5), random.uniform(0.03, 0.1), random.uniform(0.03, 0.2)}},
            center_m,
            {random.uniform(-0.1, 0.1), random.uniform(-0.3, 0.3), random.uniform(-3, 3)}};
}

Obstacle some_pipe(test::Random& random, const Vector3& center_m) {
    return {"",
            Cylinder{random.uniform(0.02, 0.1), random.uniform(0.3, 1.5), {random.uniform(-1, 1), 1, 0}},
            center_m,
            {0, random.integer(0, 1) == 0 ? 0 : random.uniform(-0.5, 0.5), random.uniform(-3, 3)}};
}

Obstacle any(test::Random& random, const Vector3& center_m) {
    const int kind = random.integer(0, 3);
    return kind == 0   ? Obstacle{"", Sphere{random.uniform(0.03, 0.15)}, center_m, {}}
           : kind == 1 ? some_pipe(random, center_m)
           : kind == 2 ? girder(random, center_m)
                       : level_box(random, center_m);
}

/// The worst and the mean difference from the evaluation part by part, over flyable hubs that feel something.
struct Compared {
    double worst = 0, sum = 0;
    int count = 0;
    void add(double value) {
        worst = std::max(worst, value);
        sum += value;
        ++count;
    }
    [[nodiscard]] double mean() const { return sum / count; }
};

template <class Make>
Compared compared(std::uint64_t seed, int obstacle_count, double half_m, int hubs, const Make& make) {
    test::Random random(seed);
    const std::vector<Obstacle> all = field_of(random, obstacle_count, half_m, make);
    const DirectEffect effect = effect_of(all);
    REQUIRE(effect.scene().part_count() > few_parts);
    const std::vector<BoundingBox> bounds = bounds_of(effect);
    Compared result;
    while (result.count < hubs) {
        const Vector3 hub = test::any_point(random, {0.8 * half_m, 0.8 * half_m, 0.9});
        const DirectEffect::Factors factors = effect.factors(hub);
        if (factors.total > 1.01 && effect.is_flyable(hub)) {
            const DirectEffect alone = effect_of(near_part(all, bounds, hub));
            REQUIRE(alone.scene().part_count() <= few_parts);
            result.add(difference(factors, alone.factors(hub)));
        }
    }
    return result;
}

}  // namespace

TEST_CASE("Over a level deck of a thousand triangles or of a hundred thousand K is that of a slab") {
    test::Random random(11);
    for (const std::uint32_t cells : {40U, 224U}) {
        const DirectEffect deck = effect_of({{"", sheet(random, cells, 3, 0), {}, {0, 0, 0.1}}});
        REQUIRE(deck.scene().part_count() > few_parts);
        const DirectEffect slab = effect_of({{"", Box{{6, 6, 1}}, {0, 0, -0.5}, {0, 0, 0.1}}});
        double worst_inside = 0;
        double worst_at_edge = 0;
        for (int i = 0; i < 2000; ++i) {
            const bool is_at_edge = i % 2 == 0;
            const Vector3 hub{is_at_edge ? 3 + random.uniform(-0.3, 0.3) : random.uniform(-2.3, 2.3),
                              random.uniform(-2.3, 2.3), random.uniform(0.3, 6) * radius};
            double& worst = is_at_edge ? worst_at_edge : worst_inside;
            worst = std::max(worst, difference(deck.factors(hub), slab.factors(hub)));
        }
        CAPTURE(cells);
        CHECK(worst_inside < 1e-9);
        CHECK(worst_at_edge < rows_error);
    }
}

TEST_CASE("Whatever the direction of an edge and wherever it crosses the disc, rows are within their bound") {
    test::Random random(13);
    const EffectCurve curve(EffectModel::cheeseman_bennett, 2);
    const CurveMean mean(curve);
    double worst = 0;
    int by_rows = 0;
    for (int i = 0; i < 2000; ++i) {
        const double angle = random.uniform(-1.6, 1.6);
        const Vector3 across{std::sin(angle), -std::cos(angle), 0};
        std::vector<Obstacle> obstacles{{"", Box{{6, 6, 1}}, {3 * across[0], 3 * across[1], -0.5}, {0, 0, angle}}};
        if (i % 3 == 0) {
            obstacles.push_back({"",
                                 Box{{0.3, 0.2, 1}},
                                 {random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), -random.uniform(0.5, 0.6)},
                                 {0, 0, random.uniform(-3, 3)}});
        }
        const DirectEffect exact = effect_of(obstacles);  // level faces: closed forms
        const RowColumns columns(exact.scene(), radius);
        const double beside = random.uniform(-1.1, 1.1) * radius;
        const double along = random.uniform(-2, 2);
        const Vector3 hub{-beside * across[0] - along * across[1], -beside * across[1] + along * across[0],
                          random.uniform(0.31, 0.8) * radius};
        const DiscQuery query{exact.scene(), hub, radius, Side::below, curve, radius, &mean};
        if (const auto average = row_average(query, columns)) {
            worst = std::max(worst, std::abs(*average - exact.factors(hub).ground));
            ++by_rows;
        }
    }
    CHECK(worst < rows_error);
    CHECK(by_rows > 1700);
}

TEST_CASE("Over and under a rough deck K agrees with the evaluation triangle by triangle and with counted rays") {
    test::Random random(12);
    for (const double bumps_m : {0.05, 0.3}) {
        for (const std::uint32_t cells : {40U, 90U}) {
            const Mesh mesh = sheet(random, cells, 3, bumps_m);
            const DirectEffect deck = effect_of({{"", mesh, {}, {}}});
            REQUIRE(deck.scene().part_count() > few_parts);
            Compared with_triangles;
            Compared with_rays;
            while (with_triangles.count < 36) {
                const bool is_below = random.integer(0, 1) == 0;
                Vector3 hub{random.uniform(-2.5, 2.5), random.uniform(-2.5, 2.5), random.uniform(0.06, 0.6)};
                hub[2] = is_below ? -hub[2] : bumps_m + hub[2];
                hub[2] += random.integer(0, 1) * (is_below ? 0.5 : -0.5) * bumps_m;  // among the bumps
                if (!deck.is_flyable(hub)) {
                    continue;
                }
                const DirectEffect near = effect_of({{"", near_part(mesh, hub), {}, {}}});
                REQUIRE(near.scene().part_count() <= few_parts);
                const DirectEffect::Factors factors = deck.factors(hub);
                with_triangles.add(difference(factors, near.factors(hub)));
                if (with_triangles.count % 6 == 0) {
                    with_rays.add(difference(factors, test::by_rays(near, hub, 400)));
                }
            }
            CAPTURE(bumps_m, cells, with_triangles.mean(), with_rays.mean());
            CHECK(with_rays.worst < rows_error);
            CHECK(with_triangles.worst < 5e-3);  // the other evaluation's own error
            CHECK(with_triangles.mean() < rows_error);
        }
    }
}

TEST_CASE("Among thousands of boxes, girders, pipes and balls K agrees with the evaluation of the near ones alone") {
    const Compared boxes = compared(21, 3000, 4.5, 600, level_box);  // few at a place: exact part by part
    CAPTURE(boxes.mean());
    CHECK(boxes.worst < rows_error);
    const Compared girders = compared(22, 2100, 4, 150, girder);
    CAPTURE(girders.mean());
    CHECK(girders.worst < rows_error + 2e-3);
    const Compared pipes = compared(23, 2100, 4, 150, some_pipe);
    CAPTURE(pipes.mean());
    CHECK(pipes.worst < rows_error + 2e-3);
    const Compared mixed = compared(24, 2500, 4, 150, any);
    CAPTURE(mixed.mean());
    CHECK(mixed.worst < rows_error + 2e-3);
    CHECK(std::max({girders.mean(), pipes.mean(), mixed.mean()}) < 0.5 * rows_error);
}

TEST_CASE("Where a rotor touches one of many parts the parts are taken one by one") {
    test::Random random(25);
    const std::vector<Obstacle> all = field_of(random, 3000, 3, level_box);
    const DirectEffect effect = effect_of(all);
    const std::vector<BoundingBox> bounds = bounds_of(effect);
    int touching = 0;
    for (int i = 0; i < 300; ++i) {
        const Vector3 hub = test::any_point(random, {2.5, 2.5, 0.6});
        if (!effect.is_flyable(hub)) {
            // Both within 5e-3, which is allowed with more than 24 parts.
            REQUIRE(difference(effect.factors(hub), effect_of(near_part(all, bounds, hub)).factors(hub)) < 1e-2);
            ++touching;
        }
    }
    CHECK(touching > 50);
}

TEST_CASE("Of many parts K is the same to the bit in any order of asking and on any number of threads") {
    test::Random random(26);
    const std::vector<Obstacle> all{{"", sheet(random, 90, 3, 0.2), {}, {}},
                                    {"", Cylinder{0.05, 4, {1, 0.3, 0}}, {0, 0, 0.5}, {}}};
    const auto effect = [&] { return effect_of(all); };
    std::vector<Vector3> hubs(6000);
    std::generate(hubs.begin(), hubs.end(), [&] {
        return Vector3{random.uniform(-3.2, 3.2), random.uniform(-3.2, 3.2), random.uniform(-0.5, 1)};
    });
    const auto factors_of = [&](const DirectEffect& asked, int threads, bool is_backwards) {
        std::vector<double> factors(hubs.size());
        run_parallel(hubs.size(), threads, [&](std::size_t i) {
            const std::size_t k = is_backwards ? hubs.size() - 1 - i : i;
            factors[k] = asked.factor(hubs[k]);
        });
        return factors;
    };
    const DirectEffect shared = effect();
    const std::vector<double> at_first = factors_of(shared, 4, false);
    CHECK(*std::max_element(at_first.begin(), at_first.end()) > 1.1);
    CHECK(factors_of(shared, 1, true) == at_first);
    CHECK(factors_of(effect(), 1, true) == at_first);
    CHECK(factors_of(effect(), 3, false) == at_first);
}

TEST_CASE("However few rows are kept, K is the same, and the memory keeps its bound") {
    test::Random random(30);
    const auto scene = test::scene_of({{"", sheet(random, 90, 3, 0.2), {}, {}}});
    const EffectCurve curve(EffectModel::sanchez_cuevas, 2);
    constexpr std::size_t little = std::size_t{16} << 20U;
    const RowColumns many(*scene, radius);
    const RowColumns few(*scene, radius, little);
    std::size_t most_bytes = 0;
    for (int i = 0; i < 3000; ++i) {
        const Vector3 hub{random.uniform(-2.9, 2.9), random.uniform(-2.9, 2.9), -random.uniform(0.07, 1)};
        const DiscQuery query{*scene, hub, radius, Side::above, curve, radius, nullptr};
        REQUIRE(row_average(query, few) == row_average(query, many));
        most_bytes = std::max(most_bytes, few.bytes());
    }
    CHECK(many.bytes() > 2 * little);  // so that much was dropped
    CHECK(most_bytes < 2 * little);
}

TEST_CASE("Of many parts K moves without jumps, so that steps of an integrator converge") {
    test::Random random(27);
    const DirectEffect deck = effect_of({{"", sheet(random, 60, 3, 0.3), {}, {}}});
    constexpr double step_m = 1e-5;
    for (int path = 0; path < 40; ++path) {
        const double angle = random.uniform(-3, 3);
        Vector3 hub{random.uniform(-2, 2), random.uniform(-2, 2), -random.uniform(0.1, 0.4)};
        double last = deck.factor(hub);
        double last_change = 0;
        int jumps = 0;
        for (int i = 0; i < 400; ++i) {
            hub[0] += step_m * std::cos(angle);
            hub[1] += step_m * std::sin(angle);
            const double here = deck.factor(hub);
            const double change = here - last;
            if (i > 0) {
                jumps += std::abs(change - last_change) > 1e-7;
            }
            last = here;
            last_change = change;
        }
        CAPTURE(path, hub);
        REQUIRE(jumps == 0);
    }
}

TEST_CASE("Of many parts those that are not over or under the disc change nothing") {
    test::Random random(28);
    const std::vector<Obstacle> all = field_of(random, 6000, 4, level_box);
    const DirectEffect effect = effect_of(all);
    const std::vector<BoundingBox> bounds = bounds_of(effect);
    std::vector<Obstacle> half;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (bounds[i].low_m[0] < 0.5) {
            half.push_back(all[i]);
        }
    }
    REQUIRE(half.size() > few_parts);
    const DirectEffect left = effect_of(half);
    for (int i = 0; i < 500; ++i) {
        const Vector3 hub{random.uniform(-3, 0.29), random.uniform(-3, 3), random.uniform(-0.8, 0.8)};
        REQUIRE(difference(effect.factors(hub), left.factors(hub)) == 0);
    }
}

TEST_CASE("Many parts are felt by models that see a rotor's neighbours, and across a cap of ten") {
    test::Random random(29);
    const Mesh mesh = sheet(random, 40, 3, 0.1);
    AeroSettings images;
    images.ground = EffectModel::multirotor_images;
    AeroSettings wide;
    wide.max_factor = 10;
    wide.min_distance_radii = 0.1;
    for (const AeroSettings& settings : {images, wide}) {
        const bool is_wide = settings.max_factor > 2;
        const auto effect = [&](const Mesh& surface) {
            return DirectEffect(test::scene_of({{"", surface, {}, {}}}), settings, radius,
                                is_wide ? RotorNeighbours{} : square_quadrotor(2.6));
        };
        const DirectEffect deck = effect(mesh);
        Compared result;
        while (result.count < 40) {
            const Vector3 hub{random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(0.05, 0.6)};
            if (deck.is_flyable(hub)) {
                // The discs of the neighbours are up to four radii away.
                const DirectEffect near = effect(near_part(mesh, hub, is_wide ? disc_reach : 5 * radius));
                REQUIRE(near.scene().part_count() <= few_parts);
                result.add(difference(deck.factors(hub), near.factors(hub)));
            }
        }
        CAPTURE(is_wide, result.mean());
        CHECK(result.worst < (is_wide ? 9 : 1) * (5e-3 + rows_error));
        CHECK(result.mean() < (is_wide ? 9 : 1) * rows_error);
    }
}
