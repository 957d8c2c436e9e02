#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "../support/polygons.hpp"
#include "downwash/scene/polygon_triangles.hpp"

/// Three bytes turn a plane, each pair behind them is a corner in it. The triangles of a face have its area and turn as
/// it does, or there are none.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace downwash;
    if (size < 9) {
        return 0;
    }
    const Vector3 rpy_rad{0.02 * data[0], 0.01 * data[1], 0.02 * data[2]};
    test::Polygon flat;
    for (std::size_t i = 3; i + 1 < size; i += 2) {
        flat.push_back({static_cast<double>(static_cast<std::int8_t>(data[i])),
                        static_cast<double>(static_cast<std::int8_t>(data[i + 1])), 0});
    }
    const test::Polygon polygon = test::placed(flat, rpy_rad, {1, 2, 3}, 0.01);
    const FaceCut cut = cut_face(polygon);
    if (cut.fault != FaceFault::none) {
        if (!cut.triangles.empty()) {
            std::abort();
        }
        return 0;
    }
    if (cut.triangles.size() != polygon.size() - 2) {
        std::abort();
    }
    const Vector3 twice = test::twice_area(polygon);
    const double twice_area = test::length(twice);
    double sum = 0;
    for (const auto& [a, b, c] : cut.triangles) {
        if (a >= polygon.size() || b >= polygon.size() || c >= polygon.size()) {
            std::abort();
        }
        sum += test::length(cross(polygon[b] - polygon[a], polygon[c] - polygon[a]));
    }
    constexpr double rounding = 4e-5;  // what a corner may be off its line, on a face up to 3.6 units across
    if (std::abs(sum - twice_area) > rounding * static_cast<double>(polygon.size())) {
        std::abort();
    }
    return 0;
}
