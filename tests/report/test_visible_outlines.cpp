#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <limits>
#include <pugixml.hpp>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "../support/random.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/report/field_figure.hpp"
#include "downwash/report/obstacle_outline.hpp"

using namespace downwash;

namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

/// What an SVG shows of obstacles, in pixels from the upper left corner.
struct Drawn {
    Bounds frame{};                        ///< of the axes, downwards
    std::vector<std::vector<Ring>> fills;  ///< of one obstacle each
    double dashed_px = 0;                  ///< length of the lines of projected obstacles
};

std::vector<Ring> rings_of_path(const std::string& text) {
    std::vector<Ring> rings;
    std::string numbers = text;
    for (char& c : numbers) {
        if (c == ',' || c == 'L' || c == 'Z') {
            c = ' ';
        }
    }
    std::istringstream moves(numbers);
    for (std::string move; std::getline(moves, move, 'M');) {
        std::istringstream in(move);
        Ring ring;
        for (PlanePoint p; in >> p.x_m >> p.z_m;) {
            ring.push_back(p);
        }
        if (!ring.empty()) {
            rings.push_back(std::move(ring));
        }
    }
    return rings;
}

double length_of(const Ring& line) {
    double length = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        length += std::hypot(line[i].x_m - line[i - 1].x_m, line[i].z_m - line[i - 1].z_m);
    }
    return length;
}

/// The length of a level line within a polygon and between two abscissas, by the even-odd rule.
double length_within(const std::vector<Ring>& rings, double z, double low, double high) {
    std::vector<double> crossings;
    for (const Ring& ring : rings) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const PlanePoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
            if ((a.z_m > z) != (b.z_m > z)) {
                crossings.push_back(a.x_m + (z - a.z_m) / (b.z_m - a.z_m) * (b.x_m - a.x_m));
            }
        }
    }
    std::sort(crossings.begin(), crossings.end());
    double length = 0;
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
        length += std::clamp(crossings[i + 1], low, high) - std::clamp(crossings[i], low, high);
    }
    return length;
}

/// The length of a closed line within an extent, by points along it.
double length_within(const Ring& ring, const Bounds& extent) {
    constexpr int parts = 4000;
    double length = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const PlanePoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
        int inside = 0;
        for (int k = 0; k < parts; ++k) {
            const double s = (k + 0.5) / parts;
            const double x_m = a.x_m + s * (b.x_m - a.x_m), z_m = a.z_m + s * (b.z_m - a.z_m);
            inside += x_m > extent.x_low_m && x_m < extent.x_high_m && z_m > extent.z_low_m && z_m < extent.z_high_m;
        }
        length += std::hypot(b.x_m - a.x_m, b.z_m - a.z_m) * inside / parts;
    }
    return length;
}

/// Whether a path begins within the frame; the samples of the legend are above it.
bool begins_in(const std::vector<Ring>& rings, const Bounds& frame) {
    constexpr double rounding_px = 0.02;
    const PlanePoint& p = rings.front().front();
    return p.x_m > frame.x_low_m - rounding_px && p.x_m < frame.x_high_m + rounding_px &&
           p.z_m > frame.z_low_m - rounding_px && p.z_m < frame.z_high_m + rounding_px;
}

void collect(const pugi::xml_node& node, Drawn& drawn) {
    for (const pugi::xml_node& child : node.children()) {
        const bool is_polygon = std::string_view(child.name()) == "polygon";
        const auto rings = rings_of_path(child.attribute(is_polygon ? "points" : "d").value());
        if (!rings.empty() && begins_in(rings, drawn.frame)) {
            if (std::string_view(child.attribute("fill").value()).find("110, 110, 110") != std::string_view::npos) {
                drawn.fills.push_back(rings);
            }
            if (std::string_view(child.attribute("stroke").value()).find("80,  80,  80") != std::string_view::npos) {
                for (const Ring& ring : rings) {
                    drawn.dashed_px += length_of(ring);
                }
            }
        }
        collect(child, drawn);
    }
}

constexpr int width_px = 900;
constexpr double axes_left_px = 80, axes_width_px = 796, below_axes_px = 138;

/// What the picture of outlines in an extent shows of them.
Drawn drawn(std::vector<ObstacleOutline> outlines, const Bounds& extent) {
    FieldFigure figure;
    figure.extent = extent;
    figure.scale = factor_scale("K", {1, 2});
    figure.value = [](double, double) { return no_value; };
    for (ObstacleOutline& outline : outlines) {
        outline.name = "o";
    }
    figure.obstacles = std::move(outlines);
    const std::string picture = draw(figure, {PictureFormat::svg, width_px});
    pugi::xml_document document;
    REQUIRE(document.load_buffer(picture.data(), picture.size()));
    const double bottom_px = document.document_element().attribute("height").as_double() - below_axes_px;
    const double height_px = axes_width_px * (extent.z_high_m - extent.z_low_m) / (extent.x_high_m - extent.x_low_m);
    Drawn all;
    all.frame = {axes_left_px, axes_left_px + axes_width_px, bottom_px - height_px, bottom_px};
    collect(document.document_element(), all);
    return all;
}

/// Whether two obstacles have the same outlines, to a tenth of a millimetre.
bool look_the_same(const ObstacleOutline& a, const ObstacleOutline& b) {
    const auto are_close = [](const PlanePoint& p, const PlanePoint& q) {
        return std::hypot(p.x_m - q.x_m, p.z_m - q.z_m) < 1e-4;
    };
    const auto are_same = [&](const Ring& r, const Ring& s) {
        return std::equal(r.begin(), r.end(), s.begin(), s.end(), are_close);
    };
    return a.is_cut == b.is_cut && std::equal(a.rings.begin(), a.rings.end(), b.rings.begin(), b.rings.end(), are_same);
}

