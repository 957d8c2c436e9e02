#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/aeromap/map_view.hpp"
#include "downwash/base/bounds.hpp"
#include "downwash/base/export.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/scene/plane_of_motion.hpp"

namespace downwash {

struct CellRows;
struct ColumnRange;

/// One layer of a map: an effect in the plane of motion shifted sideways.
struct MapLayer {
    std::shared_ptr<const DirectEffect> effect;
    double lateral_m = 0;  ///< to the left of the plane
};

/// The number of cells that a map would have, all layers together. A cell is grid_m wide, or a whole fraction of it for
/// steep models.
[[nodiscard]] DOWNWASH_EXPORT double map_cells(const std::vector<MapLayer>& layers, const Bounds& extent);

/// A map has no more cells than this: 2^24, some hundred megabytes.
inline constexpr double max_map_cells = 16777216;

/// K stored over rotor positions in the plane of motion, with one layer for all rotors that share lateral offset and
/// effect.
///
/// A layer is a regular grid of square cells; every cell holds a small regular grid of its own, refined by powers of
/// two in x and z apart until bilinear interpolation stays within 0.01 of the direct evaluation everywhere in the
/// flyable area (docs/model.md 4.5); neighbours of equal values share them. A cell is `grid_m` wide, or a whole part of
/// it that is at most 0.45 R and fine enough for 512 steps of refinement to resolve the models. Values are kept as
/// float (relative error 2^-24). Immutable after construction.
///
/// Limits: at most 2^24 cells in all layers together. Settings whose model changes by more than 0.016 K over R / 25600
/// (a max_factor far above 3 with a min_distance_radii near the model's pole) may exceed the 0.01 right at the surface.
class DOWNWASH_EXPORT AeroMap {
 public:
    /// Builds every layer. The bytes do not depend on the number of threads.
    /// @param threads at least 1
    /// @param on_progress called from the calling thread with the share that is built
    /// @throws WorkStopped when it is over before the map is built
    /// @throws InputError if the extent is empty or not finite, grid_m or an offset is out of range, or the map would
    /// have too many cells
    AeroMap(std::vector<MapLayer> layers, const PlaneOfMotion& plane, const Bounds& extent, int threads = 1,
            const std::function<void(double)>& on_progress = {}, const StopCondition& is_over = {});

    /// The map after obstacles came, went or moved: equal to the last bit to one that is built anew, but only the
    /// columns over and under what changed are evaluated again, if K depends on what is over and under the disc alone.
    /// @param layers as those of the map, in the new scene   @param changed boxes around what changed, before and after
    /// @throws WorkStopped when it is over before the map is built
    [[nodiscard]] AeroMap rebuilt(std::vector<MapLayer> layers, const std::vector<BoundingBox>& changed,
                                  int threads = 1, const StopCondition& is_over = {}) const;

    /// Whether a part of the map may be another once boxes have changed; see rebuilt(). A part outside the extent is
    /// evaluated directly, in the old scene: then the answer is yes.
    [[nodiscard]] bool is_touched(const std::vector<BoundingBox>& changed, const Bounds& part) const;

    /// The content of the map as bytes. Only a machine of the same byte order can read them.
    [[nodiscard]] std::string to_bytes() const;

    /// The map from its bytes, equal to the last bit. Empty if the bytes are not a map of these layers, or if some of
    /// its values differ from what the effects give today.
    [[nodiscard]] static std::optional<AeroMap> from_bytes(std::vector<MapLayer> layers, const PlaneOfMotion& plane,
                                                           const Bounds& extent, std::string_view bytes);

    /// As given. The cells may reach beyond its upper ends by less than one cell.
    [[nodiscard]] const Bounds& extent() const noexcept { return extent_; }
    [[nodiscard]] const PlaneOfMotion& plane() const noexcept { return plane_; }
    [[nodiscard]] const std::vector<MapLayer>& layers() const noexcept { return layers_; }
    [[nodiscard]] std::size_t memory_bytes() const noexcept;

