#include "downwash/aeromap/volume_map.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <unordered_map>
#include <utility>

#include "downwash/aeromap/change_bound.hpp"
#include "downwash/aeromap/layer_builder.hpp"
#include "downwash/aeromap/triquadratic.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/scene/collision_checker.hpp"

namespace downwash {
namespace {

constexpr double longest_radii = 0.45;        // of a cell's edge: no obstacle is missed
constexpr std::uint32_t cells_per_brick = 8;  // along each axis

/// The greatest error of the interpolation at the points looked at. Between eighths of an edge a parabola misses up
/// to 1.6 times as much of a kink along it; the rest up to the promised 0.01 is for kinks whose trace at those points a
/// bend hides in part.
constexpr double allowed_error = 0.003;
constexpr std::uint32_t max_halvings = 7;
constexpr std::uint32_t shortest_edge = 8;  // has eighths on the lattice
constexpr std::uint32_t cell_edge = shortest_edge << max_halvings;
constexpr std::uint32_t bits_per_axis = 21;

void require_valid(const Bounds& extent, double lateral_low_m, double lateral_high_m) {
    const auto require_range = [](double low_m, double high_m, const char* axis) {
        if (!(std::isfinite(low_m) && std::isfinite(high_m) && low_m < high_m)) {
            throw_input_error(std::string("the volume's ") + axis + " must be two finite numbers, the lower one first");
        }
    };
    require_range(extent.x_low_m, extent.x_high_m, "x");
    require_range(lateral_low_m, lateral_high_m, "lateral");
    require_range(extent.z_low_m, extent.z_high_m, "z");
}

}  // namespace

/// Halves the cells in one brick of a volume. What it looks at lies on one lattice, so that boxes share their samples.
class VolumeMap::Builder {
 public:
    /// The cells from `first` to before `last`.
    /// @param boxes of the whole volume, counted on
    Builder(const VolumeMap& volume, const Cell& first, const Cell& last, std::atomic<std::size_t>& boxes)
        : volume_(volume),
          effect_(*volume.effect_),
          first_(first),
          last_(last),
          boxes_(boxes),
          longest_m_(2 * shortest_turn_m(effect_)) {}

    /// @throws InputError when the volume has too many boxes
    void build() {
        nodes_.resize((last_[0] - first_[0]) * (last_[1] - first_[1]) * (last_[2] - first_[2]));
        polynomials_.resize(1);
        std::size_t node = 0;
        for (std::size_t k = first_[2]; k < last_[2]; ++k) {
            for (std::size_t j = first_[1]; j < last_[1]; ++j) {
                for (std::size_t i = first_[0]; i < last_[0]; ++i) {
                    const auto along = [](std::size_t cell, std::size_t first) {
                        return static_cast<std::uint32_t>(cell - first) * cell_edge;
                    };
                    const Point low{along(i, first_[0]), along(j, first_[1]), along(k, first_[2])};
                    fill(node++, {low, {cell_edge, cell_edge, cell_edge}}, false);
                }
            }
        }
        known_ = {};
    }

    /// Frees what build() made.
    void clear() noexcept {
        nodes_ = {};
        polynomials_ = {};
    }

    [[nodiscard]] const Cell& first() const noexcept { return first_; }
    [[nodiscard]] const Cell& last() const noexcept { return last_; }
    /// First those of the cells, x running fastest; indices within the brick.
    [[nodiscard]] const std::vector<Node>& nodes() const noexcept { return nodes_; }
    /// The first one stays unused, as in the volume.
    [[nodiscard]] const std::vector<Coefficients>& polynomials() const noexcept { return polynomials_; }

 private:
    using Point = std::array<std::uint32_t, 3>;  ///< a point of the lattice, from the brick's low corner
    struct Box {
        Point low, edges;
        [[nodiscard]] Point at(std::uint32_t i, std::uint32_t j, std::uint32_t k, std::uint32_t parts) const {
            return {low[0] + i * (edges[0] / parts), low[1] + j * (edges[1] / parts), low[2] + k * (edges[2] / parts)};
        }
    };

