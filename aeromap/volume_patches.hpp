#pragma once

#include <cmath>
#include <cstddef>

#include "downwash/aeromap/volume_view.hpp"
#include "downwash/base/lane_math.hpp"

// A volume along flights, one template over the lane type: kernels for wide instructions include this.

namespace downwash {

/// The box of a volume in which each of so many lanes was last, as numbers to compute with: [..][lane]. A flight leaves
/// its box only every few ticks. What a look-up says does not depend on them, so lanes may change hands.
template <int lanes>
struct alignas(lanes < 8 ? sizeof(double) * lanes : 64) VolumePatches {
    static constexpr int coefficients = 27;
    static constexpr int levels = 3;

    VolumePatches() {
        for (int lane = 0; lane < lanes; ++lane) {
            for (int axis = 0; axis < 3; ++axis) {
                low[axis][lane] = HUGE_VAL;
                boxes_per_cell[axis][lane] = 1;
            }
        }
    }

    double low[3][lanes];  ///< corner of the box, in boxes of its size; infinite: the lane is in none
    double boxes_per_cell[3][lanes];
    double all[coefficients][lanes] = {};    ///< 0 beyond the lane's level
    double above[coefficients][lanes] = {};  ///< counts for `is_both` alone
    double margin_m[lanes] = {};
    double is_below[lanes] = {};    ///< 1 where surfaces above do not matter
    double is_both[lanes] = {};     ///< 1 where those above are neither nothing nor all
    double is_outside[lanes] = {};  ///< 1 where a lane is outside the volume

    // Lanes as bits.
    unsigned int below = 0, both = 0;         ///< `is_below`, `is_both`
    unsigned int direct = 0;                  ///< where there is no polynomial
    unsigned int varying[levels] = {};        ///< along z; along lateral, too; along x, too
    unsigned int above_varying[levels] = {};  ///< the same of `above`
};

/// Looks up in a volume for the neighbouring lanes of a T. In double, and so within 1e-6 of VolumeMap; the same in
/// every lane type to the last bit.
template <class T, int lanes = lane::width<T>>
class VolumeLookUp {
 public:
    /// @param patches those of a rotor, of the body or of walls   @pre all outlive the object
    VolumeLookUp(const VolumeView& view, VolumePatches<lanes>& patches, int first_lane = 0)
        : view_(view), patches_(patches), first_(first_lane) {}

    /// VolumeMap::sided_factor() at the world positions of hubs.
    SidedFactor<T> at(const T& x_m, const T& y_m, const T& z_m) {
        const Position now = entered(x_m, y_m, z_m);
        SidedFactor<T> result;
        result.all = polynomial(patches_.all, patches_.varying, now);
        result.above = result.all;
        if (has_lane(patches_.below)) {
            result.above = lane::select(load(patches_.is_below) > T(0), T(view_.calm_value), result.above);
        }
        if (has_lane(patches_.both)) {
            result.above = lane::select(load(patches_.is_both) > T(0),
                                        polynomial(patches_.above, patches_.above_varying, now), result.above);
        }
        if (has_lane(patches_.direct)) {
            evaluate(x_m, y_m, z_m, result);
        }
        return result;
    }

    /// VolumeMap::margin_m() at the world positions of hubs.
    T margin_m(const T& x_m, const T& y_m, const T& z_m) {
        const Position now = entered(x_m, y_m, z_m);
        T squares(0);
        for (int axis = 0; axis < 3; ++axis) {
            const T edge_m = T(1) / (load(patches_.boxes_per_cell[axis]) * T(view_.cells_per_m[axis]));
            const T away_m = (now.part[axis] - T(0.5)) * edge_m;
            squares = squares + away_m * away_m;
        }
        return margin_at(load(patches_.margin_m), lane::sqrt(squares));
    }

 private:
    static constexpr int width = lane::width<T>;
    static constexpr int coefficients = VolumePatches<lanes>::coefficients;
    static constexpr int levels = VolumePatches<lanes>::levels;
    static constexpr unsigned int every_lane = (1U << static_cast<unsigned int>(width)) - 1;

    struct Position {
        T u[3];     ///< in cells
        T part[3];  ///< of the way through the lane's box
    };

    [[nodiscard]] T load(const double (&numbers)[lanes]) const { return lane::load<T>(numbers + first_); }
    /// Whether bits of all lanes have one of ours.
    [[nodiscard]] bool has_lane(unsigned int bits) const {
        return (bits >> static_cast<unsigned int>(first_) & every_lane) != 0;
    }

    /// The same for a lane of a lower level as if it stood alone: what is 0 adds nothing.
    [[nodiscard]] T polynomial(const double (&of)[coefficients][lanes], const unsigned int (&varying)[levels],
                               const Position& at) const {
        const auto [x, y, z] = at.part;
        const auto coefficient = [&](int number) { return load(of[number]); };
        if (!has_lane(varying[0])) {
            return coefficient(0);
        }
        if (!has_lane(varying[1])) {
            return parabola_at(coefficient, z);
        }
        return has_lane(varying[2]) ? triquadratic_at(coefficient, x, y, z) : biquadratic_at(coefficient, y, z);
    }

