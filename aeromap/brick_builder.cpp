#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory_resource>
#include <optional>
#include <utility>

#include "downwash/aeromap/change_bound.hpp"
#include "downwash/aeromap/known_factors.hpp"
#include "downwash/aeromap/layer_builder.hpp"
#include "downwash/aeromap/same_along.hpp"
#include "downwash/aeromap/volume_bricks.hpp"
#include "downwash/scene/collision_checker.hpp"

namespace downwash {
namespace {

using Kind = VolumeNodeKind;

/// The greatest error of the interpolation at the points looked at. Between eighths of an edge a parabola misses up
/// to 1.6 times as much of a kink along it; the rest up to the promised 0.01 is for kinks whose trace at those points a
/// bend hides in part.
constexpr double allowed_error = 0.003;
constexpr std::uint32_t max_halvings = 7;
constexpr std::uint32_t shortest_edge = 8;  // has eighths on the lattice
constexpr std::uint32_t cell_edge = shortest_edge << max_halvings;
/// Beside the ends of walls the vector towards them jumps, which no halving mends.
constexpr std::uint32_t shortest_edge_of_walls = cell_edge / 4;
constexpr std::uint32_t bits_per_axis = 21;
/// A box is no smaller than its cell halved that many times, across whichever axes: among the parts of a mesh more
/// halvings are worth less than direct evaluation.
constexpr int max_depth = 16;
constexpr std::size_t no_axis = 3;

/// Looks into the cells of one brick. What it looks at lies on one lattice, so that boxes share their samples.
class BrickBuilder {
 public:
    BrickBuilder(const DirectEffect& effect, const VolumeGrid& grid, std::size_t number, OwnedBrick& brick)
        : effect_(effect),
          grid_(grid),
          is_of_walls_(effect.is_of_walls_around()),
          // Distances to walls turn where the nearest wall changes, which no cell misses.
          longest_m_(is_of_walls_ ? std::numeric_limits<double>::infinity() : 2 * shortest_turn_m(effect)),
          brick_(brick) {
        const auto at = grid.brick_at(number);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            first_[axis] = at[axis] * VolumeBrick::side_cells;
            last_[axis] = std::min(first_[axis] + VolumeBrick::side_cells, grid.cells[axis]);
        }
    }

    /// What is the same for the whole brick. @return false where a brick is not needed
    bool look_at_whole() {
        Box whole{{}, {}};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            whole.edges[axis] = (last_[axis] - first_[axis]) * cell_edge;
        }
        brick_.is_calm = is_quiet(whole);
        if (brick_.is_calm) {
            return margin_m(whole) < effect_.rotor_radius_m() + half_diagonal_m(whole);
        }
        brick_.same_along = same_along(effect_, grid_.frame, hubs_in(whole));
        return true;
    }

    /// Makes the box around a place known.
    void explore(const PlaceInBrick& place) {
        enter_cell(place.cell);
        Box box = cell(place.cell);
        VolumeNode* node = &brick_.cells[place.cell];
        auto part = std::to_array(place.part);
        for (int depth = 0;; ++depth) {
            if (node->kind == Kind::unknown) {
                brick_.publish(*node, node_of(box, depth));
            }
            if (!is_halving(node->kind)) {
                return;
            }
            const auto axis = static_cast<std::size_t>(node->kind);
            const bool is_upper = 2 * part[axis] >= 1;
            part[axis] = 2 * part[axis] - (is_upper ? 1 : 0);
            box = half_of(box, axis, is_upper);
            node = node->halves + (is_upper ? 1 : 0);
        }
    }

    void explore_all() {
        constexpr std::uint32_t side = VolumeBrick::side_cells;
        for (std::uint32_t number = 0; number < VolumeBrick::cell_count; ++number) {
            const std::array<std::uint32_t, 3> at{number % side, number / side % side, number / side / side};
            if (first_[0] + at[0] < last_[0] && first_[1] + at[1] < last_[1] && first_[2] + at[2] < last_[2]) {
                enter_cell(number);
                explore_all(brick_.cells[number], cell(number), 0);
            }
        }
    }

    /// Whether the first box of another brick that has a polynomial has it from the effect of today.
    bool agrees(const VolumeBrick& other) {
        for (std::uint32_t number = 0; number < VolumeBrick::cell_count; ++number) {
            Box box = cell(number);
            if (const VolumeNode* node = first_polynomial(other.cells[number], box)) {
                enter_cell(number);
                return node->polynomials[0][0] == static_cast<float>(value(box.low).all);
            }
        }
        return true;
    }

