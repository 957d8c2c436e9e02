#include "downwash/scene/parts.hpp"

namespace downwash {

void Parts::add(const Primitive& primitive, const Vector3& center_m, const Placement& placement) {
    const Convex convex = convex_of(primitive, center_m, placement);
    primitives.push_back(primitive);
    primitive_centers_m.push_back(center_m);
    primitive_placements.push_back(placement);
    primitive_convexes.push_back(convex);
    primitives_from_above.push_back(seen_from_above(primitive, placement));
    primitive_bounds.push_back(bounds_of(convex));
}

void Parts::index() {
    std::vector<BoundingBox> others;
    others.reserve(count() - primitives.size());
    for (std::size_t part = primitives.size(); part < count(); ++part) {
        others.push_back(bounds(part));
    }
    primitive_tree_ = BoundsTree(primitive_bounds);
    other_tree_ = BoundsTree(others);
}

Convex Parts::convex_of_other(std::size_t part) const noexcept {
    return visit(
        part, [this](std::size_t i) { return primitive_convexes[i]; },
        [](const OctreeBox& box, const Placement& placement) {
            return convex_of(Box{box.size_m}, box.center_m, placement);
        },
        [](const Triangle& triangle) { return convex_of(triangle); });
}

BoundingBox Parts::bounds_of_other(std::size_t part) const noexcept {
    return visit(
        part, [this](std::size_t i) { return primitive_bounds[i]; },
        [](const OctreeBox& box, const Placement& placement) {
            return bounds_of(convex_of(Box{box.size_m}, box.center_m, placement));
        },
        [](const Triangle& triangle) { return bounds_of(triangle); });
}

}  // namespace downwash
