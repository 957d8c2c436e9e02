#pragma once

#include <cstddef>
#include <cstdint>

#include "downwash/aeromap/triquadratic.hpp"
#include "downwash/base/export.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/effects/sided_factor.hpp"

// A VolumeMap as plain arrays, for code that follows flights through it. Functions that kernels for wide instructions
// call are always inlined, so that no copy that only some processors can run reaches the linker.

namespace downwash {

/// What a node of a brick is: a halving across an axis, or a box.
enum class VolumeNodeKind : std::uint32_t {
    halved_x,        ///< the lower half's node is at `index`, and that of the upper half behind it
    halved_lateral,  ///< the same across the frame's lateral axis
    halved_z,        ///< the same across z
    calm,            ///< no surface has an effect, or nobody may fly there
    below,           ///< one polynomial, of K; surfaces above do not matter
    above,           ///< one polynomial, of K, all of it from surfaces above
    both,            ///< two polynomials one behind the other: of K, and of K of the surfaces above alone
    direct,          ///< polynomials do not do: K is evaluated directly
};

struct VolumeNode {
    std::uint32_t kind_and_index;
    /// How far the middle of a box is inside the flyable area (negative: outside), no more than R [m]. 0: not known.
    float margin_m;

    /// @param index of a node or a polynomial of the brick, below 2^29
    [[nodiscard, gnu::always_inline]] static VolumeNode of(VolumeNodeKind kind, std::uint32_t index,
                                                           float margin_m) noexcept {
        return {index << 3U | static_cast<std::uint32_t>(kind), margin_m};
    }
    [[nodiscard, gnu::always_inline]] VolumeNodeKind kind() const noexcept {
        return static_cast<VolumeNodeKind>(kind_and_index & 7U);
    }
    [[nodiscard, gnu::always_inline]] std::uint32_t index() const noexcept { return kind_and_index >> 3U; }
};

/// Four by four by four cells of a volume: what it fills at once. Cells beyond the end of the volume are never looked
/// up.
struct VolumeBrick {
    static constexpr std::uint32_t side_cells = 4;
    static constexpr std::uint32_t cell_count = side_cells * side_cells * side_cells;

    VolumeNode cells[cell_count];  ///< x running fastest, then lateral
    const VolumeNode* nodes;       ///< what the indices of halvings mean
    const Triquadratic* polynomials;
    std::uint32_t nodes_size, polynomials_size;
};

class VolumeBricks;

/// A VolumeMap to look up in. Positions are counted in cells along the axes of its frame from its low corner.
struct VolumeView {
    double origin_m[3];  ///< origin of the frame
    double cos_heading, sin_heading;
    double low_m[3];  ///< low corner, in the frame: x, lateral, z
    double cells_per_m[3];
    std::uint32_t cells[3];
    std::uint32_t bricks[2];           ///< side by side along x and lateral
    double calm_value;                 ///< of both numbers in calm boxes: 1 of K, 0 of walls
    const VolumeBrick* const* places;  ///< of the bricks, x running fastest; null until somebody asks for one
    VolumeBricks* source;              ///< who fills them

    /// False for NaN.
    [[nodiscard, gnu::always_inline]] bool contains(const double (&u)[3]) const noexcept {
        return u[0] >= 0 && u[1] >= 0 && u[2] >= 0 && u[0] < cells[0] && u[1] < cells[1] && u[2] < cells[2];
    }
};

/// A brick that may not be there yet. Any number of threads may ask; see BlockStore.
[[nodiscard]] DOWNWASH_EXPORT const VolumeBrick& filled_brick(const VolumeView& view, std::size_t number);

/// What a volume interpolates, evaluated directly at a world position: K by side, or both parts of the vector towards a
/// wall. The calm values when the position is not finite.
[[nodiscard]] DOWNWASH_EXPORT SidedFactor<double> direct_value(const VolumeView& view, double x_m, double y_m,
                                                               double z_m);

/// World position in cells. One template over the lane type.
template <class T>
void count_cells(const VolumeView& view, const T& x_m, const T& y_m, const T& z_m, T (&u)[3]) {
    const T dx = x_m - T(view.origin_m[0]);
    const T dy = y_m - T(view.origin_m[1]);
    const T local_m[3] = {dx * T(view.cos_heading) + dy * T(view.sin_heading),
                          dy * T(view.cos_heading) - dx * T(view.sin_heading), z_m - T(view.origin_m[2])};
    for (int axis = 0; axis < 3; ++axis) {
        u[axis] = (local_m[axis] - T(view.low_m[axis])) * T(view.cells_per_m[axis]);
    }
}

/// The brick around a position, filled if nobody has asked for it before. @pre view.contains(u)
[[nodiscard, gnu::always_inline]] inline const VolumeBrick& brick_around(const VolumeView& view, const double (&u)[3]) {
    constexpr std::uint32_t side = VolumeBrick::side_cells;
    const std::size_t i = static_cast<std::uint32_t>(u[0]) / side;
    const std::size_t j = static_cast<std::uint32_t>(u[1]) / side;
    const std::size_t k = static_cast<std::uint32_t>(u[2]) / side;
    const std::size_t number = (k * view.bricks[1] + j) * view.bricks[0] + i;
    const VolumeBrick* const brick = __atomic_load_n(view.places + number, __ATOMIC_ACQUIRE);
    if (brick == nullptr) [[unlikely]] {
        return filled_brick(view, number);
    }
    return *brick;
}

/// A box of a brick, and where a position is in it.
struct VolumeBox {
    VolumeNode node;           ///< no halving
    double part[3];            ///< the position as parts of the box's edges, each in [0, 1)
    double boxes_per_cell[3];  ///< along each axis, powers of two
};

/// How far a place is from the end of the flyable area, at least; 0: not known. Moving the disc by d changes its
/// clearance by at most d. One template over the lane type.
/// @param margin_m of the middle of the box   @param away_m from that middle, >= 0
template <class T>
T margin_at(const T& margin_m, const T& away_m) {
    return lane::select(margin_m > T(0), lane::max(T(0), margin_m - away_m), lane::min(T(0), margin_m + away_m));
}

/// The box around a position. @pre the brick is the one around it
[[nodiscard, gnu::always_inline]] inline VolumeBox box_around(const VolumeBrick& brick, const double (&u)[3]) noexcept {
    constexpr std::uint32_t side = VolumeBrick::side_cells;
    const auto i = static_cast<std::uint32_t>(u[0]);
    const auto j = static_cast<std::uint32_t>(u[1]);
    const auto k = static_cast<std::uint32_t>(u[2]);
    // u - i is exact and less than 1, and so is all that follows from it.
    VolumeBox box{
        brick.cells[(k % side * side + j % side) * side + i % side], {u[0] - i, u[1] - j, u[2] - k}, {1, 1, 1}};
    while (box.node.kind() <= VolumeNodeKind::halved_z) {
        const auto axis = static_cast<std::uint32_t>(box.node.kind());
        const double halves = 2 * box.part[axis];
        const bool is_upper = halves >= 1;
        box.part[axis] = is_upper ? halves - 1 : halves;
        box.boxes_per_cell[axis] *= 2;
        box.node = brick.nodes[box.node.index() + (is_upper ? 1U : 0U)];
    }
    return box;
}

}  // namespace downwash
