#pragma once

#include <cmath>

#include "downwash/aeromap/volume_view.hpp"
#include "downwash/base/lane_math.hpp"

// A volume along flights, one template over the lane type: kernels for wide instructions include this.

namespace downwash {

/// What a volume says along the flights of all lanes of one rotor, or of the body, or of walls. It keeps the box in
/// which each lane is, which a flight leaves only every few ticks. In double, and so within 1e-6 of VolumeMap; the same
/// in every lane type to the last bit.
template <class T>
class VolumePatches {
 public:
    /// @pre the volume outlives the object
    explicit VolumePatches(const VolumeView& view) : view_(view) {
        for (int lane = 0; lane < width; ++lane) {
            leave(lane);
        }
    }

    /// VolumeMap::sided_factor() at the world positions of hubs.
    SidedFactor<T> at(const T& x_m, const T& y_m, const T& z_m) {
        const Position now = entered(x_m, y_m, z_m);
        SidedFactor<T> result{polynomial(all_, now), polynomial(above_, now)};
        for (unsigned int outside = lane::bits_of(load(is_direct_) > T(0)); outside != 0; outside &= outside - 1) {
            const int lane = __builtin_ctz(outside);
            const SidedFactor<double> there =
                direct_value(view_, lane::number_in(x_m, lane), lane::number_in(y_m, lane), lane::number_in(z_m, lane));
            lane::set_number(result.all, lane, there.all);
            lane::set_number(result.above, lane, there.above);
        }
        return result;
    }

    /// VolumeMap::margin_m() at the world positions of hubs.
    T margin_m(const T& x_m, const T& y_m, const T& z_m) {
        const Position now = entered(x_m, y_m, z_m);
        T squares(0);
        for (int axis = 0; axis < 3; ++axis) {
            const T away_m = (now.part[axis] - T(0.5)) * load(edge_m_[axis]);
            squares = squares + away_m * away_m;
        }
        return margin_at(load(margin_m_), lane::sqrt(squares));
    }

 private:
    static constexpr int width = lane::width<T>;
    static constexpr int coefficients = 27;

    struct Position {
        T u[3];     ///< in cells
        T part[3];  ///< of the way through the lane's box
    };

    static T load(const double (&numbers)[width]) { return lane::load<T>(numbers); }

    static T polynomial(const double (&of)[coefficients][width], const Position& at) {
        return triquadratic_at([&of](int number) { return load(of[number]); }, at.part[0], at.part[1], at.part[2]);
    }

    [[nodiscard]] Position in_boxes(const T (&u)[3]) const {
        Position at;
        for (int axis = 0; axis < 3; ++axis) {
            at.u[axis] = u[axis];
            at.part[axis] = (u[axis] - load(low_[axis])) * load(boxes_per_cell_[axis]);
        }
        return at;
    }

    /// The positions, each lane in the box around its own.
    Position entered(const T& x_m, const T& y_m, const T& z_m) {
        T u[3];
        count_cells(view_, x_m, y_m, z_m, u);
        const Position at = in_boxes(u);
        const unsigned int elsewhere =
            lane::bits_of(!((at.part[0] >= T(0)) & (at.part[0] < T(1)) & (at.part[1] >= T(0)) & (at.part[1] < T(1)) &
                            (at.part[2] >= T(0)) & (at.part[2] < T(1))));
        return elsewhere == 0 ? at : moved(at, elsewhere);
    }

    /// Enters the boxes around the lanes that have left theirs, given as bits.
    [[gnu::noinline]] Position moved(const Position& at, unsigned int elsewhere) {
        for (; elsewhere != 0; elsewhere &= elsewhere - 1) {
            const int lane = __builtin_ctz(elsewhere);
            const double u[3] = {lane::number_in(at.u[0], lane), lane::number_in(at.u[1], lane),
                                 lane::number_in(at.u[2], lane)};
            if (view_.contains(u)) {
                enter(u, lane);
            } else {
                leave(lane);
            }
        }
        Position now = in_boxes(at.u);
        // A lane outside has an infinite part, which no polynomial may meet.
        for (int axis = 0; axis < 3; ++axis) {
            const T is_in = lane::select(load(is_outside_) > T(0), T(0), T(1));
            now.part[axis] = lane::select(is_in > T(0), now.part[axis], T(0.5));
        }
        return now;
    }

    void enter(const double (&u)[3], int lane) {
        const VolumeBox box = box_around(view_, u);
        const VolumeNodeKind kind = box.kind;
        for (int axis = 0; axis < 3; ++axis) {
            // Exact: the box begins at a multiple of its edge.
            low_[axis][lane] = static_cast<double>(static_cast<std::uint32_t>(u[axis] * box.boxes_per_cell[axis])) /
                               box.boxes_per_cell[axis];
            boxes_per_cell_[axis][lane] = box.boxes_per_cell[axis];
            edge_m_[axis][lane] = 1 / (box.boxes_per_cell[axis] * view_.cells_per_m[axis]);
        }
        is_outside_[lane] = 0;
        is_direct_[lane] = kind == VolumeNodeKind::direct ? 1 : 0;
        margin_m_[lane] = double{box.margin_m};
        fill(all_, lane, view_.calm_value);
        fill(above_, lane, view_.calm_value);
        if (kind == VolumeNodeKind::calm || kind == VolumeNodeKind::direct) {
            return;
        }
        const std::size_t of_above = kind == VolumeNodeKind::both ? 1 : 0;
        for (int number = 0; number < coefficients; ++number) {
            const auto i = static_cast<std::size_t>(number);
            all_[number][lane] = double{box.polynomials[0][i]};
            if (kind != VolumeNodeKind::below) {
                above_[number][lane] = double{box.polynomials[of_above][i]};
            }
        }
    }

    /// Outside the volume everything is evaluated directly, and the next position looked up again.
    void leave(int lane) {
        for (int axis = 0; axis < 3; ++axis) {
            low_[axis][lane] = HUGE_VAL;
            boxes_per_cell_[axis][lane] = 1;
            edge_m_[axis][lane] = 0;
        }
        is_outside_[lane] = 1;
        is_direct_[lane] = 1;
        margin_m_[lane] = 0;
        fill(all_, lane, view_.calm_value);
        fill(above_, lane, view_.calm_value);
    }

    static void fill(double (&of)[coefficients][width], int lane, double value) {
        for (int number = 0; number < coefficients; ++number) {
            of[number][lane] = number == 0 ? value : 0;
        }
    }

    VolumeView view_;
    alignas(64) double low_[3][width];  ///< of the box, in cells
    alignas(64) double boxes_per_cell_[3][width];
    alignas(64) double edge_m_[3][width];
    alignas(64) double all_[coefficients][width];
    alignas(64) double above_[coefficients][width];
    alignas(64) double margin_m_[width];
    alignas(64) double is_outside_[width];  ///< 1 where a lane is outside the volume
    alignas(64) double is_direct_[width];   ///< 1 where there is no polynomial
};

}  // namespace downwash
