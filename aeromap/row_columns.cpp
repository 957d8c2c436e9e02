#include "downwash/aeromap/row_columns.hpp"

#include <algorithm>
#include <cmath>
#include <memory_resource>
#include <utility>

#include "downwash/base/infinity.hpp"

namespace downwash {
namespace {

/// Discs in the flyable area are 0.3 radii away from everything, unless a setting says otherwise.
constexpr double slab_radii = 0.25;
/// Discs reach so far around their hubs, up to the middles of the rows at their rims. A little more, so that rounding
/// leaves none out.
constexpr double reach_radii = 1.001 + 0.5 / RowLattice::rows_in_radius.front();

RowWindow grown(const RowWindow& window, double by_m) {
    return {{window.u_m.low - by_m, window.u_m.high + by_m}, {window.v_m.low - by_m, window.v_m.high + by_m}};
}

/// The box of the world around all that is over and under a window.
BoundingBox column_around(const RowWindow& window, const ChordFrame& frame) {
    BoundingBox box{{infinity, infinity, -infinity}, {-infinity, -infinity, infinity}};
    for (const double u : {window.u_m.low, window.u_m.high}) {
        for (const double v : {window.v_m.low, window.v_m.high}) {
            box.low_m[0] = std::min(box.low_m[0], frame.x_of(u, v));
            box.low_m[1] = std::min(box.low_m[1], frame.y_of(u, v));
            box.high_m[0] = std::max(box.high_m[0], frame.x_of(u, v));
            box.high_m[1] = std::max(box.high_m[1], frame.y_of(u, v));
        }
    }
    return box;
}

/// Whether a box of the world may be over or under a window.
bool may_meet(const BoundingBox& box, const RowWindow& window, const ChordFrame& frame) {
    const double x = 0.5 * (box.low_m[0] + box.high_m[0]);
    const double y = 0.5 * (box.low_m[1] + box.high_m[1]);
    const double half_x = 0.5 * (box.high_m[0] - box.low_m[0]);
    const double half_y = 0.5 * (box.high_m[1] - box.low_m[1]);
    const double reach_u = half_x * std::abs(frame.du_x) + half_y * std::abs(frame.du_y);
    const double reach_v = half_x * std::abs(frame.du_y) + half_y * std::abs(frame.du_x);
    const double u = frame.u_of(x, y);
    const double v = frame.v_of(x, y);
    return u + reach_u >= window.u_m.low && u - reach_u <= window.u_m.high && v + reach_v >= window.v_m.low &&
           v - reach_v <= window.v_m.high;
}

}  // namespace

RowColumn::RowColumn(const Scene& scene, double radius_m, const RowWindow& hubs)
    : scene_(scene), radius_m_(radius_m), window_(grown(hubs, reach_radii * radius_m)) {
    const ChordFrame frame = RowLattice::frame(radius_m);
    std::pmr::vector<std::size_t> found;
    scene.add_parts_meeting(column_around(window_, frame), found);
    std::sort(found.begin(), found.end());
    for (const std::size_t part : found) {
        const BoundingBox bounds = scene.part_bounds(part);
        if (scene.has_shadow(part) && may_meet(bounds, window_, frame)) {
            parts_.push_back(static_cast<std::uint32_t>(part));
            bounds_.push_back(bounds);
            heights_m_.push_back({bounds.low_m[2], bounds.high_m[2]});
        }
    }
    std::sort(heights_m_.begin(), heights_m_.end(), [](const Interval& a, const Interval& b) { return a.low < b.low; });
    std::size_t count = 0;
    for (const Interval& heights : heights_m_) {
        if (count > 0 && heights.low <= heights_m_[count - 1].high) {
            heights_m_[count - 1].high = std::max(heights_m_[count - 1].high, heights.high);
        } else {
            heights_m_[count++] = heights;
        }
    }
    heights_m_.resize(count);
    heights_m_.shrink_to_fit();
    parts_.shrink_to_fit();
    bounds_.shrink_to_fit();
    constexpr std::size_t place_in_table = 64;
    bytes_ = sizeof(*this) + parts_.capacity() * sizeof(std::uint32_t) + bounds_.capacity() * sizeof(BoundingBox) +
             heights_m_.capacity() * sizeof(Interval) + place_in_table;
}

double RowColumn::nearest_gap_m(const DiscQuery& query) const noexcept {
    const double x_low = query.hub_m[0] - query.radius_m;
    const double x_high = query.hub_m[0] + query.radius_m;
    const double y_low = query.hub_m[1] - query.radius_m;
    const double y_high = query.hub_m[1] + query.radius_m;
    double nearest_m = infinity;
    for (const BoundingBox& box : bounds_) {
        if (box.low_m[0] <= x_high && box.high_m[0] >= x_low && box.low_m[1] <= y_high && box.high_m[1] >= y_low) {
            nearest_m = std::min(nearest_m, query.gap(box.low_m[2], box.high_m[2]));
        }
    }
    return nearest_m;
}

std::optional<Slab> RowColumn::slab_around(double z_m) const {
    const auto above = std::upper_bound(heights_m_.begin(), heights_m_.end(), z_m,
                                        [](double z, const Interval& heights) { return z < heights.low; });
    const double high_m = above == heights_m_.end() ? infinity : above->low;
    if (above == heights_m_.begin()) {
        return Slab{-infinity, high_m, true};
    }
    const Interval& last = *std::prev(above);
    if (z_m > last.high) {
        return Slab{last.high, high_m, true};
    }
    if (z_m == last.high || z_m == last.low) {
        return {};
    }
    const double thickness_m = slab_radii * radius_m_;
    const double number = std::floor(z_m / thickness_m);
    const Slab slab{number * thickness_m, (number + 1) * thickness_m, false};
    return slab.low_m < z_m && z_m < slab.high_m ? std::optional(slab) : std::nullopt;
}

std::shared_ptr<const SurfaceRows> RowColumn::rows(Side side, int level, const Slab& slab,
                                                   std::size_t& made_bytes) const {
    made_bytes = 0;
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) {
        return kept.side == side && kept.level == level && kept.slab_low_m == slab.low_m &&
               kept.slab_high_m == slab.high_m;
    });
    if (found != kept_.end()) {
        return found->rows;
    }
    auto made = std::make_shared<const SurfaceRows>(scene_, parts_, RowLattice{radius_m_, level}, window_, side, slab);
    kept_.push_back({slab.low_m, slab.high_m, side, level, made});
    made_bytes = made->bytes() + sizeof(Kept);
    bytes_.fetch_add(made_bytes, std::memory_order_relaxed);
    return made;
}

