#pragma once

// Private to aeromap.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "downwash/aeromap/block_store.hpp"
#include "downwash/aeromap/layer_grid.hpp"
#include "downwash/aeromap/map_layer.hpp"
#include "downwash/aeromap/map_view.hpp"
#include "downwash/base/bounds.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/scene/plane_of_motion.hpp"

namespace downwash {

/// What maps of the same layers share: their blocks, and how to fill them. A slot is the number of a block among those
/// of all layers. Safe to share between threads.
class MapBlocks {
 public:
    /// @throws InputError as AeroMap
    MapBlocks(std::vector<MapLayer> layers, const PlaneOfMotion& plane, const Bounds& extent);

    [[nodiscard]] const std::vector<MapLayer>& layers() const noexcept { return layers_; }
    [[nodiscard]] const PlaneOfMotion& plane() const noexcept { return plane_; }
    [[nodiscard]] const Bounds& extent() const noexcept { return extent_; }
    [[nodiscard]] double cell_m() const noexcept { return cell_m_; }
    [[nodiscard]] std::uint32_t columns() const noexcept { return columns_; }
    [[nodiscard]] std::uint32_t rows() const noexcept { return rows_; }
    [[nodiscard]] std::uint32_t block_columns() const noexcept { return block_columns_; }
    [[nodiscard]] std::uint32_t block_rows() const noexcept { return block_rows_; }
    [[nodiscard]] std::size_t blocks_per_layer() const noexcept { return std::size_t{block_columns_} * block_rows_; }
    [[nodiscard]] std::size_t slot_of(std::size_t layer, std::size_t block) const noexcept {
        return layer * blocks_per_layer() + block;
    }
    [[nodiscard]] MapView view(std::size_t layer) noexcept;

    /// A block, filled if need be. While another thread fills it, this one fills a block that is likely to be asked for
    /// next, and then waits.
    const MapBlock& filled(std::size_t slot);

    /// Fills what is missing among some slots, on some threads.
    /// @param on_progress see run_parallel; not called if nothing is missing
    /// @throws WorkStopped when it is over before
    void fill(std::span<const std::size_t> slots, int threads, const std::function<void(double)>& on_progress,
              const StopCondition& is_over);

    [[nodiscard]] BlockStore<MapBlock>& store() noexcept { return store_; }
    [[nodiscard]] const BlockStore<MapBlock>& store() const noexcept { return store_; }

    /// Puts a block in its place that was filled elsewhere.
    void put(std::size_t slot, std::shared_ptr<const MapBlock> block) {
        store_.put(slot, std::move(block), twins(slot));
    }

    /// Takes over the blocks of a map of the same grid in another scene that are the same in this one.
    /// @param changed columns in which K may differ, with all that change with them
    void take_over(const MapBlocks& before, const ColumnRange& changed);

    /// The slot of the earliest layer that has the same block at the same place; the slot itself if none has.
    [[nodiscard]] std::size_t first_of_equal(std::size_t slot) const;

    /// What all threads together have spent on filling so far [s].
    [[nodiscard]] double filling_s() const noexcept { return 1e-9 * static_cast<double>(filling_ns_.load()); }

 private:
    class FlyabilityInTwo;
    [[nodiscard]] LayerGrid grid(std::size_t layer, const StopCondition& is_over) const;
    [[nodiscard]] std::shared_ptr<const MapBlock> made(std::size_t slot);
    /// The same place in the other layers.
    [[nodiscard]] std::vector<std::size_t> twins(std::size_t slot) const;
    void look_ahead(std::size_t slot);

    std::vector<MapLayer> layers_;
    PlaneOfMotion plane_;
    Bounds extent_;
    double cell_m_;  ///< side of a cell
    std::uint32_t columns_, rows_;
    std::uint32_t block_columns_, block_rows_;
    BlockStore<MapBlock> store_;
    std::atomic<std::int64_t> filling_ns_{0};
};

}  // namespace downwash
