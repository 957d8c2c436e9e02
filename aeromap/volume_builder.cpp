#include "downwash/aeromap/volume_builder.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/aeromap/change_bound.hpp"
#include "downwash/aeromap/layer_builder.hpp"
#include "downwash/aeromap/triquadratic.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/scene/collision_checker.hpp"

namespace downwash {
namespace {

/// Of the interpolation at the points looked at. Between eighths of an edge a parabola misses up to 1.6 times as much
/// of a kink along it; the rest up to the promised 0.01 is for kinks whose trace at those points a bend hides in part.
constexpr double allowed_error = 0.003;
constexpr std::uint32_t max_halvings = 7;
constexpr std::uint32_t shortest_edge = 8;  // has eighths on the lattice
constexpr std::uint32_t cell_edge = shortest_edge << max_halvings;
constexpr std::uint32_t bits_per_axis = 21;

}  // namespace

VolumeMap::Builder::Builder(const VolumeMap& volume, const Cell& first, const Cell& last,
                            std::atomic<std::size_t>& boxes)
    : volume_(volume),
      effect_(*volume.effect_),
      first_(first),
      last_(last),
      boxes_(boxes),
      longest_m_(2 * shortest_turn_m(effect_)) {}

void VolumeMap::Builder::build() {
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

/// @param is_flyable whether the whole box is known to be
void VolumeMap::Builder::fill(std::size_t node, const Box& box, bool is_flyable) {
    nodes_[node] = {no_axis, 0};
    if (is_quiet(box)) {
        return;
    }
    if (!is_flyable) {
        // Moving the disc by d changes its clearance by at most d.
        const Vector3 edges = edges_m(box);
        const double reach_m = 0.5 * std::sqrt(dot(edges, edges)) + clearance_slack_m;
        const double clearance_m =
            disc_clearance_m(effect_.scene(), hub_m(box.at(1, 1, 1, 2)), effect_.disc_radius_m());
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
        throw_input_error("the volume needs more than 2^23 boxes; choose it smaller");
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

bool VolumeMap::Builder::is_quiet(const Box& box) const {
    const Vector3 first = hub_m(box.low);
    Scene::Bounds hubs{first, first};
    for (std::uint32_t corner = 1; corner < 8; ++corner) {
        const Vector3 hub = hub_m(box.at(corner & 1U, corner >> 1U & 1U, corner >> 2U, 1));
        hubs.include({hub, hub});
    }
    return downwash::is_quiet(effect_, hubs);
}

/// The longest edge, when K could turn unseen along it.
std::size_t VolumeMap::Builder::too_long(const Box& box) const {
    const Vector3 edges = edges_m(box);
    const auto longest = static_cast<std::size_t>(std::max_element(edges.begin(), edges.end()) - edges.begin());
    return edges[longest] > longest_m_ && box.edges[longest] > shortest_edge ? longest : no_axis;
}

/// The axis along which the interpolation misses most, if it misses too much anywhere and may be mended.
std::size_t VolumeMap::Builder::missed_axis(const Box& box, const Coefficients& polynomial) {
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
double VolumeMap::Builder::missed(const Box& box, const Coefficients& polynomial, const Point& eighths) {
    const auto part = [&](std::size_t axis) { return 0.125 * eighths[axis]; };
    return std::abs(factor(box.at(eighths[0], eighths[1], eighths[2], 8)) -
                    value_at(polynomial, {part(0), part(1), part(2)}));
}

VolumeMap::Coefficients VolumeMap::Builder::polynomial(const Box& box) {
    std::array<double, 27> samples{};
    for (std::uint32_t n = 0; n < samples.size(); ++n) {
        samples[n] = factor(box.at(n % 3, n / 3 % 3, n / 9, 2));
    }
    return triquadratic_through(samples);
}

double VolumeMap::Builder::factor(const Point& point) {
    const std::uint64_t key =
        (std::uint64_t{point[2]} << 2 * bits_per_axis) + (std::uint64_t{point[1]} << bits_per_axis) + point[0];
    const auto [known, is_new] = known_.try_emplace(key);
    if (is_new) {
        known->second = effect_.factor(hub_m(point));
    }
    return known->second;
}

Vector3 VolumeMap::Builder::hub_m(const Point& point) const {
    Vector3 at{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double cells = static_cast<double>(first_[axis]) + static_cast<double>(point[axis]) / cell_edge;
        at[axis] = volume_.low_m_[axis] + cells * volume_.cell_m_[axis];
    }
    return volume_.frame_.to_world(at[0], at[1], at[2]);
}

Vector3 VolumeMap::Builder::edges_m(const Box& box) const {
    const auto edge_m = [&](std::size_t axis) {
        return static_cast<double>(box.edges[axis]) / cell_edge * volume_.cell_m_[axis];
    };
    return {edge_m(0), edge_m(1), edge_m(2)};
}

}  // namespace downwash
