#include <catch2/catch.hpp>
#include <cmath>

#include "downwash/effects/potential_flow.hpp"
#include "downwash/report/flow_figure.hpp"
#include "pictures.hpp"

using namespace downwash;

namespace {

const PlanarVelocity rotation = [](double x, double z) -> std::array<double, 2> { return {-z, x}; };

}  // namespace

TEST_CASE("the streamlines of a rotation are circles in its sense, drawn over the axial velocity") {
    const auto points = streamline(rotation, {1, 0}, {-2, 2, -2, 2}, 0.01);
    CHECK(points.size() == 10001);
    for (const PlanePoint& p : points) {
        CHECK(std::hypot(p.x_m, p.z_m) == Approx(1).epsilon(1e-7));
    }
    CHECK(points[100].z_m == Approx(std::sin(1.0)).epsilon(1e-7));
    FieldFigure figure = flow_figure(rotation, {-2, 2, -1, 1}, {{0.5, 0}, {0.8, 0}}, signed_scale("w", 2));
    CHECK(figure.value(0.7, 0.1) == 0.7);
    REQUIRE(figure.lines.size() == 1);
    CHECK(figure.lines[0].pieces.size() == 2);
    figure.title = "Rotation";
    CHECK_THAT(test::texts_of(figure), Catch::Contains("streamlines"));
}

TEST_CASE("a streamline ends where it leaves the extent, and where the flow stands still or is not finite") {
    const Bounds extent{-1, 1, -1, 1};
    const PlanarVelocity uniform = [](double, double) -> std::array<double, 2> { return {3, 0}; };
    const auto leaving = streamline(uniform, {0, 0}, extent, 0.1);
    CHECK(leaving.back().x_m > 1);
    CHECK(leaving.size() == 12);
    const PlanarVelocity none = [](double, double) -> std::array<double, 2> { return {0, 0}; };
    CHECK(streamline(none, {0, 0}, extent, 0.1).size() == 1);
    const PlanarVelocity broken = [](double x, double) -> std::array<double, 2> { return {x < 0.5 ? 1 : NAN, 0}; };
    CHECK(streamline(broken, {0, 0}, extent, 0.1).back().x_m <= 0.6);
    const PlanarVelocity sink = [](double x, double z) -> std::array<double, 2> { return {-x, -z}; };
    const auto ending = streamline(sink, {0.9, 0.123}, extent, 0.1);
    CHECK(ending.size() < 30);
    CHECK(std::hypot(ending.back().x_m, ending.back().z_m) < 0.2);
}

TEST_CASE("streamlines of rotor and image keep the flux between them and the axis") {
    // Stream function of two equal sources (Milne-Thomson, section 16.25): cos(angle from one) + cos(angle from other).
    const double height = 1.2;
    const PlanarVelocity velocity = [&](double x, double z) -> std::array<double, 2> {
        const Vector3 v = potential_flow_velocity({x, 0, z}, height);
        return {v[0], v[2]};
    };
    const auto stream_function = [&](const PlanePoint& p) {
        return (p.z_m - height) / std::hypot(p.x_m, p.z_m - height) +
               (p.z_m + height) / std::hypot(p.x_m, p.z_m + height);
    };
    for (const PlanePoint& start : {PlanePoint{0.3, 1.5}, {0.2, 0.9}, {0.4, 0.4}}) {
        const auto points = streamline(velocity, start, {-4, 4, 0, 3}, 0.01);
        CHECK(points.size() > 50);
        for (const PlanePoint& p : points) {
            CHECK(stream_function(p) == Approx(stream_function(start)).margin(1e-6));
        }
    }
}
