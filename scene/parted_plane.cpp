#include "downwash/scene/parted_plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <variant>

#include "downwash/scene/convex.hpp"
#include "downwash/scene/scene_solids.hpp"

namespace downwash {
namespace {

/// By how much the cylinders are smaller than what bodies contain: flights are checked pose by pose and may cut corners
/// by 2.5 mm (max_unseen_motion_m).
constexpr double slack_m = 0.003;
/// Between two ticks a flight may leave the bounds by less than this.
constexpr double bounds_slack_m = 0.05;

/// A cylinder across the plane, with its axis through the centre of mass.
struct Core {
    double lateral_m, half_width_m, radius_m;
};

bool contains(const Primitive& shape, const Vector3& p_m) {
    if (const auto* box = std::get_if<Box>(&shape)) {
        return std::abs(p_m[0]) <= 0.5 * box->size_m[0] && std::abs(p_m[1]) <= 0.5 * box->size_m[1] &&
               std::abs(p_m[2]) <= 0.5 * box->size_m[2];
    }
    if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
        const Vector3 axis = (1 / std::sqrt(dot(cylinder->axis, cylinder->axis))) * cylinder->axis;
        const double along_m = dot(p_m, axis);
        const double off_m2 = dot(p_m, p_m) - along_m * along_m;
        return std::abs(along_m) <= 0.5 * cylinder->length_m && off_m2 <= cylinder->radius_m * cylinder->radius_m;
    }
    const double radius_m = std::get<Sphere>(shape).radius_m;
    return dot(p_m, p_m) <= radius_m * radius_m;
}

/// Whether a body contains a cylinder: it is convex, and contains a prism around it.
bool contains(const BodyShape& body, const Core& core) {
    constexpr int corners = 16;
    const double outer_m = core.radius_m / std::cos(std::numbers::pi / corners);
    for (int i = 0; i < 2 * corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        const double side_m = i < corners ? core.half_width_m : -core.half_width_m;
        const Vector3 corner{outer_m * std::cos(angle), core.lateral_m + side_m, outer_m * std::sin(angle)};
        if (!contains(body.shape, corner - body.center_body_m)) {
            return false;
        }
    }
    return true;
}

/// The widest cylinder in a body of a half width; nothing if the body does not contain its axis.
std::optional<Core> core_of(const BodyShape& body, double half_width_m, double reach_m) {
    Core core{body.center_body_m[1], half_width_m, 0};
    if (!contains(body, core)) {
        return std::nullopt;
    }
    double high_m = reach_m;
    for (int i = 0; i < 40; ++i) {
        const double middle_m = 0.5 * (core.radius_m + high_m);
        const bool fits = contains(body, Core{core.lateral_m, core.half_width_m, middle_m});
        (fits ? core.radius_m : high_m) = middle_m;
    }
    core.radius_m -= slack_m;
    core.half_width_m = std::max(0.0, core.half_width_m - slack_m);
    return core.radius_m > 0 ? std::optional(core) : std::nullopt;
}

/// What bodies contain at every pitch: broad cylinders, and narrower ones that are clearly thicker.
std::vector<Core> cores_of(const RobotShape& robot) {
    constexpr double clearly = 1.05;
    const Matrix3 identity{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    std::vector<Core> cores;
    for (const BodyShape& body : robot.bodies) {
        const Vector3 half_m =
            half_extents_m(convex_of(body.shape, body.center_body_m, placement_of(body.shape, identity)));
        const double reach_m = half_m[0] + half_m[2];
        double thickest_m = 0;
        for (const double share : {1.0, 0.9, 0.5, 0.1}) {
            const std::optional<Core> core = core_of(body, share * half_m[1], reach_m);
            if (core && core->radius_m > clearly * thickest_m) {
                cores.push_back(*core);
                thickest_m = core->radius_m;
            }
        }
    }
    return cores;
}

enum class State : std::uint8_t {
    blocked,  ///< wherever the centre is in it, a core touches an obstacle, or it is outside of the bounds
    free,     ///< wherever the centre is in it, no core does
    mixed,    ///< neither is known
};

constexpr std::int32_t across = 512;                 ///< smallest squares along a side of the whole
constexpr double smallest_m = 0.01;                  ///< side of squares that are not halved
constexpr std::size_t max_queries = 20'000;          ///< of distances
constexpr std::size_t no_obstacle = ~std::size_t{};  ///< the bounds

/// A square of the plane.
struct Cell {
    std::int32_t column, row, size;  ///< its lowest corner and its side, in smallest squares
    State state;
    std::size_t obstacle;  ///< that blocks it
};

class PartedPlane {
 public:
    PartedPlane(const Scene& scene, const PlaneOfMotion& plane, std::vector<Core> cores, const Bounds& bounds)
        : solids_(scene.solids()),
          plane_(plane),
          cores_(std::move(cores)),
          bounds_{bounds.x_low_m - bounds_slack_m, bounds.x_high_m + bounds_slack_m, bounds.z_low_m - bounds_slack_m,
                  bounds.z_high_m + bounds_slack_m},
          cell_m_(std::max(bounds_.x_high_m - bounds_.x_low_m, bounds_.z_high_m - bounds_.z_low_m) / across),
          cell_at_(static_cast<std::size_t>(across) * across, 0) {
        cells_.push_back(classified(0, 0, across));
    }

    /// Cells that a way through others leads to from a cell. @param may_pass (const Cell&) -> bool
    template <class MayPass>
    std::vector<std::size_t> connected(std::size_t from, const MayPass& may_pass) const {
        std::vector<std::size_t> found;
        if (!may_pass(cells_[from])) {
            return found;
        }
        std::vector<bool> is_found(cells_.size(), false);
        is_found[from] = true;
        found.push_back(from);
        for (std::size_t next = 0; next < found.size(); ++next) {
            for_each_neighbour(cells_[found[next]], [&](std::size_t other) {
                if (!is_found[other] && may_pass(cells_[other])) {
                    is_found[other] = true;
                    found.push_back(other);
                }
            });
        }
        return found;
    }

    /// Halves the mixed ones of some cells. @return whether there were any that may be halved
    bool halve(const std::vector<std::size_t>& cells) {
        bool has_halved = false;
        for (const std::size_t number : cells) {
            const Cell cell = cells_[number];
            if (cell.state != State::mixed || cell.size == 1 || cell.size * cell_m_ <= smallest_m ||
                queries_ > max_queries) {
                continue;
            }
            has_halved = true;
            const std::int32_t half = cell.size / 2;
            cells_[number] = classified(cell.column, cell.row, half);
            add(classified(cell.column + half, cell.row, half));
            add(classified(cell.column, cell.row + half, half));
            add(classified(cell.column + half, cell.row + half, half));
        }
        return has_halved;
    }

    [[nodiscard]] std::size_t cell_at(double x_m, double z_m) const {
        const auto place = [this](double from_low_m) {
            return std::clamp(static_cast<std::int32_t>(std::floor(from_low_m / cell_m_)), 0, across - 1);
        };
        return number_at(place(x_m - bounds_.x_low_m), place(z_m - bounds_.z_low_m));
    }
    [[nodiscard]] const Cell& cell(std::size_t number) const { return cells_[number]; }
    [[nodiscard]] PlaneSquare square_of(const Cell& cell) const {
        const double half_m = 0.5 * cell.size * cell_m_;
        return {bounds_.x_low_m + cell.column * cell_m_ + half_m, bounds_.z_low_m + cell.row * cell_m_ + half_m,
                half_m};
    }

    /// How many cells each obstacle blocks beside some cells.
    [[nodiscard]] std::map<std::size_t, std::size_t> blocking_beside(const std::vector<std::size_t>& cells) const {
        std::map<std::size_t, std::size_t> counts;
        for (const std::size_t number : cells) {
            for_each_neighbour(cells_[number], [&](std::size_t other) {
                if (cells_[other].state == State::blocked && cells_[other].obstacle != no_obstacle) {
                    ++counts[cells_[other].obstacle];
                }
            });
        }
        return counts;
    }

 private:
    [[nodiscard]] std::size_t number_at(std::int32_t column, std::int32_t row) const {
        return cell_at_[static_cast<std::size_t>(row) * across + static_cast<std::size_t>(column)];
    }

    void add(const Cell& cell) {
        const auto number = static_cast<std::uint32_t>(cells_.size());
        cells_.push_back(cell);
        for (std::int32_t row = cell.row; row < cell.row + cell.size; ++row) {
            const auto first = cell_at_.begin() + (static_cast<std::ptrdiff_t>(row) * across + cell.column);
            std::fill(first, first + cell.size, number);
        }
    }

    /// Calls `use(number)` with each cell that shares an edge or a corner; with some more than once.
    template <class Use>
    void for_each_neighbour(const Cell& cell, const Use& use) const {
        const std::int32_t left = cell.column - 1, right = cell.column + cell.size;
        const std::int32_t below = cell.row - 1, above = cell.row + cell.size;
        for (const std::int32_t row : {below, above}) {
            for (std::int32_t column = std::max(left, 0);
                 row >= 0 && row < across && column <= right && column < across;) {
                const std::size_t other = number_at(column, row);
                use(other);
                column = cells_[other].column + cells_[other].size;
            }
        }
        for (const std::int32_t column : {left, right}) {
            for (std::int32_t row = cell.row; column >= 0 && column < across && row < above;) {
                const std::size_t other = number_at(column, row);
                use(other);
                row = cells_[other].row + cells_[other].size;
            }
        }
    }

    /// A core around a point of the plane, with another radius.
    [[nodiscard]] Convex placed(const Core& core, const PlaneSquare& at, double radius_m) const {
        const Vector3 lateral{-plane_.sin_heading(), plane_.cos_heading(), 0};
        return {.center_m = plane_.to_world(at.x_m, core.lateral_m, at.z_m),
                .segment_count = 1,
                .half_axes_m = {core.half_width_m * lateral},
                .disc_normal = lateral,
                .disc_radius_m = radius_m};
    }

    [[nodiscard]] Cell classified(std::int32_t column, std::int32_t row, std::int32_t size) {
        Cell cell{column, row, size, State::free, no_obstacle};
        PlaneSquare square = square_of(cell);
        const double x_low_m = square.x_m - square.half_m, z_low_m = square.z_m - square.half_m;
        if (x_low_m > bounds_.x_high_m || z_low_m > bounds_.z_high_m) {
            cell.state = State::blocked;
            return cell;
        }
        // Of the square counts what lies within the bounds.
        const double half_x_m = std::min(square.half_m, 0.5 * (bounds_.x_high_m - x_low_m));
        const double half_z_m = std::min(square.half_m, 0.5 * (bounds_.z_high_m - z_low_m));
        square.x_m = x_low_m + half_x_m;
        square.z_m = z_low_m + half_z_m;
        const double off_m = std::hypot(half_x_m, half_z_m);  // of a centre in there from its middle
        for (const Core& core : cores_) {
            if (core.radius_m <= off_m) {
                continue;
            }
            // The core contains this cylinder wherever it is in the square.
            ++queries_;
            if (const auto nearest = solids_.nearest(placed(core, square, core.radius_m - off_m), contact_m)) {
                cell.state = State::blocked;
                cell.obstacle = nearest->obstacle;
                return cell;
            }
        }
        for (const Core& core : cores_) {
            ++queries_;
            if (solids_.are_near(placed(core, square, core.radius_m + off_m), contact_m)) {
                cell.state = State::mixed;
                break;
            }
        }
        return cell;
    }

    const SceneSolids& solids_;
    const PlaneOfMotion& plane_;
    std::vector<Core> cores_;
    Bounds bounds_;
    double cell_m_;                       ///< side of the smallest squares
    std::vector<Cell> cells_;             ///< they cover the whole
    std::vector<std::uint32_t> cell_at_;  ///< numbers of the cells by smallest squares, row by row
    std::size_t queries_ = 0;
};

bool reaches(const PartedPlane& plane, const std::vector<std::size_t>& cells, const MayBeIn& region) {
    return std::any_of(cells.begin(), cells.end(),
                       [&](std::size_t number) { return region(plane.square_of(plane.cell(number))); });
}

/// A set of obstacles, none of which can be left out, that parts a region from a cell.
/// @param around cells that the cell connects to
std::vector<std::size_t> parting_obstacles(const PartedPlane& plane, std::size_t from,
                                           const std::vector<std::size_t>& around, const MayBeIn& region) {
    std::vector<std::pair<std::size_t, std::size_t>> by_count;  // those that block least come first
    for (const auto& [obstacle, count] : plane.blocking_beside(around)) {
        by_count.emplace_back(count, obstacle);
    }
    std::sort(by_count.begin(), by_count.end());
    std::vector<std::size_t> kept;
    kept.reserve(by_count.size());
    for (const auto& [count, obstacle] : by_count) {
        kept.push_back(obstacle);
    }
    const auto part = [&](const std::vector<std::size_t>& obstacles) {
        const std::set<std::size_t> left(obstacles.begin(), obstacles.end());
        const auto may_pass = [&](const Cell& cell) {
            return cell.state != State::blocked || (cell.obstacle != no_obstacle && !left.contains(cell.obstacle));
        };
        return !reaches(plane, plane.connected(from, may_pass), region);
    };
    constexpr std::size_t max_tries = 64;
    std::size_t first = 0;
    for (std::size_t tries = 0; tries < max_tries && first < kept.size(); ++tries) {
        std::vector<std::size_t> fewer = kept;
        fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(first));
        if (part(fewer)) {
            kept = std::move(fewer);
        } else {
            ++first;
        }
    }
    std::sort(kept.begin(), kept.end());
    return kept;
}

}  // namespace

