#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "../support/random.hpp"
#include "downwash/report/label_placement.hpp"

using namespace downwash;

namespace {

constexpr PixelBox area{0, 1000, 0, 600};
constexpr double height = 18;

std::vector<PixelPoint> rectangle(double left, double right, double bottom, double top) {
    return {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
}

int plain(const PixelPoint& /*p*/) {
    return 0;
}

}  // namespace

TEST_CASE("a name goes into its shape where it fits, else beside it") {
    const auto labels = place_labels(
        {{"wide", 80, true, {rectangle(100, 300, 100, 200)}}, {"small", 80, true, {rectangle(500, 510, 300, 310)}}},
        area, height, plain);
    REQUIRE(labels.size() == 2);
    CHECK(labels[0].is_inside);
    CHECK(labels[0].box.middle().x == Approx(200));
    CHECK(labels[0].box.middle().y == Approx(150));
    CHECK_FALSE(labels[1].is_inside);
    CHECK_FALSE(labels[1].box.meets({500, 510, 300, 310}));
    CHECK(std::abs(labels[1].box.middle().y - 305) < 40);
}

TEST_CASE("a shape that is cut off by the area is named where it can be seen, and one outside is not") {
    const auto labels = place_labels({{"ground", 60, true, {rectangle(-5000, 700, -5000, 30)}},
                                      {"outside", 60, true, {rectangle(2000, 3000, 0, 100)}}},
                                     area, height, plain);
    REQUIRE(labels.size() == 1);
    CHECK(labels[0].shape == 0);
    CHECK(labels[0].box.middle().x == Approx(350));
    CHECK(labels[0].box.middle().y == Approx(15));
}

TEST_CASE("a name avoids colours that it would hide, and says with a line what it belongs to") {
    const auto near_shape = [](const PixelPoint& p) {
        return std::max(0, 7 - static_cast<int>(std::hypot(p.x - 500, p.y - 300) / 8));
    };
    const auto labels = place_labels({{"pipe", 40, true, {rectangle(495, 505, 295, 305)}}}, area, height, near_shape);
    REQUIRE(labels.size() == 1);
    CHECK_FALSE(labels[0].needs_ground);
    CHECK(near_shape({labels[0].box.left, labels[0].box.bottom}) == 0);
    REQUIRE(labels[0].leader);
    CHECK(labels[0].leader->x >= 495);
    CHECK(labels[0].leader->x <= 505);
}

TEST_CASE("names never overlap and stay within the area, however many there are") {
    test::Random random(7);
    const auto size = [&random] { return random.uniform(2, 120); };
    for (int round = 0; round < 10; ++round) {
        std::vector<NamedShape> shapes;
        for (int i = 0; i < 25; ++i) {
            const double left = random.uniform(0, 1000);
            const double bottom = random.uniform(0, 600);
            const std::vector<PixelPoint> outline = rectangle(left, left + size(), bottom, bottom + size());
            shapes.push_back({"name", 30 + size(), i % 3 != 0, {outline}});
        }
        const auto labels = place_labels(shapes, area, height, plain);
        CHECK(labels.size() > 15);
        for (std::size_t i = 0; i < labels.size(); ++i) {
            CHECK(area.holds(labels[i].box));
            for (std::size_t k = 0; k < i; ++k) {
                CHECK_FALSE(labels[i].box.meets(labels[k].box));
            }
        }
    }
}