    /// K at a rotor hub in the plane coordinates (x, z) of a layer: interpolated inside the extent, where it means
    /// nothing unless is_flyable(), evaluated directly outside it or when x or z is not finite (then 1).
    [[nodiscard]] double factor(std::size_t layer, double x_m, double z_m) const noexcept {
        const double u = (x_m - extent_.x_low_m) * cells_per_m_;
        const double w = (z_m - extent_.z_low_m) * cells_per_m_;
        // Written so that NaN fails. Below, u - i is exact and less than 1, and so is its product with a power of two:
        // no index can leave its cell.
        if (!(u >= 0 && w >= 0 && u < columns_ && w < rows_)) {
            return factor_outside(layer, x_m, z_m);
        }
        const auto i = static_cast<std::uint32_t>(u);
        const auto k = static_cast<std::uint32_t>(w);
        const Raster& raster = *rasters_[layer];
        const MapCell& cell = raster.cells[std::size_t{k} * columns_ + i];
        const double a = (u - i) * cell.steps_x;
        const double b = (w - k) * cell.steps_z;
        const auto ia = static_cast<std::uint32_t>(a);
        const auto ib = static_cast<std::uint32_t>(b);
        const float* node = raster.nodes.data() + cell.first_node + ib * (cell.steps_x + 1U) + ia;
        const double s = a - ia;
        const double t = b - ib;
        const float* upper = node + cell.steps_x + 1U;
        const double corner[4] = {node[0], node[1], upper[0], upper[1]};
        return bilinear(corner, s, t);
    }

    /// K with the part of the surfaces above: exactly 1, or all of K, where one side is all that matters.
    [[nodiscard]] SidedFactor<double> sided_factor(std::size_t layer, double x_m, double z_m) const noexcept;

    /// Whether two layers have the same values, such as those of the left and right rotors of a vehicle that flies
    /// along the middle of a scene. Look-ups inside the extent then agree to the last bit.
    [[nodiscard]] bool are_equal(std::size_t layer, std::size_t other) const noexcept {
        return rasters_[layer] == rasters_[other];
    }

    /// Valid while the map exists.
    [[nodiscard]] MapView view(std::size_t layer) const noexcept {
        const Raster& raster = *rasters_[layer];
        return {extent_.x_low_m,     extent_.z_low_m,          cells_per_m_,        columns_,           rows_,
                raster.cells.data(), raster.flyability.data(), raster.sides.data(), raster.nodes.data()};
    }

    /// Whether a rotor hub is inside the flyable area. Exact; the cell decides if it agrees as a whole.
    [[nodiscard]] bool is_flyable(std::size_t layer, double x_m, double z_m) const;

 private:
    /// The values of one layer.
    struct Raster {
        std::vector<MapCell> cells;
        std::vector<CellFlyability> flyability;  ///< one for each cell
        std::vector<CellSides> sides;            ///< one for each cell
        std::vector<float> nodes;  ///< a cell that has the values of the one before it shares them: most cells do

        void append(const CellRows& rows, const ColumnRange& columns, const Raster* before, std::size_t first,
                    std::size_t width);
        void append_cell(std::uint16_t steps_x, std::uint16_t steps_z, CellSides side, const float* values);
        [[nodiscard]] static std::ptrdiff_t value_count(const MapCell& cell, CellSides sides);
    };

    /// A map without values.
    struct Empty {};
    AeroMap(Empty, std::vector<MapLayer> layers, const PlaneOfMotion& plane, const Bounds& extent);

    [[nodiscard]] double factor_outside(std::size_t layer, double x_m, double z_m) const noexcept {
        return sided_factor_outside(layer, x_m, z_m).all;
    }
    [[nodiscard]] SidedFactor<double> sided_factor_outside(std::size_t layer, double x_m, double z_m) const noexcept;
    void build(int threads, const std::function<void(double)>& on_progress, const StopCondition& is_over);
    /// @param before in which the columns between were something else; nullptr for a new map
    void build(int threads, const std::function<void(double)>& on_progress, const StopCondition& is_over,
               const AeroMap* before, const ColumnRange& changed);
    [[nodiscard]] ColumnRange columns_beside(const std::vector<BoundingBox>& boxes) const;
    void add_raster(Raster raster);
    [[nodiscard]] bool is_sound(const Raster& raster) const;
    [[nodiscard]] bool agrees_with_effect(std::size_t layer) const;

    std::vector<MapLayer> layers_;
    PlaneOfMotion plane_;
    Bounds extent_;
    double cell_m_;  ///< side of a cell
    double cells_per_m_;
    std::uint32_t columns_;
    std::uint32_t rows_;
    std::vector<std::shared_ptr<const Raster>> rasters_;  ///< one per layer; layers of equal values share theirs
};

}  // namespace downwash