    /// @param is_flyable whether the whole box is known to be
    void fill(std::size_t node, const Box& box, bool is_flyable) {
        nodes_[node] = {no_axis, 0};
        if (is_quiet(box)) {
            return;
        }
        if (!is_flyable) {
            // Moving the disc by d changes its clearance by at most d.
            const Vector3 edges = edges_m(box);
            const double reach_m = 0.5 * std::sqrt(dot(edges, edges)) + clearance_slack_m;
            const double clearance_m =
                disc_clearance_m(effect_.scene(), hub_m(box.at(1, 1, 1, 2)), effect_.rotor_radius_m());
            if (clearance_m + reach_m < effect_.min_clearance_m()) {
                return;
            }
            is_flyable = clearance_m - reach_m >= effect_.min_clearance_m();
        }
        std::size_t axis = too_long(box);
        if (axis == no_axis) {
            const Coefficients k = polynomial(box);
            axis = missed_axis(box, k);
            if (axis == no_axis) {
                nodes_[node].index = static_cast<std::uint32_t>(polynomials_.size());
                polynomials_.push_back(k);
                return;
            }
        }
        if (++boxes_ > max_volume_boxes) {
            throw_input_error("the volume needs more than 2^23 boxes; choose a smaller one");
        }
        const std::size_t lower = nodes_.size();
        nodes_[node] = {static_cast<std::uint32_t>(axis), static_cast<std::uint32_t>(lower)};
        nodes_.resize(lower + 2);
        Box half = box;
        half.edges[axis] /= 2;
        fill(lower, half, is_flyable);
        half.low[axis] += half.edges[axis];
        fill(lower + 1, half, is_flyable);
    }

    [[nodiscard]] bool is_quiet(const Box& box) const {
        const Vector3 first = hub_m(box.low);
        BoundingBox hubs{first, first};
        for (std::uint32_t corner = 1; corner < 8; ++corner) {
            const Vector3 hub = hub_m(box.at(corner & 1U, corner >> 1U & 1U, corner >> 2U, 1));
            hubs.include({hub, hub});
        }
        return downwash::is_quiet(effect_, max_change(effect_, hubs));
    }

    /// The longest edge, when K could turn unseen along it.
    [[nodiscard]] std::size_t too_long(const Box& box) const {
        const Vector3 edges = edges_m(box);
        const auto longest = static_cast<std::size_t>(std::max_element(edges.begin(), edges.end()) - edges.begin());
        return edges[longest] > longest_m_ && box.edges[longest] > shortest_edge ? longest : no_axis;
    }

