#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory_resource>

#include "downwash/aeromap/change_bound.hpp"
#include "downwash/aeromap/known_factors.hpp"
#include "downwash/aeromap/layer_builder.hpp"
#include "downwash/aeromap/volume_bricks.hpp"
#include "downwash/aeromap/volume_map.hpp"
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
/// Beyond that many boxes the rest of a brick is left to direct evaluation. A few hundred are usual, ten thousand
/// among the parts of a mesh.
constexpr std::size_t max_brick_boxes = 65536;
constexpr std::size_t no_axis = 3;

/// Halves the cells of one brick. What it looks at lies on one lattice, so that boxes share their samples.
class BrickBuilder {
 public:
    BrickBuilder(const DirectEffect& effect, const VolumeGrid& grid, std::size_t number)
        : effect_(effect),
          grid_(grid),
          is_of_walls_(effect.is_of_walls_around()),
          // Distances to walls turn where the nearest wall changes, which no cell misses.
          longest_m_(is_of_walls_ ? std::numeric_limits<double>::infinity() : 2 * shortest_turn_m(effect)),
          brick_(std::make_shared<OwnedBrick>()) {
        const auto at = grid.brick_at(number);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            first_[axis] = at[axis] * VolumeBrick::side_cells;
            last_[axis] = std::min(first_[axis] + VolumeBrick::side_cells, grid.cells[axis]);
        }
    }

    std::shared_ptr<const OwnedBrick> brick() {
        Box whole{{}, {}};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            whole.edges[axis] = (last_[axis] - first_[axis]) * cell_edge;
        }
        is_calm_ = is_quiet(whole);
        if (is_calm_ && margin_m(whole) >= effect_.rotor_radius_m() + half_diagonal_m(whole)) {
            return nullptr;
        }
        constexpr std::uint32_t side = VolumeBrick::side_cells;
        for (std::uint32_t k = 0; k < last_[2] - first_[2]; ++k) {
            for (std::uint32_t j = 0; j < last_[1] - first_[1]; ++j) {
                for (std::uint32_t i = 0; i < last_[0] - first_[0]; ++i) {
                    const Box cell{{i * cell_edge, j * cell_edge, k * cell_edge}, {cell_edge, cell_edge, cell_edge}};
                    brick_->cells[(k * side + j) * side + i] = node_of(cell);
                }
            }
        }
        brick_->seal();
        return brick_;
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

    /// What a box, or what it is halved into, is.
    VolumeNode node_of(const Box& box) {
        const double margin = margin_m(box);
        const double reach_m = half_diagonal_m(box) + clearance_slack_m;
        const auto kept_m = static_cast<float>(kept_margin_m(margin));
        SidedChange change{};
        if (is_calm_ || margin + reach_m < 0 || is_quiet(box, change)) {
            return VolumeNode::of(Kind::calm, 0, kept_m);
        }
        std::size_t axis = too_long(box);
        if (axis == no_axis) {
            const Fit fit = fit_of(box, is_of_walls_ ? CellSides::both : sides_of(change));
            axis = missed_axis(box, fit);
            if (axis == no_axis) {
                return VolumeNode::of(kind_of(fit.sides), index_of(fit), kept_m);
            }
        }
        if (box.edges[axis] <= (is_of_walls_ ? shortest_edge_of_walls : shortest_edge) || boxes_ >= max_brick_boxes) {
            return VolumeNode::of(Kind::direct, 0, kept_m);
        }
        ++boxes_;
        const std::size_t lower = brick_->all_nodes.size();
        brick_->all_nodes.resize(lower + 2);
        Box half = box;
        half.edges[axis] /= 2;
        for (std::size_t which = 0; which < 2; ++which) {
            const VolumeNode of_half = node_of(half);
            brick_->all_nodes[lower + which] = of_half;
            half.low[axis] += half.edges[axis];
        }
        return VolumeNode::of(static_cast<Kind>(axis), static_cast<std::uint32_t>(lower), 0);
    }

    static Kind kind_of(CellSides sides) {
        return sides == CellSides::both ? Kind::both : sides == CellSides::above ? Kind::above : Kind::below;
    }

    /// Of the polynomials, which boxes with the same values share.
    std::uint32_t index_of(const Fit& fit) {
        auto& all = brick_->all_polynomials;
        const auto [place, is_new] =
            known_fits_.try_emplace({fit.all, fit.above}, static_cast<std::uint32_t>(all.size()));
        if (is_new) {
            all.push_back(fit.all);
            if (fit.sides == CellSides::both) {
                all.push_back(fit.above);
            }
        }
        return place->second;
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

    SidedFactor<double> value(const Point& point) {
        const std::uint64_t key =
            (std::uint64_t{point[2]} << 2 * bits_per_axis) + (std::uint64_t{point[1]} << bits_per_axis) + point[0];
        return known_.find_or_add(key, [&] { return direct_value(effect_, hub_m(point)); });
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
    bool is_calm_ = false;    ///< the whole brick
    std::size_t boxes_ = VolumeBrick::cell_count;
    std::shared_ptr<OwnedBrick> brick_;
    std::map<std::array<Triquadratic, 2>, std::uint32_t> known_fits_;
    KnownFactors known_;  ///< at points of the lattice
};

}  // namespace

void OwnedBrick::seal() {
    all_nodes.shrink_to_fit();
    all_polynomials.shrink_to_fit();
    nodes = all_nodes.data();
    polynomials = all_polynomials.data();
    nodes_size = static_cast<std::uint32_t>(all_nodes.size());
    polynomials_size = static_cast<std::uint32_t>(all_polynomials.size());
}

bool operator==(const VolumeBrick& a, const VolumeBrick& b) {
    const auto are_same = [](const VolumeNode& x, const VolumeNode& y) {
        return x.kind_and_index == y.kind_and_index && x.margin_m == y.margin_m;
    };
    return std::equal(a.cells, a.cells + VolumeBrick::cell_count, b.cells, are_same) &&
           std::equal(a.nodes, a.nodes + a.nodes_size, b.nodes, b.nodes + b.nodes_size, are_same) &&
           std::equal(a.polynomials, a.polynomials + a.polynomials_size, b.polynomials,
                      b.polynomials + b.polynomials_size);
}

std::shared_ptr<const OwnedBrick> make_brick(const DirectEffect& effect, const VolumeGrid& grid, std::size_t number) {
    return BrickBuilder(effect, grid, number).brick();
}

}  // namespace downwash
