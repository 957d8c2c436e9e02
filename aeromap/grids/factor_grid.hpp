#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/base/csv_facts.hpp"
#include "downwash/base/export.hpp"
#include "downwash/scene/plane_of_motion.hpp"

namespace downwash {

/// Equally spaced coordinates [m], both ends included. An axis without extent has a single coordinate.
struct GridAxis {
    double low_m = 0, high_m = 0;
    std::size_t count = 1;

    [[nodiscard]] double step_m() const noexcept {
        return count > 1 ? (high_m - low_m) / static_cast<double>(count - 1) : 0;
    }
    /// Coordinate number i, 0 <= i < count; the last is high_m to the bit.
    [[nodiscard]] double at(std::size_t i) const noexcept {
        return i + 1 < count ? low_m + static_cast<double>(i) * step_m() : high_m;
    }
    bool operator==(const GridAxis&) const = default;
};

/// A number at every node of a grid: the value of node (i, j, k) of layer l has the index ((l * nz + k) * ny + j) * nx
/// + i.
struct GridField {
    std::string name;
    std::vector<double> values;
    bool operator==(const GridField&) const = default;
};

/// Where a grid comes from, as ordered pairs of key and value: program, problem, models and their sources, radius, ...
using Provenance = std::vector<std::pair<std::string, std::string>>;

/// How far beyond the outermost nodes of a grid, and beside its layers, positions count as on them [m].
inline constexpr double default_edge_slack_m = 1e-9;
inline constexpr double default_layer_slack_m = 1e-6;

/// The parts of a grid of thrust ratios.
struct FactorGridParts {
    /// The frame of the coordinates x, y, z: y points to the left, z up.
    PlaneOfMotion frame;
    GridAxis x, y, z;
    /// The distances of a planar grid: those to the left of the plane [m] at which its layers are valid, rising. Empty:
    /// one layer that is valid at any distance.
    std::vector<double> lateral_offsets_m;
    /// "factor" and any of "ground", "ceiling" (one-sided factors) and "flyable" (0 or 1), each once.
    std::vector<GridField> fields;
    Provenance provenance;
    /// Larger than by default where the coordinates were rounded: half a unit of their last digit, along x, y and z.
    Vector3 edge_slack_m{default_edge_slack_m, default_edge_slack_m, default_edge_slack_m};
    double layer_slack_m = default_layer_slack_m;
    CsvFacts csv = {};  ///< how the file looks that it was read from, if any
};

/// K on a regular grid of rotor hub positions, from a map of ours, a simulation or a measurement. Planar (nx x 1 x nz
/// nodes in a vertical plane, one layer or one per lateral offset) or a volume (nx x ny x nz). Immutable.
class DOWNWASH_EXPORT FactorGrid {
 public:
    /// @throws InputError if an axis is not finite, is larger than 1e6 m, or has high <= low (y of a planar grid: not
    /// 0, 0, 1), if a slack is negative or not finite, if the grid has more than 2^24 nodes, if a field is unknown,
    /// missing, of another length or out of range (factors: 0 to 100), or if a piece of provenance does not fit on one
    /// line of text
    explicit FactorGrid(FactorGridParts parts);

    [[nodiscard]] bool is_planar() const noexcept { return parts_.y.count == 1; }
    [[nodiscard]] const PlaneOfMotion& frame() const noexcept { return parts_.frame; }
    [[nodiscard]] const GridAxis& x() const noexcept { return parts_.x; }
    [[nodiscard]] const GridAxis& y() const noexcept { return parts_.y; }
    [[nodiscard]] const GridAxis& z() const noexcept { return parts_.z; }
    [[nodiscard]] const std::vector<double>& lateral_offsets_m() const noexcept { return parts_.lateral_offsets_m; }
    /// "factor" first.
    [[nodiscard]] const std::vector<GridField>& fields() const noexcept { return parts_.fields; }
    [[nodiscard]] const Provenance& provenance() const noexcept { return parts_.provenance; }
    [[nodiscard]] const Vector3& edge_slack_m() const noexcept { return parts_.edge_slack_m; }
    [[nodiscard]] double layer_slack_m() const noexcept { return parts_.layer_slack_m; }
    /// How its file looks.
    [[nodiscard]] const CsvFacts& csv() const noexcept { return parts_.csv; }

    /// One layer, or as many as lateral offsets.
    [[nodiscard]] std::size_t layers() const noexcept;
    /// Nodes of all layers together.
    [[nodiscard]] std::size_t nodes() const noexcept;

    /// The values of the field of that name; nullptr when there is none.
    [[nodiscard]] const std::vector<double>* field(std::string_view name) const noexcept;

    /// Whether K is known at the world position of a rotor hub: between the outermost nodes (within edge_slack_m), and
    /// on a layer (within layer_slack_m) where the layers have lateral offsets.
    [[nodiscard]] bool contains(const Vector3& hub_m) const noexcept;

    /// K at the world position of a rotor hub, linear along each axis between the nodes; NaN where the grid does not
    /// contain it: nothing is extrapolated.
    [[nodiscard]] double factor(const Vector3& hub_m) const noexcept;

    /// Whether a rotor may fly with its hub there: the grid contains the hub, and all corners of its cell are 1 in the
    /// field "flyable", if there is such a field.
    [[nodiscard]] bool is_flyable(const Vector3& hub_m) const noexcept { return is_flyable_between({&hub_m, 1}); }
    /// Whether that holds for all hubs in the convex hull of some corners at once; false in doubt.
    [[nodiscard]] bool is_flyable_between(std::span<const Vector3> corners_m) const noexcept;

 private:
    /// The layer and the cell that hold a position, and where in the cell it lies, 0 to 1.
    struct Place {
        std::size_t layer;
        std::size_t i, j, k;
        double s, t, u;
    };
    [[nodiscard]] std::optional<Place> place_of(const Vector3& hub_m) const noexcept;

    FactorGridParts parts_;
};

/// A grid has no more nodes than this, all layers together.
inline constexpr std::size_t max_grid_nodes = std::size_t{1} << 24U;

/// No value of a grid is larger.
inline constexpr double max_grid_factor = 100;

}  // namespace downwash
