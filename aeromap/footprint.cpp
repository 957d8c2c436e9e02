#include "downwash/aeromap/footprint.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <memory_resource>
#include <vector>

#include "downwash/base/infinity.hpp"
#include "downwash/base/lane_math.hpp"

namespace downwash {
namespace {

/// The planes of the faces seen from above or from below; none of cylinders and spheres.
std::vector<Footprint::Plane> planes_of(const Scene& scene, std::size_t part, bool is_from_above) {
    std::array<std::byte, 1024> room;
    std::pmr::monotonic_buffer_resource memory(room.data(), room.size());
    std::pmr::vector<Scene::Face> faces(&memory);
    scene.add_faces(part, is_from_above, faces);
    std::vector<Footprint::Plane> planes;
    for (const Scene::Face& face : faces) {
        const Vector3& a = face.corners_m[0];
        const Vector3& b = face.corners_m[1];
        const Vector3& c = face.corners_m[2];
        const double ux = b[0] - a[0];
        const double uy = b[1] - a[1];
        const double vx = c[0] - a[0];
        const double vy = c[1] - a[1];
        const double area = ux * vy - uy * vx;
        const double gx = ((b[2] - a[2]) * vy - (c[2] - a[2]) * uy) / area;
        const double gy = ((c[2] - a[2]) * ux - (b[2] - a[2]) * vx) / area;
        planes.push_back({a[2] - gx * a[0] - gy * a[1], gx, gy});
    }
    return planes;
}

struct Point {
    double x, y;
};

double cross(const Point& a, const Point& b) {
    return a.x * b.y - a.y * b.x;
}

/// Twice the area of the sector of the unit disc between the directions to two points.
double sector(const Point& a, const Point& b) {
    return lane::atan2(cross(a, b), a.x * b.x + a.y * b.y);
}

/// Twice the area that the unit disc has in common with the triangle of its centre, a and b; negative where a comes
/// after b.
double doubled_area(const Point& a, const Point& b) {
    const Point step{b.x - a.x, b.y - a.y};
    const double length2 = step.x * step.x + step.y * step.y;
    const double along = a.x * step.x + a.y * step.y;
    const double outside = a.x * a.x + a.y * a.y - 1;
    const double discriminant = along * along - length2 * outside;
    if (!(discriminant > 0)) {
        return sector(a, b);
    }
    const double root = std::sqrt(discriminant);
    const double enters = (-along - root) / length2;
    const double leaves = (-along + root) / length2;
    if (leaves <= 0 || enters >= 1) {
        return sector(a, b);
    }
    const auto at = [&](double t) { return Point{a.x + t * step.x, a.y + t * step.y}; };
    const Point first = enters > 0 ? at(enters) : a;
    const Point last = leaves < 1 ? at(leaves) : b;
    return (enters > 0 ? sector(a, first) : 0) + cross(first, last) + (leaves < 1 ? sector(last, b) : 0);
}

/// About a kilobyte each.
constexpr std::size_t max_kept = 16384;

std::vector<Footprint> footprints_of_primitives(const Scene& scene) {
    std::vector<Footprint> footprints;
    footprints.reserve(scene.primitive_count());
    for (std::size_t i = 0; i < scene.primitive_count(); ++i) {
        footprints.emplace_back(scene, i);
    }
    return footprints;
}

}  // namespace

Footprint::Footprint(const Scene& scene, std::size_t which)
    : part(which),
      bounds(scene.part_bounds(which)),
      is_level(scene.is_level(which)),
      outline(shadow_outline(scene, which)),
      upper_planes(planes_of(scene, which, true)),
      lower_planes(planes_of(scene, which, false)) {
    has_plane_faces = !upper_planes.empty();
    if (!is_level) {
        return;
    }
    double center_x = 0;
    double center_y = 0;
    for (const OutlineSegment& edge : outline.segments) {
        center_x += 0.5 * (edge.ax + edge.bx) / static_cast<double>(outline.segments.size());
        center_y += 0.5 * (edge.ay + edge.by) / static_cast<double>(outline.segments.size());
    }
    for (const OutlineSegment& edge : outline.segments) {
        const double dx = edge.bx - edge.ax;
        const double dy = edge.by - edge.ay;
        const double length = std::sqrt(dx * dx + dy * dy);
        Edge side{edge.ax, edge.ay, edge.bx, edge.by, dy / length, -dx / length, 0};
        side.reach = side.nx * edge.ax + side.ny * edge.ay;
        if (side.nx * center_x + side.ny * center_y > side.reach) {
            side = {edge.bx, edge.by, edge.ax, edge.ay, -side.nx, -side.ny, -side.reach};
        }
        sides_.push_back(side);
    }
    // Of a sliver nobody knows on which side its edges have it.
    constexpr double sliver_m = 1e-9;
    if (std::any_of(sides_.begin(), sides_.end(), [&](const Edge& side) {
            return side.reach - (side.nx * center_x + side.ny * center_y) < sliver_m;
        })) {
        sides_.clear();
    }
    if (!outline.ellipses.empty()) {
        disc_radius_ = outline.ellipses.front().across_m;
    }
}

bool Footprint::meets_column(double x, double y, double radius) const noexcept {
    const double dx = std::max({bounds.low_m[0] - x, x - bounds.high_m[0], 0.0});
    const double dy = std::max({bounds.low_m[1] - y, y - bounds.high_m[1], 0.0});
    return dx * dx + dy * dy < radius * radius;
}

bool Footprint::covers_disc(double x, double y, double radius) const noexcept {
    if (!sides_.empty()) {
        return std::all_of(sides_.begin(), sides_.end(),
                           [&](const Edge& side) { return side.nx * x + side.ny * y + radius <= side.reach; });
    }
    const double room = disc_radius_ - radius;
    if (!(room >= 0)) {
        return false;
    }
    const double dx = x - outline.ellipses.front().x;
    const double dy = y - outline.ellipses.front().y;
    return dx * dx + dy * dy <= room * room;
}

double Footprint::area_in_disc_m2(double x, double y, double radius) const noexcept {
    double doubled = 0;
    for (const Edge& side : sides_) {
        doubled += doubled_area({(side.ax - x) / radius, (side.ay - y) / radius},
                                {(side.bx - x) / radius, (side.by - y) / radius});
    }
    return 0.5 * radius * radius * std::max(doubled, 0.0);
}

Interval Footprint::shadow_on_line(double px, double py, double dx, double dy) const noexcept {
    Interval inside{-infinity, infinity};
    for (const Edge& side : sides_) {
        const double room = side.nx * (side.ax - px) + side.ny * (side.ay - py);
        const double rate = side.nx * dx + side.ny * dy;
        if (rate > 0) {
            inside.high = std::min(inside.high, room / rate);
        } else if (rate < 0) {
            inside.low = std::max(inside.low, room / rate);
        } else if (room < 0) {
            return {};
        }
    }
    return inside;
}

bool Footprint::has_side_before(const Footprint& other) const noexcept {
    constexpr double shared_m = 1e-9;
    return std::any_of(sides_.begin(), sides_.end(), [&](const Edge& side) {
        return std::all_of(other.sides_.begin(), other.sides_.end(), [&](const Edge& its) {
            return side.nx * its.ax + side.ny * its.ay >= side.reach - shared_m;
        });
    });
}

bool Footprint::lies_beside(const Footprint& other) const noexcept {
    return has_side_before(other) || other.has_side_before(*this);
}

bool Footprint::is_same_along(double dx, double dy, const BoundingBox& hubs, double radius) const noexcept {
    constexpr double aligned = 1e-9;
    for (const std::size_t axis : {0U, 1U}) {
        if (bounds.low_m[axis] >= hubs.high_m[axis] + radius || bounds.high_m[axis] <= hubs.low_m[axis] - radius) {
            return true;
        }
    }
    if (!is_level_polygon()) {
        return false;
    }
    bool ends_along = true;
    for (const Edge& side : sides_) {
        const auto reach = [&](const Vector3& ahead_x, const Vector3& ahead_y) {
            return side.nx * ahead_x[0] + side.ny * ahead_y[1];
        };
        const double most = reach(side.nx > 0 ? hubs.high_m : hubs.low_m, side.ny > 0 ? hubs.high_m : hubs.low_m);
        const double least = reach(side.nx > 0 ? hubs.low_m : hubs.high_m, side.ny > 0 ? hubs.low_m : hubs.high_m);
        if (least - radius >= side.reach) {
            return true;  // the part is beyond this edge
        }
        ends_along = ends_along && (most + radius <= side.reach || std::abs(side.nx * dx + side.ny * dy) < aligned);
    }
    return ends_along;
}

Footprints::Footprints(const Scene& scene, double radius_m)
    : scene_(scene),
      part_columns_(scene, radius_m),
      primitives_(scene.part_count() > few_parts ? std::vector<Footprint>{} : footprints_of_primitives(scene)),
      others_(scene.part_count() - primitives_.size()) {
    if (scene.part_count() > few_parts) {
        columns_.emplace(scene, radius_m);
    }
}

Footprints::~Footprints() {
    for (Kept& kept : others_) {
        delete kept.load(std::memory_order_relaxed);
    }
}

const Footprint& Footprints::of_other(std::size_t part, std::list<Footprint>& spare) const {
    Kept& place = others_[part - primitives_.size()];
    if (const Footprint* kept = place.load(std::memory_order_acquire)) {
        return *kept;
    }
    if (kept_.load(std::memory_order_relaxed) >= max_kept) {
        return spare.emplace_back(scene_, part);
    }
    auto made = std::make_unique<const Footprint>(scene_, part);
    const Footprint* other = nullptr;
    if (!place.compare_exchange_strong(other, made.get(), std::memory_order_acq_rel)) {
        return *other;  // another thread was sooner
    }
    kept_.fetch_add(1, std::memory_order_relaxed);
    return *made.release();
}

}  // namespace downwash