    [[nodiscard]] Position in_boxes(const T (&u)[3]) const {
        Position at;
        for (int axis = 0; axis < 3; ++axis) {
            at.u[axis] = u[axis];
            // Exact in the box: its edge is a power of two of a cell's.
            at.part[axis] = u[axis] * load(patches_.boxes_per_cell[axis]) - load(patches_.low[axis]);
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
                enter(u, first_ + lane);
            } else {
                leave(first_ + lane);
            }
        }
        Position now = in_boxes(at.u);
        // A lane outside has an infinite part, which no polynomial may meet.
        for (T& part : now.part) {
            part = lane::select(load(patches_.is_outside) > T(0), T(0.5), part);
        }
        return now;
    }

    [[gnu::noinline]] void evaluate(const T& x_m, const T& y_m, const T& z_m, SidedFactor<T>& result) const {
        unsigned int direct = patches_.direct >> static_cast<unsigned int>(first_) & every_lane;
        for (; direct != 0; direct &= direct - 1) {
            const int lane = __builtin_ctz(direct);
            const SidedFactor<double> there =
                direct_value(view_, lane::number_in(x_m, lane), lane::number_in(y_m, lane), lane::number_in(z_m, lane));
            lane::set_number(result.all, lane, there.all);
            lane::set_number(result.above, lane, there.above);
        }
    }

    void enter(const double (&u)[3], int lane) {
        const VolumeBox box = box_around(view_, u);
        for (int axis = 0; axis < 3; ++axis) {
            patches_.low[axis][lane] =
                static_cast<double>(static_cast<std::uint32_t>(u[axis] * box.boxes_per_cell[axis]));
            patches_.boxes_per_cell[axis][lane] = box.boxes_per_cell[axis];
        }
        patches_.is_outside[lane] = 0;
        patches_.margin_m[lane] = double{box.margin_m};
        take(box.kind, box.polynomials, lane);
    }

    /// Outside the volume everything is evaluated directly, and the next position looked up again.
    void leave(int lane) {
        for (int axis = 0; axis < 3; ++axis) {
            patches_.low[axis][lane] = HUGE_VAL;
            patches_.boxes_per_cell[axis][lane] = 1;
        }
        patches_.is_outside[lane] = 1;
        patches_.margin_m[lane] = 0;
        take(VolumeNodeKind::direct, nullptr, lane);
    }

    void take(VolumeNodeKind kind, const Triquadratic* polynomials, int lane) {
        const bool is_constant = kind == VolumeNodeKind::calm || kind == VolumeNodeKind::direct;
        const bool is_both = kind == VolumeNodeKind::both;
        put(kind == VolumeNodeKind::direct, lane, patches_.direct);
        put(kind == VolumeNodeKind::below, lane, patches_.below);
        put(is_both, lane, patches_.both);
        patches_.is_below[lane] = kind == VolumeNodeKind::below ? 1 : 0;
        patches_.is_both[lane] = is_both ? 1 : 0;
        fill(patches_.all, patches_.varying, is_constant ? nullptr : polynomials, lane);
        fill(patches_.above, patches_.above_varying, is_both ? polynomials + 1 : nullptr, lane);
    }

    /// @param polynomial nullptr: the calm value
    void fill(double (&of)[coefficients][lanes], unsigned int (&varying)[levels], const Triquadratic* polynomial,
              int lane) const {
        constexpr int order[coefficients] = {0,  9,  18,                                              // z alone
                                             3,  6,  12, 15, 21, 24,                                  // z and lateral
                                             1,  2,  4,  5,  7,  8,  10, 11, 13, 14, 16, 17, 19, 20,  // all
                                             22, 23, 25, 26};
        constexpr int begin[levels + 1] = {1, 3, 9, coefficients};
        const auto number = [&](int i) {  // +0 for -0
            return double{(*polynomial)[static_cast<std::size_t>(order[i])]} + 0.0;
        };
        of[0][lane] = polynomial != nullptr ? number(0) : view_.calm_value;
        const int level = polynomial != nullptr ? varying_axes(*polynomial) : 0;
        for (int which = 0; which < levels; ++which) {
            const bool varies = which < level;
            const bool has_old = (varying[which] >> static_cast<unsigned int>(lane) & 1U) != 0;
            for (int i = begin[which]; i < begin[which + 1] && (varies || has_old); ++i) {
                of[order[i]][lane] = varies ? number(i) : 0;
            }
            put(varies, lane, varying[which]);
        }
    }

    static void put(bool is_set, int lane, unsigned int& bits) {
        const unsigned int bit = 1U << static_cast<unsigned int>(lane);
        bits = is_set ? bits | bit : bits & ~bit;
    }

    const VolumeView& view_;
    VolumePatches<lanes>& patches_;
    int first_;
};

}  // namespace downwash