 private:
    using Point = std::array<std::uint32_t, 3>;  ///< a point of the lattice, from the brick's low corner
    struct Box {
        Point low, edges;
        [[nodiscard]] Point at(std::uint32_t i, std::uint32_t j, std::uint32_t k, std::uint32_t parts) const {
            return {low[0] + i * (edges[0] / parts), low[1] + j * (edges[1] / parts), low[2] + k * (edges[2] / parts)};
        }
    };
    /// Polynomials of K and of its part from above. One of them is not used where one side is all that matters.
    struct Fit {
        CellSides sides;
        Triquadratic all, above;
    };

    static Box cell(std::uint32_t number) {
        constexpr std::uint32_t side = VolumeBrick::side_cells;
        return {{number % side * cell_edge, number / side % side * cell_edge, number / side / side * cell_edge},
                {cell_edge, cell_edge, cell_edge}};
    }
    static Box half_of(Box box, std::size_t axis, bool is_upper) {
        box.edges[axis] /= 2;
        box.low[axis] += is_upper ? box.edges[axis] : 0;
        return box;
    }

    /// @param[in,out] box of the node; then of the one that is found
    static const VolumeNode* first_polynomial(const VolumeNode& node, Box& box) {
        const VolumeNodeKind kind = kind_of(node);
        if (!is_halving(kind)) {
            return kind == Kind::below || kind == Kind::above || kind == Kind::both ? &node : nullptr;
        }
        for (const bool is_upper : {false, true}) {
            Box half = half_of(box, static_cast<std::size_t>(kind), is_upper);
            if (const VolumeNode* found = first_polynomial(node.halves[is_upper ? 1 : 0], half)) {
                box = half;
                return found;
            }
        }
        return nullptr;
    }

    void explore_all(VolumeNode& node, const Box& box, int depth) {
        if (node.kind == Kind::unknown) {
            brick_.publish(node, node_of(box, depth));
        }
        if (is_halving(node.kind)) {
            for (const bool is_upper : {false, true}) {
                explore_all(node.halves[is_upper ? 1 : 0], half_of(box, static_cast<std::size_t>(node.kind), is_upper),
                            depth + 1);
            }
        }
    }

    void enter_cell(std::uint32_t number) {
        cell_low_ = cell(number).low;
        same_along_.reset();
    }

    /// Finds out what a box is.
    VolumeNode node_of(const Box& box, int depth) {
        const double margin = margin_m(box);
        const double reach_m = half_diagonal_m(box) + clearance_slack_m;
        const auto kept_m = static_cast<float>(kept_margin_m(margin));
        SidedChange change{};
        if (brick_.is_calm || margin + reach_m < 0 || is_quiet(box, change)) {
            return {Kind::calm, kept_m, nullptr, nullptr};
        }
        std::size_t axis = too_long(box);
        if (axis == no_axis) {
            const Fit fit = fit_of(box, is_of_walls_ ? CellSides::both : sides_of(change));
            axis = missed_axis(box, fit);
            if (axis == no_axis) {
                return {kind_of_sides(fit.sides), kept_m, nullptr,
                        fit.sides == CellSides::both ? brick_.keep(fit.all, fit.above) : brick_.keep(fit.all)};
            }
        }
        if (box.edges[axis] <= (is_of_walls_ ? shortest_edge_of_walls : shortest_edge) || depth == max_depth) {
            return {Kind::direct, kept_m, nullptr, nullptr};
        }
        return {static_cast<Kind>(axis), 0, brick_.new_halves(), nullptr};
    }

    static Kind kind_of_sides(CellSides sides) {
        return sides == CellSides::both ? Kind::both : sides == CellSides::above ? Kind::above : Kind::below;
    }

    /// How far the middle of a box is inside the flyable area.
    [[nodiscard]] double margin_m(const Box& box) const {
        const double least_m = effect_.min_clearance_m();
        if (!effect_.settings().enabled || least_m < 0) {
            return std::numeric_limits<double>::infinity();
        }
        return disc_clearance_m(effect_.scene(), hub_m(box.at(1, 1, 1, 2)), effect_.rotor_radius_m()) - least_m;
    }

    /// What look-ups may use of it. A given map may end the flyable area where the scene does not.
    [[nodiscard]] double kept_margin_m(double margin) const {
        const double radius_m = effect_.rotor_radius_m();
        if (effect_.settings().map && effect_.min_clearance_m() >= 0) {
            margin = std::min(margin, 0.0);
        }
        // Neither the clearance nor the rounding to float may promise too much.
        const double surely =
            margin > 0 ? std::max(0.0, margin - 2 * clearance_slack_m) : std::min(0.0, margin + 2 * clearance_slack_m);
        return std::clamp(surely, -radius_m, radius_m);
    }

