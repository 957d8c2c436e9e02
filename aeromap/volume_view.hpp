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

/// What a node of a brick is: a halving across an axis, a box, or a place that nobody has asked for.
enum class VolumeNodeKind : std::uint32_t {
    halved_x,        ///< into two nodes, the lower half first
    halved_lateral,  ///< the same across the frame's lateral axis
    halved_z,        ///< the same across z
    calm,            ///< no surface has an effect, or nobody may fly there
    below,           ///< one polynomial, of K; surfaces above do not matter
    above,           ///< one polynomial, of K, all of it from surfaces above
    both,            ///< two polynomials one behind the other: of K, and of K of the surfaces above alone
    direct,          ///< polynomials do not do: K is evaluated directly
    unknown,         ///< not looked into yet
};

/// A node is written once: its kind last, when all else stands. Read the kind by kind_of(), and first.
struct VolumeNode {
    VolumeNodeKind kind = VolumeNodeKind::unknown;
    /// How far the middle of a box is inside the flyable area (negative: outside), no more than R [m]. 0: not known.
    float margin_m = 0;
    VolumeNode* halves = nullptr;               ///< of a halving
    const Triquadratic* polynomials = nullptr;  ///< of a box with one or two
};

[[nodiscard, gnu::always_inline]] inline VolumeNodeKind kind_of(const VolumeNode& node) noexcept {
    VolumeNodeKind kind;
    __atomic_load(&node.kind, &kind, __ATOMIC_ACQUIRE);
    return kind;
}
[[nodiscard, gnu::always_inline]] inline bool is_halving(VolumeNodeKind kind) noexcept {
    return kind <= VolumeNodeKind::halved_z;
}

/// Four by four by four cells of a volume. Cells beyond the end of the volume are never looked up.
struct VolumeBrick {
    static constexpr std::uint32_t side_cells = 4;
    static constexpr std::uint32_t cell_count = side_cells * side_cells * side_cells;

    VolumeNode cells[cell_count];  ///< x running fastest, then lateral
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
    const VolumeBrick* const* places;  ///< of the bricks, x running fastest; null until somebody asks there
    VolumeBricks* source;              ///< who makes them

    /// False for NaN.
    [[nodiscard, gnu::always_inline]] bool contains(const double (&u)[3]) const noexcept {
        return u[0] >= 0 && u[1] >= 0 && u[2] >= 0 && u[0] < cells[0] && u[1] < cells[1] && u[2] < cells[2];
    }
};

/// A brick that may not be there yet. Any number of threads may ask.
[[nodiscard]] DOWNWASH_EXPORT const VolumeBrick& made_brick(const VolumeView& view, std::size_t number);

/// A place in a brick: one of its cells, and where in that, as parts of its edges in [0, 1).
struct PlaceInBrick {
    std::size_t brick;
    std::uint32_t cell;
    double part[3];
};

/// Makes the box around a place known, with all halvings that lead to it. Any number of threads may ask.
DOWNWASH_EXPORT void explore(const VolumeView& view, const PlaceInBrick& place);

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

/// Where a position is. @pre view.contains(u)
[[nodiscard, gnu::always_inline]] inline PlaceInBrick place_in_brick(const VolumeView& view,
                                                                     const double (&u)[3]) noexcept {
    constexpr std::uint32_t side = VolumeBrick::side_cells;
    const auto i = static_cast<std::uint32_t>(u[0]);
    const auto j = static_cast<std::uint32_t>(u[1]);
    const auto k = static_cast<std::uint32_t>(u[2]);
    const std::size_t number =
        (std::size_t{k / side} * view.bricks[1] + std::size_t{j / side}) * view.bricks[0] + std::size_t{i / side};
    // u - i is exact and less than 1.
    return {number, (k % side * side + j % side) * side + i % side, {u[0] - i, u[1] - j, u[2] - k}};
}

/// A box of a volume, and where a position is in it.
struct VolumeBox {
    VolumeNodeKind kind;  ///< no halving, and known
    float margin_m;       ///< as in the node
    const Triquadratic* polynomials;
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

/// The box around a position, made known if nobody has asked for it before. @pre view.contains(u)
[[nodiscard, gnu::always_inline]] inline VolumeBox box_around(const VolumeView& view, const double (&u)[3]) {
    const PlaceInBrick place = place_in_brick(view, u);
    const VolumeBrick* brick = __atomic_load_n(view.places + place.brick, __ATOMIC_ACQUIRE);
    if (brick == nullptr) [[unlikely]] {
        brick = &made_brick(view, place.brick);
    }
    const VolumeNode* node = &brick->cells[place.cell];
    VolumeBox box{kind_of(*node), 0, nullptr, {place.part[0], place.part[1], place.part[2]}, {1, 1, 1}};
    for (;;) {
        if (box.kind == VolumeNodeKind::unknown) [[unlikely]] {
            explore(view, place);
            box.kind = kind_of(*node);
        }
        if (!is_halving(box.kind)) {
            break;
        }
        const auto axis = static_cast<std::uint32_t>(box.kind);
        const double halves = 2 * box.part[axis];
        const bool is_upper = halves >= 1;
        box.part[axis] = is_upper ? halves - 1 : halves;  // exact
        box.boxes_per_cell[axis] *= 2;
        node = node->halves + (is_upper ? 1 : 0);
        box.kind = kind_of(*node);
    }
    box.margin_m = node->margin_m;
    box.polynomials = node->polynomials;
    return box;
}

}  // namespace downwash