/// Compares what is drawn with the outlines, row by row of the picture.
void require_drawn_exactly(const std::vector<ObstacleOutline>& outlines, const Bounds& extent) {
    constexpr int rows = 397;
    const Drawn picture = drawn(outlines, extent);
    const double px_per_m = axes_width_px / (extent.x_high_m - extent.x_low_m);
    const double height_px = picture.frame.z_high_m - picture.frame.z_low_m;
    double difference_px = 0;
    for (int row = 0; row < rows; ++row) {
        const double down_px = (row + 0.4321) / rows * height_px;
        double drawn_px = 0;
        for (const auto& rings : picture.fills) {
            drawn_px += length_within(rings, picture.frame.z_low_m + down_px, -1e9, 1e9);
        }
        // The corners of the picture are rounded: a level edge this close to the row may be on its other side.
        constexpr double rounding_px = 0.01;
        double lower_px = HUGE_VAL, upper_px = 0;
        for (const double shift_px : {-rounding_px, 0., rounding_px}) {
            const double z_m = extent.z_high_m - (down_px + shift_px) / px_per_m;
            double expected_px = 0;
            for (const ObstacleOutline& outline : outlines) {
                expected_px +=
                    outline.is_cut ? px_per_m * length_within(outline.rings, z_m, extent.x_low_m, extent.x_high_m) : 0;
            }
            lower_px = std::min(lower_px, expected_px);
            upper_px = std::max(upper_px, expected_px);
        }
        difference_px += std::max({0., lower_px - drawn_px, drawn_px - upper_px}) / rows;
    }
    CHECK(difference_px < 0.3);  // of 796, from the rounding of corners to 0.01 px
    // Obstacles that look the same, such as girders left and right of the plane, are drawn once.
    double dashed_m = 0;
    for (auto outline = outlines.begin(); outline != outlines.end(); ++outline) {
        const bool is_repeated = std::any_of(
            outlines.begin(), outline, [&](const ObstacleOutline& other) { return look_the_same(*outline, other); });
        for (const Ring& ring : outline->rings) {
            dashed_m += outline->is_cut || is_repeated ? 0 : length_within(ring, extent);
        }
        for (const Ring& ring : outline->beside) {
            dashed_m += length_within(ring, extent);
        }
    }
    CHECK(picture.dashed_px == Approx(px_per_m * dashed_m).epsilon(0.002).margin(2));
}

Ring regular(double x_m, double z_m, double radius_m, int corners, double first_rad, bool is_hole = false) {
    Ring ring;
    for (int i = 0; i < corners; ++i) {
        const double angle_rad = first_rad + (is_hole ? -1 : 1) * 2 * std::acos(-1) * i / corners;
        ring.push_back({x_m + radius_m * std::cos(angle_rad), z_m + radius_m * std::sin(angle_rad)});
    }
    return ring;
}

}  // namespace

TEST_CASE("obstacles that leave the frame on any side or corner are drawn with exactly their area") {
    const Bounds extent{-2, 2, -1, 1};
    for (const bool is_cut : {true, false}) {
        for (const double x_m : {-2., 0.1, 2.}) {
            for (const double z_m : {-1., 0.2, 1.}) {
                for (const int corners : {3, 4, 96}) {  // rotated squares and round shapes
                    for (const double radius_m : {0.4, 1.7, 9.}) {
                        CAPTURE(is_cut, x_m, z_m, corners, radius_m);
                        require_drawn_exactly({{"", is_cut, {regular(x_m, z_m, radius_m, corners, 0.3)}, {}}}, extent);
                    }
                }
            }
        }
    }
}

TEST_CASE("obstacles larger than the frame, and holes that leave it, are drawn with exactly their area") {
    const Bounds extent{-2, 2, -1, 1};
    const Ring around = regular(0.3, -0.2, 1e4, 5, 0.1);
    require_drawn_exactly({{"", true, {around}, {}}}, extent);
    require_drawn_exactly({{"", false, {around}, {}}}, extent);
    for (const double x_m : {-2., 0., 2.1}) {
        for (const double z_m : {-1., 0.1}) {
            CAPTURE(x_m, z_m);
            require_drawn_exactly({{"", true, {around, regular(x_m, z_m, 0.7, 40, 0.2, true)}, {}}}, extent);
            require_drawn_exactly(
                {{"", true, {regular(x_m, z_m, 2.3, 7, 0.2), regular(x_m, z_m, 1.9, 7, 0.2, true)}, {}}}, extent);
        }
    }
}

TEST_CASE("the obstacles of every shipped problem are drawn with exactly their area at ten zooms") {
    for (const char* name : {"along_the_deck", "box_girder_bay", "bridge_inspection", "culvert", "girder_mesh",
                             "open_air", "pipe_rack", "window"}) {
        const Problem problem = read_problem(std::filesystem::path(DOWNWASH_PROBLEMS) / (std::string(name) + ".yaml"));
        const auto outlines = obstacle_outlines(Scene(problem.obstacles), problem.plane, 0);
        const Bounds& bounds = problem.bounds;
        test::Random random(11);
        for (int zoom = 0; zoom < 10; ++zoom) {
            const double width_m = (bounds.x_high_m - bounds.x_low_m) * std::pow(2., 1 - zoom / 2.);
            const double x_m = random.uniform(bounds.x_low_m, bounds.x_high_m);
            const double z_m = random.uniform(bounds.z_low_m, bounds.z_high_m);
            CAPTURE(name, zoom);
            require_drawn_exactly(outlines,
                                  {x_m - width_m / 2, x_m + width_m / 2, z_m - width_m / 4, z_m + width_m / 4});
        }
    }
}