    [[nodiscard]] bool is_quiet(const Box& box) const {
        SidedChange change{};
        return is_quiet(box, change);
    }
    [[nodiscard]] bool is_quiet(const Box& box, SidedChange& change) const {
        const BoundingBox hubs = hubs_in(box);
        if (is_of_walls_) {
            return !effect_.settings().enabled || has_no_wall_near(hubs);
        }
        change = max_change(effect_, hubs);
        return downwash::is_quiet(effect_, change);
    }

    /// Whether no wall is so near that the vector towards it is longer than 0.006.
    [[nodiscard]] bool has_no_wall_near(const BoundingBox& centers) const {
        constexpr double decays = 5.12;  // exp(-5.12) < 0.006
        const double reach_m =
            effect_.wall_reach_m() + effect_.rotor_radius_m() * (1 + decays * effect_.settings().wall.decay_radii);
        BoundingBox around = centers;
        for (const std::size_t axis : {0U, 1U}) {
            around.low_m[axis] -= reach_m;
            around.high_m[axis] += reach_m;
        }
        std::pmr::vector<std::size_t> parts;
        effect_.scene().add_parts_meeting(around, parts);
        return parts.empty();
    }

    [[nodiscard]] BoundingBox hubs_in(const Box& box) const {
        const Vector3 first = hub_m(box.low);
        BoundingBox hubs{first, first};
        for (std::uint32_t corner = 1; corner < 8; ++corner) {
            const Vector3 hub = hub_m(box.at(corner & 1U, corner >> 1U & 1U, corner >> 2U, 1));
            hubs.include({hub, hub});
        }
        return hubs;
    }

    /// The longest edge, when K could turn unseen along it.
    [[nodiscard]] std::size_t too_long(const Box& box) const {
        const Vector3 edges = edges_m(box);
        const auto longest = static_cast<std::size_t>(std::max_element(edges.begin(), edges.end()) - edges.begin());
        return edges[longest] > longest_m_ && box.edges[longest] > shortest_edge ? longest : no_axis;
    }