    /// The axis along which the interpolation misses most, if it misses too much anywhere and may be mended.
    std::size_t missed_axis(const Box& box, const Coefficients& polynomial) {
        std::array<double, 3> along{};
        const auto look = [&](std::size_t axis, std::uint32_t part, std::uint32_t next, std::uint32_t after) {
            Point parts{};
            parts[axis] = part;
            parts[(axis + 1) % 3] = next;
            parts[(axis + 2) % 3] = after;
            along[axis] = std::max(along[axis], missed(box, polynomial, parts));
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
                error = missed(box, polynomial, {part(0), part(1), part(2)});
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
        const auto worst = static_cast<std::size_t>(std::max_element(along.begin(), along.end()) - along.begin());
        return box.edges[worst] > shortest_edge ? worst : no_axis;
    }

    /// @param eighths of the edges
    double missed(const Box& box, const Coefficients& polynomial, const Point& eighths) {
        const auto part = [&](std::size_t axis) { return 0.125 * eighths[axis]; };
        return std::abs(factor(box.at(eighths[0], eighths[1], eighths[2], 8)) -
                        value_at(polynomial, {part(0), part(1), part(2)}));
    }

    Coefficients polynomial(const Box& box) {
        std::array<double, 27> samples{};
        for (std::uint32_t n = 0; n < samples.size(); ++n) {
            samples[n] = factor(box.at(n % 3, n / 3 % 3, n / 9, 2));
        }
        return triquadratic_through(samples);
    }

    double factor(const Point& point) {
        const std::uint64_t key =
            (std::uint64_t{point[2]} << 2 * bits_per_axis) + (std::uint64_t{point[1]} << bits_per_axis) + point[0];
        const auto [known, is_new] = known_.try_emplace(key);
        if (is_new) {
            known->second = effect_.factor(hub_m(point));
        }
        return known->second;
    }

    [[nodiscard]] Vector3 hub_m(const Point& point) const {
        Vector3 at{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double cells = static_cast<double>(first_[axis]) + static_cast<double>(point[axis]) / cell_edge;
            at[axis] = volume_.low_m_[axis] + cells * volume_.cell_m_[axis];
        }
        return volume_.frame_.to_world(at[0], at[1], at[2]);
    }

    [[nodiscard]] Vector3 edges_m(const Box& box) const {
        const auto edge_m = [&](std::size_t axis) {
            return static_cast<double>(box.edges[axis]) / cell_edge * volume_.cell_m_[axis];
        };
        return {edge_m(0), edge_m(1), edge_m(2)};
    }

    const VolumeMap& volume_;
    const DirectEffect& effect_;
    Cell first_, last_;
    std::atomic<std::size_t>& boxes_;
    double longest_m_;
    std::vector<Node> nodes_;
    std::vector<Coefficients> polynomials_;
    std::unordered_map<std::uint64_t, double> known_;  ///< K at points of the lattice
};

VolumeMap::VolumeMap(std::shared_ptr<const DirectEffect> effect, const PlaneOfMotion& frame, const Bounds& extent,
                     double lateral_low_m, double lateral_high_m, int threads,
                     const std::function<void(double)>& on_progress)
    : effect_(std::move(effect)),
      frame_(frame),
      low_m_{extent.x_low_m, lateral_low_m, extent.z_low_m},
      high_m_{extent.x_high_m, lateral_high_m, extent.z_high_m} {
    require_valid(extent, lateral_low_m, lateral_high_m);
    std::array<double, 3> cells{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double length_m = high_m_[axis] - low_m_[axis];
        cells[axis] = std::max(1.0, std::ceil(length_m / (longest_radii * effect_->rotor_radius_m())));
        cell_m_[axis] = length_m / cells[axis];
        cells_per_m_[axis] = cells[axis] / length_m;
    }
    if (!(cells[0] * cells[1] * cells[2] <= static_cast<double>(max_volume_boxes))) {
        throw_input_error("the volume has more than 2^23 cells; choose a smaller one");
    }
    std::transform(cells.begin(), cells.end(), cells_.begin(),
                   [](double count) { return static_cast<std::uint32_t>(count); });
    build(threads, on_progress);
}

void VolumeMap::build(int threads, const std::function<void(double)>& on_progress) {
    std::atomic<std::size_t> boxes{cells_[0] * cells_[1] * cells_[2]};
    std::vector<Builder> bricks;
    Cell first{};
    for (first[2] = 0; first[2] < cells_[2]; first[2] += cells_per_brick) {
        for (first[1] = 0; first[1] < cells_[1]; first[1] += cells_per_brick) {
            for (first[0] = 0; first[0] < cells_[0]; first[0] += cells_per_brick) {
                Cell last{};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    last[axis] = std::min(first[axis] + cells_per_brick, cells_[axis]);
                }
                bricks.emplace_back(*this, first, last, boxes);
            }
        }
    }
    run_parallel(
        bricks.size(), threads, [&](std::size_t brick) { bricks[brick].build(); }, on_progress);
    nodes_.resize(cells_[0] * cells_[1] * cells_[2]);
    polynomials_.resize(1);  // index 0 stands for K = 1
    KnownPolynomials known;
    for (Builder& brick : bricks) {
        append(brick, known);
        brick.clear();
    }
    nodes_.shrink_to_fit();
    polynomials_.shrink_to_fit();
}

void VolumeMap::append(const Builder& brick, KnownPolynomials& known) {
    const Cell& first = brick.first();
    const Cell& last = brick.last();
    const std::uint32_t columns = last[0] - first[0];
    const std::uint32_t rows = last[1] - first[1];
    const std::uint32_t cells = columns * rows * (last[2] - first[2]);
    // The nodes of cells go to their places, the others to the end.
    const std::size_t nodes_before = nodes_.size() - cells;
    for (std::uint32_t n = 0; n < brick.nodes().size(); ++n) {
        Node node = brick.nodes()[n];
        if (node.axis != no_axis) {
            node.index = static_cast<std::uint32_t>(node.index + nodes_before);
        } else if (node.index > 0) {
            const Coefficients& polynomial = brick.polynomials()[node.index];
            const auto [place, is_new] = known.try_emplace(polynomial, static_cast<std::uint32_t>(polynomials_.size()));
            if (is_new) {
                polynomials_.push_back(polynomial);
            }
            node.index = place->second;
        }
        if (n < cells) {
            const Cell cell{first[0] + n % columns, first[1] + n / columns % rows, first[2] + n / (columns * rows)};
            nodes_[node_of(cell)] = node;
        } else {
            nodes_.push_back(node);
        }
    }
}

double VolumeMap::factor(const Vector3& hub_m) const {
    const Vector3 local_m = frame_.from_world(hub_m);
    Cell cell{};
    std::array<double, 3> part{};  // of the way through the box
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double cells = (local_m[axis] - low_m_[axis]) * cells_per_m_[axis];
        if (!(cells >= 0 && local_m[axis] <= high_m_[axis])) {  // NaN too
            return effect_->factor(hub_m);
        }
        cell[axis] = std::min(static_cast<std::uint32_t>(cells), cells_[axis] - 1);
        part[axis] = cells - cell[axis];
    }
    Node node = nodes_[node_of(cell)];
    while (node.axis != no_axis) {
        const double halves = 2 * part[node.axis];
        const bool is_upper = halves >= 1;
        part[node.axis] = is_upper ? halves - 1 : halves;
        node = nodes_[node.index + (is_upper ? 1 : 0)];
    }
    return node.index == 0 ? 1 : value_at(polynomials_[node.index], part);
}

std::size_t VolumeMap::memory_bytes() const noexcept {
    return sizeof(*this) + nodes_.capacity() * sizeof(Node) + polynomials_.capacity() * sizeof(Coefficients);
}

}  // namespace downwash
