#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "../support/error_of.hpp"
#include "../support/polygons.hpp"
#include "../support/random.hpp"
#include "downwash/base/text.hpp"
#include "downwash/scene/mesh_file.hpp"
#include "downwash/scene/polygon_triangles.hpp"

using namespace downwash;
using test::is_inside;
using test::length;
using test::placed;
using test::Polygon;
using test::Random;
using test::some_polygon;
using test::started_at;
using test::twice_area;

namespace {

using Corners = std::array<Vector3, 3>;

std::vector<Corners> triangles_of(const Polygon& polygon) {
    const FaceCut cut = cut_face(polygon);
    REQUIRE(cut.fault == FaceFault::none);
    REQUIRE(cut.triangles.size() == polygon.size() - 2);
    std::vector<Corners> all;
    for (const auto& [a, b, c] : cut.triangles) {
        all.push_back({polygon[a], polygon[b], polygon[c]});
    }
    return all;
}

/// The triangles, whichever of them comes first and wherever each begins.
std::set<Corners> set_of(std::vector<Corners> triangles) {
    for (Corners& corners : triangles) {
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    }
    return {triangles.begin(), triangles.end()};
}

/// The sum of their areas, each of which has to lie on the side of the polygon's.
double area_of(const std::vector<Corners>& triangles, const Vector3& twice) {
    double sum = 0;
    const double size = length(twice);
    for (const Corners& t : triangles) {
        const Vector3 own = cross(t[1] - t[0], t[2] - t[0]);
        REQUIRE(dot(own, twice) >= -1e-12 * size * size);
        sum += length(own) / 2;
    }
    return sum;
}

std::string words(const Vector3& v) {
    return " " + to_text(v[0]) + " " + to_text(v[1]) + " " + to_text(v[2]) + "\n";
}

std::string obj_of(const Polygon& polygon) {
    std::string text = "# a face\n";
    std::string face = "f";
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        text += "v" + words(polygon[i]);
        face += " " + std::to_string(i + 1);
    }
    return text + face + "\n";
}

std::string said_of(const Polygon& polygon) {
    return test::error_of([&] { return parse_mesh(obj_of(polygon), "a.obj"); });
}

Polygon flat(const std::vector<std::array<double, 2>>& points) {
    Polygon all;
    for (const auto& [x, y] : points) {
        all.push_back({x, y, 0});
    }
    return all;
}

const Polygon doorway = flat({{-12, -4}, {12, -4}, {12, 4}, {3, 4}, {3, -2}, {-3, -2}, {-3, 4}, {-12, 4}});

}  // namespace

TEST_CASE("The triangles of any plane face fill it and nothing else, whichever corner comes first") {
    Random random(1);
    int concave = 0;
    for (int round = 0; round < 1000; ++round) {
        CAPTURE(round);
        const Polygon in_plane = some_polygon(random, random.integer(4, 30));
        const Vector3 rpy{random.uniform(-3, 3), random.uniform(-1.5, 1.5), random.uniform(-3, 3)};
        const Vector3 center{random.magnitude(-2, 2), random.magnitude(-2, 2), random.magnitude(-2, 2)};
        const double scale = std::abs(random.magnitude(-2, 2));
        const Polygon polygon = placed(in_plane, rpy, center, scale);
        const Vector3 twice = twice_area(polygon);
        const double area = length(twice) / 2;
        if (area < 1e-3 * scale * scale) {  // 1e-9 of it would be rounding
            continue;
        }
        const std::vector<Corners> found = triangles_of(polygon);
        REQUIRE(area_of(found, twice) == Approx(area).epsilon(1e-9).margin(0));
        // In the plane, where it is easy to say what is inside.
        for (const auto& [a, b, c] : cut_face(polygon).triangles) {
            for (int i = 0; i < 5; ++i) {
                double u = random.uniform(0, 1);
                double v = random.uniform(0, 1);
                if (u + v > 1) {
                    u = 1 - u;
                    v = 1 - v;
                }
                const Vector3 inner = (1 - u - v) * in_plane[a] + u * in_plane[b] + v * in_plane[c];
                const Vector3 to_b = in_plane[b] - in_plane[a];
                if (length(cross(to_b, in_plane[c] - in_plane[a])) > 1e-9) {
                    REQUIRE(is_inside(in_plane, inner));
                }
            }
        }
        const std::set<Corners> expected = set_of(found);
        bool are_equal = true;
        for (std::size_t first = 1; first < polygon.size(); ++first) {
            const std::vector<Corners> others = triangles_of(started_at(polygon, first));
            REQUIRE(area_of(others, twice) == Approx(area).epsilon(1e-9).margin(0));
            are_equal = are_equal && set_of(others) == expected;
        }
        // Fans of convex faces begin where the file does.
        const bool is_convex = !are_equal;
        for (std::size_t i = 0; i < polygon.size() && is_convex; ++i) {
            const Vector3 turn = cross(in_plane[(i + 1) % polygon.size()] - in_plane[i],
                                       in_plane[(i + 2) % polygon.size()] - in_plane[(i + 1) % polygon.size()]);
            REQUIRE(turn[2] * twice_area(in_plane)[2] > 0);
        }
        concave += is_convex ? 0 : 1;
    }
    CHECK(concave > 900);
}

