#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/aeromap/map_layer.hpp"
#include "downwash/aeromap/map_view.hpp"
#include "downwash/base/bounds.hpp"
#include "downwash/base/export.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/scene/plane_of_motion.hpp"

namespace downwash {

class MapBlocks;
struct ColumnRange;

/// A point in the plane coordinates of a layer [m].
struct LayerPlace {
    std::size_t layer;
    double x_m, z_m;
};

/// K stored over rotor positions in the plane of motion, with one layer for all rotors that share lateral offset and
/// effect.
///
/// A layer is a regular grid of square cells; every cell holds a small regular grid of its own, refined by powers of
/// two in x and z apart until bilinear interpolation stays within 0.01 of the direct evaluation everywhere in the
/// flyable area (docs/model.md 4.5). A cell is `grid_m` wide, or a whole part of it that is at most 0.45 R and fine
/// enough for 512 steps of refinement to resolve the models. Values are kept as float (relative error 2^-24).
///
/// A map fills where it is asked: blocks of 8 x 8 cells are computed at the first look-up in them, and kept. A block is
/// a pure function of layers, extent and its place, so a look-up gives the same to the last bit, whoever asked for what
/// before. Copies share their blocks. Safe to share between threads.
///
/// Limits: at most 2^24 cells in all layers together. Settings whose model changes by more than 0.016 K over R / 25600
/// (a max_factor far above 3 with a min_distance_radii near the model's pole) may exceed the 0.01 right at the surface.
class DOWNWASH_EXPORT AeroMap {
 public:
    /// A map in which nothing is filled yet.
    /// @throws InputError if the extent is empty or not finite, grid_m or an offset is out of range, or the map would
    /// have too many cells
    AeroMap(std::vector<MapLayer> layers, const PlaneOfMotion& plane, const Bounds& extent);

    /// Fills every block that is missing, on some threads.
    /// @param threads at least 1
    /// @param on_progress called from the calling thread with the share that is filled; not if nothing is missing
    /// @throws WorkStopped when it is over before the map is full; what was filled stays
    void fill(int threads = 1, const std::function<void(double)>& on_progress = {},
              const StopCondition& is_over = {}) const;

    /// Fills the blocks around some places; places outside the extent have none. Otherwise like fill().
    void fill_around(std::span<const LayerPlace> places, int threads = 1,
                     const std::function<void(double)>& on_progress = {}, const StopCondition& is_over = {}) const;

    /// The share of the blocks that are filled.
    [[nodiscard]] double filled_share() const;

    /// What all threads together have spent on filling blocks of this map and its copies so far [s].
    [[nodiscard]] double filling_s() const noexcept;

    /// The map after obstacles came, went or moved. It fills nothing, and keeps the blocks that are certainly the
    /// same in the new scene, those away from the columns over and under what changed if K depends on what is over and
    /// under the disc alone.
    /// @param layers as those of the map, in the new scene   @param changed boxes around what changed, before and after
    [[nodiscard]] AeroMap rebuilt(std::vector<MapLayer> layers, const std::vector<BoundingBox>& changed) const;

    /// Whether a part of the map may be another once boxes have changed; see rebuilt(). A part outside the extent is
    /// evaluated directly, in the old scene: then the answer is yes.
    [[nodiscard]] bool is_touched(const std::vector<BoundingBox>& changed, const Bounds& part) const;

    /// What is filled, as bytes. Only a machine of the same byte order can read them.
    [[nodiscard]] std::string to_bytes() const;

    /// The blocks that were filled here since the last call, as bytes: not those that were read. Empty if there are
    /// none.
    [[nodiscard]] std::string take_new_bytes() const;

    /// The map from its bytes, equal to the last bit where it is filled. Empty if the bytes are not a map of these
    /// layers, or if some of its values differ from what the effects give today.
    [[nodiscard]] static std::optional<AeroMap> from_bytes(std::vector<MapLayer> layers, const PlaneOfMotion& plane,
                                                           const Bounds& extent, std::string_view bytes);

    /// Adds the blocks of such bytes; false, and nothing is added, if they are not of this map.
    bool add_bytes(std::string_view bytes);

    /// As given. The cells may reach beyond its upper ends by less than one cell.
    [[nodiscard]] const Bounds& extent() const noexcept;
    [[nodiscard]] const PlaneOfMotion& plane() const noexcept;
    [[nodiscard]] const std::vector<MapLayer>& layers() const noexcept;
    /// The memory that the map takes now.
    [[nodiscard]] std::size_t memory_bytes() const;

    /// K at a rotor hub in the plane coordinates (x, z) of a layer: interpolated inside the extent, where it means
    /// nothing unless is_flyable(), evaluated directly outside it or when x or z is not finite (then 1).
    [[nodiscard]] double factor(std::size_t layer, double x_m, double z_m) const {
        const MapView& map = views_[layer];
        const double u = (x_m - map.x_low_m) * map.cells_per_m;
        const double w = (z_m - map.z_low_m) * map.cells_per_m;
        if (!map.contains(u, w)) {
            return sided_factor_outside(layer, x_m, z_m).all;
        }
        const MapPatch patch = patch_at(map, u, w);
        return bilinear(patch.corner, (u - patch.u) * patch.steps_x, (w - patch.w) * patch.steps_z);
    }

    /// K with the part of the surfaces above: exactly 1, or all of K, where one side is all that matters.
    [[nodiscard]] SidedFactor<double> sided_factor(std::size_t layer, double x_m, double z_m) const;

    /// Valid while the map or a copy exists.
    [[nodiscard]] const MapView& view(std::size_t layer) const noexcept { return views_[layer]; }

    /// Whether a rotor hub is inside the flyable area. Exact; the cell decides if it agrees as a whole.
    [[nodiscard]] bool is_flyable(std::size_t layer, double x_m, double z_m) const;

 private:
    [[nodiscard]] SidedFactor<double> sided_factor_outside(std::size_t layer, double x_m, double z_m) const;
    [[nodiscard]] ColumnRange columns_beside(const std::vector<BoundingBox>& boxes) const;
    [[nodiscard]] std::string bytes_of(const std::vector<std::size_t>& slots) const;
    [[nodiscard]] bool agrees_with_effect(const std::vector<std::size_t>& slots,
                                          const std::vector<std::shared_ptr<const MapBlock>>& blocks) const;

    std::shared_ptr<MapBlocks> blocks_;
    std::vector<MapView> views_;  ///< one per layer
};

/// The values of a layer in two arrays over its cells, and one of nodes, to be looked at as a whole.
struct MapArrays {
    std::uint32_t columns, rows;
    std::vector<MapCell> cells;              ///< x running fastest
    std::vector<CellFlyability> flyability;  ///< one for each cell
    std::vector<CellSides> sides;            ///< one for each cell
    std::vector<float> nodes;                ///< as those of MapBlock
};

/// Fills the map and copies a layer. @throws InputError if it has more than 2^32 values
[[nodiscard]] DOWNWASH_EXPORT MapArrays arrays_of(const AeroMap& map, std::size_t layer, int threads = 1);

}  // namespace downwash
