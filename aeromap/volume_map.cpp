#include "downwash/aeromap/volume_map.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <utility>

#include "downwash/aeromap/triquadratic.hpp"
#include "downwash/aeromap/volume_builder.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/parallel.hpp"

namespace downwash {
namespace {

constexpr double longest_radii = 0.45;        // of a cell's edge: no obstacle is missed
constexpr std::uint32_t cells_per_brick = 8;  // along each axis

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
        throw_input_error("the volume has more than 2^23 cells; choose it smaller");
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