TEST_CASE("A convex face stays a fan around its first corner") {
    const Polygon square = flat({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    for (std::size_t first = 0; first < 4; ++first) {
        CHECK(cut_face(started_at(square, first)).triangles ==
              std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}});
    }
    // A bent one has two ways to be cut; the corner that comes first does not decide.
    Polygon bent = square;
    bent[2][2] = 0.1;
    const std::set<Corners> expected = set_of(triangles_of(bent));
    for (std::size_t first = 1; first < 4; ++first) {
        CHECK(set_of(triangles_of(started_at(bent, first))) == expected);
    }
}

TEST_CASE("A doorway stays open, in every plane, from either side and from every corner") {
    const Vector3 in_doorway{0, 1, 0};
    Random random(2);
    for (int round = 0; round < 50; ++round) {
        const Vector3 rpy =
            round == 0 ? Vector3{} : Vector3{random.uniform(-3, 3), random.uniform(-1.5, 1.5), random.uniform(-3, 3)};
        for (const bool is_reversed : {false, true}) {
            Polygon in_plane = doorway;
            if (is_reversed) {
                std::reverse(in_plane.begin(), in_plane.end());
            }
            for (std::size_t first = 0; first < doorway.size(); ++first) {
                const Polygon started = started_at(in_plane, first);
                const Polygon polygon = placed(started, rpy, {7, -3, 11}, 1);
                CHECK(area_of(triangles_of(polygon), twice_area(polygon)) == Approx(24 * 8 - 6 * 6).epsilon(1e-12));
                for (const auto& [a, b, c] : cut_face(polygon).triangles) {
                    CHECK_FALSE(is_inside({started[a], started[b], started[c]}, in_doorway));
                }
            }
        }
    }
}

TEST_CASE("A face may touch itself: with a hole that a bridge joins, corners on lines, twice the same, or a spike") {
    const auto check = [](const Polygon& polygon, double area) {
        for (std::size_t first = 0; first < polygon.size(); ++first) {
            const Polygon started = started_at(polygon, first);
            CAPTURE(first);
            CHECK(area_of(triangles_of(started), twice_area(started)) == Approx(area).epsilon(1e-12));
        }
    };
    // Around the square, over to the hole, around it the other way, and back.
    const Polygon with_hole = flat({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}});
    check(with_hole, 16 - 4);
    for (const auto& [a, b, c] : cut_face(with_hole).triangles) {
        CHECK_FALSE(is_inside({with_hole[a], with_hole[b], with_hole[c]}, {2.1, 2.2, 0}));
    }
    const Polygon two_holes = flat({{0, 0},
                                    {9, 0},
                                    {9, 4},
                                    {0, 4},
                                    {0, 0},
                                    {1, 1},
                                    {1, 3},
                                    {3, 3},
                                    {3, 1},
                                    {5, 1},
                                    {5, 3},
                                    {7, 3},
                                    {7, 1},
                                    {5, 1},
                                    {3, 1},
                                    {1, 1}});
    check(two_holes, 36 - 8);
    check(flat({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0.5, 1}, {0, 1}}), 3);
    check(flat({{0, 0}, {2, 0}, {2, 0}, {2, 2}, {1, 2}, {1, 1}, {1, 1}, {0, 1}}), 3);
    check(flat({{0, 0}, {2, 0}, {2, 2}, {1, 2}, {1, 3}, {1, 2}, {1, 1}, {0, 1}}), 3);
    // A notch down to the opposite edge; its tip may lie beyond by what digits leave.
    for (const double tip : {0., 3e-7, -3e-7}) {
        const Polygon pinched = flat({{0, 0}, {2, 0}, {2, 2}, {1, tip}, {0, 2}});
        for (std::size_t first = 0; first < pinched.size(); ++first) {
            const Polygon started = started_at(pinched, first);
            double area = 0;
            for (const Corners& t : triangles_of(started)) {
                area += length(cross(t[1] - t[0], t[2] - t[0])) / 2;
            }
            CHECK(area == Approx(2).epsilon(1e-6));
        }
    }
    // Two squares that touch at a corner.
    check(flat({{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0, 1}}), 2);
}

