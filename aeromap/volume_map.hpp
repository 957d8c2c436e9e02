#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/base/export.hpp"
#include "downwash/scene/plane_of_motion.hpp"

namespace downwash {

/// A volume has no more boxes than this: 2^23, about a gigabyte.
inline constexpr std::size_t max_volume_boxes = 8388608;

/// K stored over a block of rotor positions in three dimensions, for vehicles that leave one plane.
///
/// The block is a regular grid of cells at most 0.45 R wide. A cell is halved across x, lateral or z, and its halves
/// again, until in every box the triquadratic interpolation between 27 values stays within 0.01 of the direct
/// evaluation everywhere in the flyable area (docs/model.md 4.5). Boxes that are forbidden throughout, or where K
/// cannot differ by more than 0.006 from 1, count as 1. Coefficients are kept as float. Immutable after construction.
///
/// Limits: an edge is halved at most 7 times, to R / 284. Where K jumps or rises more than 0.01 within that, inside the
/// flyable area, the bound does not hold: right beside obstacles under a min_distance_radii of 0, or as said of
/// AeroMap.
class DOWNWASH_EXPORT VolumeMap {
 public:
    /// @param frame x and z are those of its plane; the block reaches from `lateral_low_m` to `lateral_high_m` to its
    /// left
    /// @param effect of a multirotor model: it is that of a vehicle at one heading (see neighbours_of)
    /// @param threads at least 1; the bytes do not depend on it   @param on_progress see run_parallel
    /// @throws InputError if the block is empty or not finite, or needs more than max_volume_boxes
    VolumeMap(std::shared_ptr<const DirectEffect> effect, const PlaneOfMotion& frame, const Bounds& extent,
              double lateral_low_m, double lateral_high_m, int threads = 1,
              const std::function<void(double)>& on_progress = {});

    /// K at the world position of a hub: interpolated in the block, evaluated directly outside (1 when not finite).
    [[nodiscard]] double factor(const Vector3& hub_m) const;

    [[nodiscard]] const DirectEffect& effect() const noexcept { return *effect_; }
    /// The number of different polynomials. Boxes of equal values share theirs, as most do along a deck.
    [[nodiscard]] std::size_t polynomials() const noexcept { return polynomials_.size() - 1; }
    [[nodiscard]] std::size_t memory_bytes() const noexcept;

 private:
    class Builder;
    using Cell = std::array<std::uint32_t, 3>;  ///< counted along x, lateral and z

    /// A halving, or a box.
    struct Node {
        std::uint32_t axis;   ///< axis that is halved: 0 x, 1 lateral, 2 z; no_axis: a box
        std::uint32_t index;  ///< index of the lower half's node, behind which the upper half's stands; or that of a
                              ///< box's polynomial
    };
    static constexpr std::uint32_t no_axis = 3;
    /// The coefficients of K's polynomial in the box.
    using Coefficients = std::array<float, 28>;
    using KnownPolynomials = std::map<Coefficients, std::uint32_t>;  ///< and their indices

    [[nodiscard]] std::size_t node_of(const Cell& cell) const noexcept {
        return (std::size_t{cell[2]} * cells_[1] + cell[1]) * cells_[0] + cell[0];
    }
    void build(int threads, const std::function<void(double)>& on_progress);
    void append(const Builder& brick, KnownPolynomials& known);

    std::shared_ptr<const DirectEffect> effect_;
    PlaneOfMotion frame_;
    Vector3 low_m_, high_m_;  ///< corners of the block, in the frame: x, lateral, z
    Vector3 cell_m_{};        ///< a cell's edges
    Vector3 cells_per_m_{};
    Cell cells_{};
    std::vector<Node> nodes_;                ///< first those of the cells, x running fastest
    std::vector<Coefficients> polynomials_;  ///< the first one stays unused: index 0 stands for K = 1
};

}  // namespace downwash
