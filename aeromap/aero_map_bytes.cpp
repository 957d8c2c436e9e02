#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/aeromap/cell_refinement.hpp"
#include "downwash/aeromap/factor_patches.hpp"
#include "downwash/grids/factor_grid.hpp"

// A map as bytes: the counts of layers, columns and rows; then of every layer the number of the first one that holds
// the same values and, if that is itself, the count of its nodes, the cells, their flyability and sides, the nodes.

namespace downwash {
namespace {

template <class Element>
void append(std::string& bytes, const Element* elements, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<Element>);
    bytes.append(reinterpret_cast<const char*>(elements), count * sizeof(Element));
}

void append_count(std::string& bytes, std::uint64_t count) {
    append(bytes, &count, 1);
}

/// Moves so many elements from the front of the bytes into a vector. False, and nothing allocated, when there are less.
template <class Element>
bool take(std::string_view& bytes, std::uint64_t count, std::vector<Element>& elements) {
    static_assert(std::is_trivially_copyable_v<Element>);
    if (count > bytes.size() / sizeof(Element)) {
        return false;
    }
    elements.resize(count);
    if (count > 0) {
        std::memcpy(elements.data(), bytes.data(), count * sizeof(Element));
    }
    bytes.remove_prefix(count * sizeof(Element));
    return true;
}

bool take_count(std::string_view& bytes, std::uint64_t& count) {
    std::vector<std::uint64_t> one;
    if (!take(bytes, 1, one)) {
        return false;
    }
    count = one[0];
    return true;
}

/// A power of two. std::has_single_bit calls a function where it may not count on an instruction.
bool is_step_count(unsigned steps) {
    return steps > 0 && (steps & (steps - 1)) == 0 && steps <= max_steps;
}

}  // namespace

std::string AeroMap::to_bytes() const {
    static_assert(sizeof(MapCell) == 8, "no bytes between the members");
    std::string bytes;
    bytes.reserve(memory_bytes());
    append_count(bytes, rasters_.size());
    append_count(bytes, columns_);
    append_count(bytes, rows_);
    for (std::size_t layer = 0; layer < rasters_.size(); ++layer) {
        const std::shared_ptr<const Raster>& raster = rasters_[layer];
        const auto first =
            static_cast<std::size_t>(std::find(rasters_.begin(), rasters_.end(), raster) - rasters_.begin());
        append_count(bytes, first);
        if (first < layer) {
            continue;
        }
        append_count(bytes, raster->nodes.size());
        append(bytes, raster->cells.data(), raster->cells.size());
        append(bytes, raster->flyability.data(), raster->flyability.size());
        append(bytes, raster->sides.data(), raster->sides.size());
        append(bytes, raster->nodes.data(), raster->nodes.size());
    }
    return bytes;
}

std::optional<AeroMap> AeroMap::from_bytes(std::vector<MapLayer> layers, const PlaneOfMotion& plane,
                                           const Bounds& extent, std::string_view bytes) {
    AeroMap map(Empty(), std::move(layers), plane, extent);
    std::uint64_t layer_count = 0;
    std::uint64_t columns = 0;
    std::uint64_t rows = 0;
    if (!take_count(bytes, layer_count) || !take_count(bytes, columns) || !take_count(bytes, rows) ||
        layer_count != map.layers_.size() || columns != map.columns_ || rows != map.rows_) {
        return std::nullopt;
    }
    for (std::size_t layer = 0; layer < map.layers_.size(); ++layer) {
        std::uint64_t first = 0;
        if (!take_count(bytes, first) || first > layer) {
            return std::nullopt;
        }
        if (first < layer) {
            map.rasters_.push_back(map.rasters_[first]);
        } else {
            Raster raster;
            std::uint64_t nodes = 0;
            if (!take_count(bytes, nodes) || !take(bytes, columns * rows, raster.cells) ||
                !take(bytes, columns * rows, raster.flyability) || !take(bytes, columns * rows, raster.sides) ||
                !take(bytes, nodes, raster.nodes) || !map.is_sound(raster)) {
                return std::nullopt;
            }
            map.add_raster(std::move(raster));
        }
        if (!map.agrees_with_effect(layer)) {
            return std::nullopt;
        }
    }
    return bytes.empty() ? std::optional(std::move(map)) : std::nullopt;
}

/// Whether look-ups stay within the raster and find numbers there.
bool AeroMap::is_sound(const Raster& raster) const {
    const auto is_cell = [&raster](const MapCell& cell, CellSides sides) {
        const std::size_t kinds = sides == CellSides::both ? 2 : 1;
        return sides <= CellSides::both && is_step_count(cell.steps_x) && is_step_count(cell.steps_z) &&
               cell.first_node + kinds * node_count(cell) <= raster.nodes.size();
    };
    const auto is_verdict = [](CellFlyability flyability) { return flyability <= CellFlyability::mixed; };
    const AeroSettings& settings = layers_.front().effect->settings();
    const auto max = static_cast<float>(settings.map ? max_grid_factor : std::max(2.0, 2 * settings.max_factor));
    // Counted and not searched for, so that several are looked at at once. NaN fails.
    const auto factors = std::count_if(raster.nodes.begin(), raster.nodes.end(),
                                       [max](float value) { return value >= 0 && value <= max; });
    return std::equal(raster.cells.begin(), raster.cells.end(), raster.sides.begin(), is_cell) &&
           std::all_of(raster.flyability.begin(), raster.flyability.end(), is_verdict) &&
           static_cast<std::size_t>(factors) == raster.nodes.size();
}

/// Evaluates K again at the lower corners of some cells where surfaces have an effect and nothing was interpolated.
/// This notices changes of models or integration without a new map_format_version.
bool AeroMap::agrees_with_effect(std::size_t layer) const {
    constexpr std::size_t samples = 64;
    const auto& [cells, flyability, sides, nodes] = *rasters_[layer];
    std::vector<std::size_t> felt;
    for (std::size_t row = 0; row < rows_; row += FactorPatches::block_cells) {
        for (std::size_t column = 0; column < columns_; column += FactorPatches::block_cells) {
            const std::size_t cell = row * columns_ + column;
            if (flyability[cell] == CellFlyability::flyable && nodes[cells[cell].first_node] != 1.0F) {
                felt.push_back(cell);
            }
        }
    }
    const std::size_t stride = std::max<std::size_t>(1, felt.size() / samples);
    for (std::size_t n = 0; n < felt.size(); n += stride) {
        const std::size_t column = felt[n] % columns_;
        const std::size_t row = felt[n] / columns_;
        const double x_m = extent_.x_low_m + static_cast<double>(column) * cell_m_;
        const double z_m = extent_.z_low_m + static_cast<double>(row) * cell_m_;
        const double now = layers_[layer].effect->factor(plane_.to_world(x_m, layers_[layer].lateral_m, z_m));
        if (nodes[cells[felt[n]].first_node] != static_cast<float>(now)) {
            return false;
        }
    }
    return true;
}

}  // namespace downwash