TEST_CASE("A face that crosses itself or is far from plane is an error with its line") {
    const std::string crossing =
        "corners whose outline crosses itself: expected one that goes once around; cut it into triangles";
    const auto at_line = [](const Polygon& polygon) {
        return "'a.obj' line " + std::to_string(polygon.size() + 2) + ": a face of " + std::to_string(polygon.size()) +
               " ";
    };
    Polygon star;
    for (int i = 0; i < 5; ++i) {
        star.push_back({std::cos(i * 4 * 3.14159265358979 / 5), std::sin(i * 4 * 3.14159265358979 / 5), 0});
    }
    for (const Polygon& polygon :
         {flat({{0, 0}, {1, 1}, {1, 0}, {0, 1}}), flat({{0, 0}, {3, 3}, {3, 0}, {0, 1}}), star,
          flat({{0, 0}, {1, 0}, {1, 1}, {3, 1}, {3, 0}, {2, 0}, {2, 2}, {1, 2}, {1, 1}, {0, 1}}),
          // Two squares that touch at a corner, gone around in opposite ways.
          flat({{0, 0}, {1, 0}, {1, 1}, {1, 2}, {3, 2}, {3, 1}, {1, 1}, {0, 1}})}) {
        for (std::size_t first = 0; first < polygon.size(); ++first) {
            CAPTURE(polygon, first);
            CHECK(said_of(placed(started_at(polygon, first), {0.3, 0.2, 0.1}, {1, 2, 3}, 1)) ==
                  at_line(polygon) + crossing);
        }
    }
    // A triangle with two spikes that leave its corner across each other is cut right or not at all.
    const Polygon spikes = flat({{10, 0}, {0, 0}, {0, 10}, {0, -1}, {-1, 0}, {0, 0}});
    for (int i = 0; i < 50; ++i) {
        const FaceCut cut = cut_face(placed(spikes, {0.01 * i, 0.04, 0.02 * i}, {1, 2, 3}, 0.01));
        double area = 0;
        for (const auto& [a, b, c] : cut.triangles) {
            area += length(cross(spikes[b] - spikes[a], spikes[c] - spikes[a])) / 2;
        }
        CAPTURE(i, area, cut.triangles.size());
        CHECK((cut.fault == FaceFault::crossing || area == Approx(0.5)));
    }
    Polygon bent = flat({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    bent[2][2] = 0.6;
    CHECK(said_of(bent) ==
          at_line(bent) +
              "corners that is not plane: expected corners within 0.05 of its size from a plane; cut it "
              "into triangles");
    // Bent a little is a remark, rounding is not worth one.
    for (const auto& [height, remarks] : {std::pair(0.1, 1U), {0.001, 0U}}) {
        bent[2][2] = height;
        CHECK(parse_mesh(obj_of(bent), "a.obj").remarks.size() == remarks);
    }
    bent[2][2] = 0.1;
    CHECK(parse_mesh(obj_of(bent), "a.obj").remarks ==
          std::vector<std::string>{"1 face is not plane, in line 6: where such a face is cut into triangles is "
                                   "a choice"});
    // A face without an area is left out later, as are triangles without one.
    CHECK(said_of(flat({{0, 0}, {1, 0}, {2, 0}, {3, 0}})) == "none");
}

TEST_CASE("Large faces are cut while that does not take long") {
    Polygon round;
    Polygon comb;
    for (int i = 0; i < 50'000; ++i) {
        const double angle = 2 * 3.14159265358979 * i / 50'000;
        round.push_back({std::cos(angle), std::sin(angle), 0});
    }
    CHECK(cut_face(round).triangles.size() == round.size() - 2);
    for (int i = 0; i < 4000; ++i) {
        comb.push_back({0.001 * i, i % 2 == 0 ? 0.1 : 1., 0});
    }
    comb.push_back({4, 0, 0});
    comb.push_back({0, 0, 0});
    CHECK(area_of(triangles_of(comb), twice_area(comb)) == Approx(length(twice_area(comb)) / 2).epsilon(1e-9));
    round[1] = {0, 0, 0};
    CHECK_THAT(said_of(round), Catch::EndsWith("expected at most 10000 corners; cut it into triangles"));
}
