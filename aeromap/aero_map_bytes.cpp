#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/aeromap/cell_refinement.hpp"
#include "downwash/aeromap/map_blocks.hpp"
#include "downwash/aeromap/owned_block.hpp"
#include "downwash/grids/factor_grid.hpp"

// A map as bytes: the counts of layers, columns, rows and blocks that follow; then of every block, in their order, its
// number among those of all layers and the number of the first one that holds the same; if that is itself, the count of
// its nodes, the cells, their flyability and sides, the nodes.

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

/// Moves as many elements as an array has from the front of the bytes into it.
template <class Element, std::size_t count>
bool take_array(std::string_view& bytes, Element (&elements)[count]) {
    static_assert(std::is_trivially_copyable_v<Element>);
    if (sizeof elements > bytes.size()) {
        return false;
    }
    std::memcpy(elements, bytes.data(), sizeof elements);
    bytes.remove_prefix(sizeof elements);
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

/// Whether look-ups stay within the block and find numbers there.
bool is_sound(const OwnedBlock& block, float max_factor) {
    for (std::uint32_t number = 0; number < MapBlock::cell_count; ++number) {
        const MapCell& cell = block.cells[number];
        const std::size_t kinds = block.sides[number] == CellSides::both ? 2 : 1;
        if (!(block.sides[number] <= CellSides::both && block.flyability[number] <= CellFlyability::mixed &&
              is_step_count(cell.steps_x) && is_step_count(cell.steps_z) &&
              cell.first_node + kinds * node_count(cell) <= block.nodes_size)) {
            return false;
        }
    }
    // Counted and not searched for, so that several are looked at at once. NaN fails.
    const auto factors = std::count_if(block.values.begin(), block.values.end(),
                                       [max_factor](float value) { return value >= 0 && value <= max_factor; });
    return static_cast<std::size_t>(factors) == block.values.size();
}

/// Moves the content of a block from the front of the bytes; empty if there is none.
std::shared_ptr<const MapBlock> take_block(std::string_view& bytes, float max_factor) {
    auto block = std::make_shared<OwnedBlock>();
    std::uint64_t nodes = 0;
    if (!take_count(bytes, nodes) || nodes > std::numeric_limits<std::uint32_t>::max() ||
        !take_array(bytes, block->cells) || !take_array(bytes, block->flyability) || !take_array(bytes, block->sides) ||
        !take(bytes, nodes, block->values)) {
        return nullptr;
    }
    block->seal();
    return is_sound(*block, max_factor) ? block : nullptr;
}

}  // namespace

std::string AeroMap::to_bytes() const {
    return bytes_of(blocks_->store().made());
}

std::string AeroMap::take_new_bytes() const {
    const std::vector<std::size_t> slots = blocks_->store().take_new();
    return slots.empty() ? std::string() : bytes_of(slots);
}

std::string AeroMap::bytes_of(const std::vector<std::size_t>& slots) const {
    static_assert(sizeof(MapCell) == 8, "no bytes between the members");
    std::string bytes;
    append_count(bytes, layers().size());
    append_count(bytes, blocks_->columns());
    append_count(bytes, blocks_->rows());
    append_count(bytes, slots.size());
    std::unordered_map<const MapBlock*, std::size_t> written;
    for (const std::size_t slot : slots) {
        const MapBlock& block = *blocks_->store().find(slot);
        const auto [known, is_first] = written.try_emplace(&block, slot);
        append_count(bytes, slot);
        append_count(bytes, known->second);
        if (is_first) {
            append_count(bytes, block.nodes_size);
            append(bytes, block.cells, MapBlock::cell_count);
            append(bytes, block.flyability, MapBlock::cell_count);
            append(bytes, block.sides, MapBlock::cell_count);
            append(bytes, block.nodes, block.nodes_size);
        }
    }
    return bytes;
}

