#include "downwash/aeromap/part_columns.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "downwash/scene/bounding_box.hpp"

namespace downwash {
namespace {

std::uint64_t next_id() {
    static std::atomic<std::uint64_t> last{0};
    return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

bool meet(const BoundingBox& a, const BoundingBox& b) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (a.low_m[k] > b.high_m[k] || b.low_m[k] > a.high_m[k]) {
            return false;
        }
    }
    return true;
}

}  // namespace

PartColumns::PartColumns(const Scene& scene, double radius_m) : scene_(scene), radius_m_(radius_m), id_(next_id()) {}

PartColumns::Square& PartColumns::place_of(double x, double y) const {
    static thread_local Squares squares;
    // Effects that are asked about the same discs in turn must not take each other's places.
    const double shift = 7 * static_cast<double>(id_ % side);
    const auto place = [&](double number) {
        const double shifted = number + shift;
        return static_cast<std::size_t>(shifted - side * std::floor(shifted / side));
    };
    return squares[side * place(x) + place(y)];
}

void PartColumns::fill(Square& square) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    // A little wider than the discs around the square, so that rounding leaves none out.
    const double reach_m = 1.001 * radius_m_;
    std::pmr::vector<std::size_t> found;
    scene_.add_parts_meeting({{square.x * radius_m_ - reach_m, square.y * radius_m_ - reach_m, -infinity},
                              {(square.x + 1) * radius_m_ + reach_m, (square.y + 1) * radius_m_ + reach_m, infinity}},
                             found);
    std::sort(found.begin(), found.end());
    square.parts.clear();
    for (const std::size_t part : found) {
        if (scene_.has_shadow(part)) {
            square.parts.push_back({part, scene_.part_bounds(part)});
        }
    }
    square.is_filled = true;
}

void PartColumns::add_parts_meeting(const BoundingBox& box, std::pmr::vector<std::size_t>& parts) const {
    const double x = std::floor((box.low_m[0] + box.high_m[0]) / 2 / radius_m_);
    const double y = std::floor((box.low_m[1] + box.high_m[1]) / 2 / radius_m_);
    constexpr double largest = 1e9;  // beyond, numbers of squares get lost in rounding
    if (std::abs(x) < largest && std::abs(y) < largest) {
        Square& square = place_of(x, y);
        if (square.owner == id_ && square.x == x && square.y == y) {
            if (!square.is_filled) {
                fill(square);
            }
            for (const Part& part : square.parts) {
                if (meet(box, part.bounds)) {
                    parts.push_back(part.index);
                }
            }
            return;
        }
        square.owner = id_;
        square.x = x;
        square.y = y;
        square.is_filled = false;
    }
    scene_.add_parts_meeting(box, parts);
    std::erase_if(parts, [&](std::size_t part) { return !scene_.has_shadow(part); });
    std::sort(parts.begin(), parts.end());
}

}  // namespace downwash