std::vector<CutOffRegion> cut_off_regions(const Scene& scene, const PlaneOfMotion& plane, const RobotShape& robot,
                                          const Bounds& bounds, double start_x_m, double start_z_m,
                                          std::span<const MayBeIn> regions) {
    std::vector<Core> cores = cores_of(robot);
    if (cores.empty() || scene.obstacles().empty()) {
        return {};
    }
    PartedPlane parted(scene, plane, std::move(cores), bounds);
    const auto is_open = [](const Cell& cell) { return cell.state != State::blocked; };
    const auto is_free = [](const Cell& cell) { return cell.state == State::free; };
    std::vector<std::size_t> asked(regions.size());
    for (std::size_t i = 0; i < asked.size(); ++i) {
        asked[i] = i;
    }
    std::vector<CutOffRegion> cut_off;
    while (!asked.empty()) {
        const std::size_t start = parted.cell_at(start_x_m, start_z_m);
        const std::vector<std::size_t> open = parted.connected(start, is_open);
        if (open.empty()) {
            return {};  // the start itself is too near to an obstacle: its check tells that
        }
        const std::vector<std::size_t> free = parted.connected(start, is_free);
        std::erase_if(asked, [&](std::size_t region) {
            if (reaches(parted, free, regions[region])) {
                return true;
            }
            if (reaches(parted, open, regions[region])) {
                return false;
            }
            std::vector<std::size_t> obstacles = parting_obstacles(parted, start, open, regions[region]);
            if (!obstacles.empty()) {
                cut_off.push_back({region, std::move(obstacles)});
            }
            return true;
        });
        if (!parted.halve(open)) {
            break;
        }
    }
    std::ranges::sort(cut_off, {}, &CutOffRegion::region);
    return cut_off;
}

}  // namespace downwash