    /// The axis along which the interpolation misses most; none where it misses too much nowhere.
    std::size_t missed_axis(const Box& box, const Fit& fit) {
        std::array<double, 3> along{};
        const auto look = [&](std::size_t axis, std::uint32_t part, std::uint32_t next, std::uint32_t after) {
            Point parts{};
            parts[axis] = part;
            parts[(axis + 1) % 3] = next;
            parts[(axis + 2) % 3] = after;
            along[axis] = std::max(along[axis], missed(box, fit, parts));
        };
        const auto is_missed = [&along] { return std::max({along[0], along[1], along[2]}) > allowed_error; };
        for (std::size_t axis = 0; axis < 3; ++axis) {
            look(axis, 2, 4, 4);
            look(axis, 6, 4, 4);
        }
        if (!is_missed()) {
            // Along the edges, which boxes share: kinks at the cap differ in strength from edge to edge.
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (const std::uint32_t part : {1U, 2U, 3U, 5U, 6U, 7U}) {
                    for (std::uint32_t edge = 0; edge < 4; ++edge) {
                        look(axis, part, 8 * (edge & 1U), 8 * (edge >> 1U));
                    }
                }
            }
        }
        if (!is_missed()) {
            double error = 0;
            for (std::uint32_t octant = 0; octant < 8 && error <= allowed_error; ++octant) {
                const auto part = [octant](std::uint32_t axis) { return (octant >> axis & 1U) != 0 ? 6U : 2U; };
                error = missed(box, fit, {part(0), part(1), part(2)});
            }
            if (error <= allowed_error) {
                return no_axis;
            }
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (const std::uint32_t next : {0U, 4U, 8U}) {
                    for (const std::uint32_t after : {0U, 4U, 8U}) {
                        look(axis, 2, next, after);
                        look(axis, 6, next, after);
                    }
                }
            }
        }
        return static_cast<std::size_t>(std::max_element(along.begin(), along.end()) - along.begin());
    }

    /// @param eighths of the edges
    double missed(const Box& box, const Fit& fit, const Point& eighths) {
        const std::array<double, 3> part{0.125 * eighths[0], 0.125 * eighths[1], 0.125 * eighths[2]};
        const SidedFactor<double> there = value(box.at(eighths[0], eighths[1], eighths[2], 8));
        const double of_all = std::abs(there.all - value_at(fit.all, part));
        return fit.sides == CellSides::both ? std::max(of_all, std::abs(there.above - value_at(fit.above, part)))
                                            : of_all;
    }

    Fit fit_of(const Box& box, CellSides sides) {
        std::array<double, 27> all{};
        std::array<double, 27> above{};
        for (std::uint32_t n = 0; n < all.size(); ++n) {
            const SidedFactor<double> there = value(box.at(n % 3, n / 3 % 3, n / 9, 2));
            all[n] = there.all;
            above[n] = there.above;
        }
        return {sides, triquadratic_through(all),
                sides == CellSides::both ? triquadratic_through(above) : Triquadratic{}};
    }

    SidedFactor<double> value(Point point) {
        fold(point);
        const std::uint64_t key =
            (std::uint64_t{point[2]} << 2 * bits_per_axis) + (std::uint64_t{point[1]} << bits_per_axis) + point[0];
        return brick_.samples.find_or_add(key, [&] { return direct_value(effect_, hub_m(point)); });
    }

    /// Along an axis along which K stays the same one point stands for all.
    void fold(Point& point) {
        if (!same_along_) {
            same_along_ = same_along(effect_, grid_.frame, hubs_in({cell_low_, {cell_edge, cell_edge, cell_edge}}));
        }
        const auto fold_one = [&](std::size_t axis, bool in_brick, bool in_cell) {
            point[axis] = in_brick ? 0 : in_cell ? cell_low_[axis] : point[axis];
        };
        fold_one(0, brick_.same_along.x, same_along_->x);
        fold_one(1, brick_.same_along.lateral, same_along_->lateral);
    }

    [[nodiscard]] Vector3 hub_m(const Point& point) const {
        Vector3 at{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double cells = static_cast<double>(first_[axis]) + static_cast<double>(point[axis]) / cell_edge;
            at[axis] = grid_.low_m[axis] + cells * grid_.cell_m[axis];
        }
        return grid_.frame.to_world(at[0], at[1], at[2]);
    }

    [[nodiscard]] Vector3 edges_m(const Box& box) const {
        const auto edge_m = [&](std::size_t axis) {
            return static_cast<double>(box.edges[axis]) / cell_edge * grid_.cell_m[axis];
        };
        return {edge_m(0), edge_m(1), edge_m(2)};
    }
    [[nodiscard]] double half_diagonal_m(const Box& box) const {
        const Vector3 edges = edges_m(box);
        return 0.5 * std::sqrt(dot(edges, edges));
    }

    const DirectEffect& effect_;
    const VolumeGrid& grid_;
    bool is_of_walls_;
    double longest_m_;
    Point first_{}, last_{};  ///< cells, to before the last
    OwnedBrick& brick_;
    Point cell_low_{};                     ///< of the cell that is looked into
    std::optional<SameAlong> same_along_;  ///< in that cell; empty: not looked at
};

}  // namespace

void OwnedBrick::publish(VolumeNode& node, const VolumeNode& content) {
    node.margin_m = content.margin_m;
    node.halves = content.halves;
    node.polynomials = content.polynomials;
    VolumeNodeKind kind = content.kind;
    __atomic_store(&node.kind, &kind, __ATOMIC_RELEASE);
}

const Triquadratic* OwnedBrick::keep(const Triquadratic& all, const Triquadratic& above) {
    return all_pairs.emplace_back(std::array{all, above}).data();
}

std::size_t OwnedBrick::memory_bytes() const {
    return sizeof(*this) + all_halves.size() * sizeof(all_halves.front()) + polynomials() * sizeof(Triquadratic) +
           samples.memory_bytes();
}

std::unique_ptr<OwnedBrick> make_brick(const DirectEffect& effect, const VolumeGrid& grid, std::size_t number) {
    auto brick = std::make_unique<OwnedBrick>();
    return BrickBuilder(effect, grid, number, *brick).look_at_whole() ? std::move(brick) : nullptr;
}

void explore(const DirectEffect& effect, const VolumeGrid& grid, const PlaceInBrick& place, OwnedBrick& brick) {
    BrickBuilder(effect, grid, place.brick, brick).explore(place);
}

void explore_all(const DirectEffect& effect, const VolumeGrid& grid, std::size_t number, OwnedBrick& brick) {
    BrickBuilder(effect, grid, number, brick).explore_all();
}

bool agrees_with_effect(const DirectEffect& effect, const VolumeGrid& grid, std::size_t number,
                        const VolumeBrick& brick) {
    OwnedBrick blank;
    BrickBuilder builder(effect, grid, number, blank);
    return builder.look_at_whole() && builder.agrees(brick);
}

}  // namespace downwash
