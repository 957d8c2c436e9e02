#include "downwash/scene/bounds_tree.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace downwash {
namespace {

/// Fewer parts are asked one by one: testing two boxes costs about as much as testing two parts' own.
constexpr std::uint32_t max_in_leaf = 8;

/// The point in the middle of a box, as a box.
BoundingBox middle_of(const BoundingBox& box) {
    const Vector3 middle = 0.5 * (box.low_m + box.high_m);
    return {middle, middle};
}

}  // namespace

BoundsTree::BoundsTree(std::span<const BoundingBox> parts) : order_(parts.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    if (!parts.empty()) {
        build(parts, 0, static_cast<std::uint32_t>(parts.size()));
    }
    nodes_.shrink_to_fit();
}

/// Halves the parts at the median of their middles along the axis on which these lie widest apart. (Not along the
/// longest side of their common box: the triangles of a long girder are as long as itself.)
void BoundsTree::build(std::span<const BoundingBox> parts, std::uint32_t first, std::uint32_t last) {
    BoundingBox all = parts[order_[first]];
    BoundingBox middles = middle_of(all);
    for (std::uint32_t i = first + 1; i < last; ++i) {
        all.include(parts[order_[i]]);
        middles.include(middle_of(parts[order_[i]]));
    }
    const std::size_t index = nodes_.size();
    nodes_.push_back({all, first, last - first});
    if (last - first <= max_in_leaf) {
        return;
    }
    std::size_t axis = 0;
    for (const std::size_t k : {1U, 2U}) {
        axis = middles.high_m[k] - middles.low_m[k] > middles.high_m[axis] - middles.low_m[axis] ? k : axis;
    }
    const std::uint32_t middle = first + (last - first) / 2;
    const auto is_lower = [&](std::uint32_t a, std::uint32_t b) {
        const double at_a = parts[a].low_m[axis] + parts[a].high_m[axis];
        const double at_b = parts[b].low_m[axis] + parts[b].high_m[axis];
        return at_a < at_b || (at_a == at_b && a < b);
    };
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last, is_lower);
    build(parts, first, middle);
    nodes_[index].first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[index].count = 0;
    build(parts, middle, last);
}

}  // namespace downwash