RowColumns::RowColumns(const Scene& scene, double radius_m, std::size_t max_bytes)
    : scene_(scene), radius_m_(radius_m), max_shard_bytes_(max_bytes / (2 * shard_count)) {}

RowColumns::~RowColumns() = default;

RowColumns::Square RowColumns::square_of(double u_m, double v_m) const noexcept {
    return {static_cast<std::int64_t>(std::floor(u_m / square_m())),
            static_cast<std::int64_t>(std::floor(v_m / square_m()))};
}

std::shared_ptr<const RowColumn> RowColumns::at(double u_m, double v_m) const {
    const Square square = square_of(u_m, v_m);
    Shard& shard = shard_of(square);
    {
        const std::lock_guard lock(shard.mutex);
        if (const auto found = shard.late.find(square); found != shard.late.end()) {
            return found->second;
        }
        if (const auto found = shard.early.find(square); found != shard.early.end()) {
            std::shared_ptr<const RowColumn> column = found->second;
            const std::size_t bytes = column->bytes();
            shard.early.erase(found);
            shard.early_bytes -= std::min(bytes, shard.early_bytes);
            shard.late.emplace(square, column);
            add_bytes(shard, bytes);
            return column;
        }
    }
    const double low_u = static_cast<double>(square.u) * square_m();
    const double low_v = static_cast<double>(square.v) * square_m();
    auto column = std::make_shared<const RowColumn>(
        scene_, radius_m_, RowWindow{{low_u, low_u + square_m()}, {low_v, low_v + square_m()}});
    const std::lock_guard lock(shard.mutex);
    const auto [place, is_new] = shard.late.emplace(square, column);
    std::shared_ptr<const RowColumn> kept = place->second;  // perhaps another thread was sooner
    if (is_new) {
        add_bytes(shard, kept->bytes());
    }
    return kept;
}

std::shared_ptr<const SurfaceRows> RowColumns::rows(const RowColumn& column, double u_m, double v_m, Side side,
                                                    int level, const Slab& slab) const {
    std::size_t made_bytes = 0;
    std::shared_ptr<const SurfaceRows> rows = column.rows(side, level, slab, made_bytes);
    if (made_bytes > 0) {
        Shard& shard = shard_of(square_of(u_m, v_m));
        const std::lock_guard lock(shard.mutex);
        add_bytes(shard, made_bytes);
    }
    return rows;
}

/// Drops the early columns when the late ones have taken their share.
void RowColumns::add_bytes(Shard& shard, std::size_t bytes) const {
    shard.late_bytes += bytes;
    if (shard.late_bytes > max_shard_bytes_) {
        shard.early = std::exchange(shard.late, {});
        shard.early_bytes = std::exchange(shard.late_bytes, 0);
    }
}

std::size_t RowColumns::bytes() const {
    std::size_t sum = 0;
    for (Shard& shard : shards_) {
        const std::lock_guard lock(shard.mutex);
        for (const Columns* columns : {&shard.late, &shard.early}) {
            for (const auto& [square, column] : *columns) {
                sum += column->bytes();
            }
        }
    }
    return sum;
}

}  // namespace downwash