std::optional<AeroMap> AeroMap::from_bytes(std::vector<MapLayer> layers, const PlaneOfMotion& plane,
                                           const Bounds& extent, std::string_view bytes) {
    AeroMap map(std::move(layers), plane, extent);
    return map.add_bytes(bytes) ? std::optional(std::move(map)) : std::nullopt;
}

bool AeroMap::add_bytes(std::string_view bytes) {
    std::uint64_t layer_count = 0;
    std::uint64_t columns = 0;
    std::uint64_t rows = 0;
    std::uint64_t count = 0;
    if (!take_count(bytes, layer_count) || !take_count(bytes, columns) || !take_count(bytes, rows) ||
        !take_count(bytes, count) || layer_count != layers().size() || columns != blocks_->columns() ||
        rows != blocks_->rows() || count > blocks_->store().size()) {
        return false;
    }
    const AeroSettings& settings = layers().front().effect->settings();
    const auto max_factor = static_cast<float>(settings.map ? max_grid_factor : std::max(2.0, 2 * settings.max_factor));
    std::vector<std::size_t> slots;
    std::vector<std::shared_ptr<const MapBlock>> blocks;
    std::unordered_map<std::uint64_t, std::size_t> place_of;  // in these lists
    for (; count > 0; --count) {
        std::uint64_t slot = 0;
        std::uint64_t same_as = 0;
        if (!take_count(bytes, slot) || !take_count(bytes, same_as) || slot >= blocks_->store().size() ||
            (!slots.empty() && slot <= slots.back())) {
            return false;
        }
        if (same_as == slot) {
            blocks.push_back(take_block(bytes, max_factor));
        } else {
            const auto earlier = place_of.find(same_as);
            blocks.push_back(earlier != place_of.end() ? blocks[earlier->second] : nullptr);
        }
        if (blocks.back() == nullptr) {
            return false;
        }
        place_of.emplace(slot, slots.size());
        slots.push_back(slot);
    }
    if (!bytes.empty() || !agrees_with_effect(slots, blocks)) {
        return false;
    }
    for (std::size_t i = 0; i < slots.size(); ++i) {
        blocks_->put(slots[i], blocks[i]);
    }
    return true;
}

/// Evaluates K again at the lower corners of some blocks where surfaces have an effect and nothing was interpolated.
/// This notices changes of models or integration without a new map_format_version.
bool AeroMap::agrees_with_effect(const std::vector<std::size_t>& slots,
                                 const std::vector<std::shared_ptr<const MapBlock>>& blocks) const {
    constexpr std::size_t samples = 64;
    std::vector<std::vector<std::size_t>> felt(layers().size());  // places in the lists
    const auto value_of = [&blocks](std::size_t place) {
        return blocks[place]->nodes[blocks[place]->cells[0].first_node];
    };
    for (std::size_t place = 0; place < slots.size(); ++place) {
        if (blocks[place]->flyability[0] == CellFlyability::flyable && value_of(place) != 1.0F) {
            felt[slots[place] / blocks_->blocks_per_layer()].push_back(place);
        }
    }
    for (std::size_t layer = 0; layer < felt.size(); ++layer) {
        const std::size_t stride = std::max<std::size_t>(1, felt[layer].size() / samples);
        for (std::size_t n = 0; n < felt[layer].size(); n += stride) {
            const std::size_t block = slots[felt[layer][n]] % blocks_->blocks_per_layer();
            const std::size_t column = block % blocks_->block_columns() * MapBlock::side_cells;
            const std::size_t row = block / blocks_->block_columns() * MapBlock::side_cells;
            const double x_m = extent().x_low_m + static_cast<double>(column) * blocks_->cell_m();
            const double z_m = extent().z_low_m + static_cast<double>(row) * blocks_->cell_m();
            const double now = layers()[layer].effect->factor(plane().to_world(x_m, layers()[layer].lateral_m, z_m));
            if (value_of(felt[layer][n]) != static_cast<float>(now)) {
                return false;
            }
        }
    }
    return true;
}

}  // namespace downwash
