#pragma once

#include "downwash/aeromap/map_view.hpp"
#include "downwash/base/export.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/dynamics/plant.hpp"
#include "downwash/effects/sided_factor.hpp"

// Surface effects along a flight, one template over the lane type: kernels for wide instructions include this. What is
// no template here is always inlined, so that no copy of it that only some processors understand reaches the linker.

namespace downwash {
class AeroMap;
class FlightModel;
}  // namespace downwash

namespace downwash::simulation {

/// No surface effect anywhere.
struct NoEffect {
    /// K = 1 at any hub.
    template <class T>
    T operator()(int /*rotor*/, T /*x_m*/, T /*z_m*/) const {
        return T(1);
    }
    /// The same by side.
    template <class T>
    SidedFactor<T> sided(int /*rotor*/, T /*x_m*/, T /*z_m*/) const {
        return {T(1), T(1)};
    }
    /// All rotors share the first one's.
    [[nodiscard, gnu::always_inline]] int same_as(int /*rotor*/) const noexcept { return 0; }
};

/// The layers of a map that rotors and body of a vehicle fly through.
struct RotorMaps {
    const FlightModel* model;
    const AeroMap* map;
    MapView view[max_rotors + 2];  ///< per rotor; then of the body, where there is a fountain; then of walls
    /// The earliest rotor, or the rotor itself, that shares its look-up: rotors one behind the other as seen along the
    /// lateral axis, where their layers hold the same.
    int same_as[max_rotors];
};

/// @pre model and map outlive the result, and the map has the model's layers
[[nodiscard]] DOWNWASH_EXPORT RotorMaps rotor_maps(const FlightModel& model, const AeroMap& map);

/// K beyond the map, evaluated directly.
[[nodiscard]] DOWNWASH_EXPORT SidedFactor<double> factor_outside(const RotorMaps& maps, int rotor, double x_m,
                                                                 double z_m);

/// The effect looked up in a map along the flights of all lanes. It remembers the patch of the map in which every rotor
/// is; the values are those of AeroMap::factor() to the last bit.
template <class T>
class MapEffect {
 public:
    /// @pre `maps` outlives the object
    explicit MapEffect(const RotorMaps& maps) : maps_(maps) {
        for (Patches& patches : patches_) {
            for (int lane = 0; lane < width; ++lane) {
                enter(nowhere, patches, lane);
            }
        }
    }

    [[nodiscard]] int same_as(int rotor) const { return maps_.same_as[rotor]; }

    /// K at the hub of a rotor, or of the body, in the plane.
    T operator()(int rotor, T x_m, T z_m) {
        const Patches& patches = patches_[rotor];
        const Place at = place(rotor, x_m, z_m);
        if (const unsigned int elsewhere = elsewhere_bits(at); elsewhere != 0) {
            return look_up(rotor, x_m, z_m, at, elsewhere).all;
        }
        return interpolated(patches.corner, at);
    }

    /// The same by side.
    SidedFactor<T> sided(int rotor, T x_m, T z_m) {
        const Patches& patches = patches_[rotor];
        const Place at = place(rotor, x_m, z_m);
        if (const unsigned int elsewhere = elsewhere_bits(at); elsewhere != 0) {
            return look_up(rotor, x_m, z_m, at, elsewhere);
        }
        return sides(patches, at);
    }

    /// 0 in lanes whose hub is in a cell that is flyable throughout.
    [[nodiscard]] T doubt(int rotor, T x_m, T z_m) {
        const Place at = place(rotor, x_m, z_m);
        if (const unsigned int elsewhere = elsewhere_bits(at); elsewhere != 0) {
            move_patches(rotor, at, elsewhere);
        }
        return lane::load<T>(patches_[rotor].doubt);
    }

 private:
    static constexpr int width = lane::width<T>;
    static constexpr MapPatch nowhere = no_patch;  // a copy with the linkage of T

    /// The patches of one layer that the lanes are in.
    struct alignas(sizeof(T)) Patches {
        double u[width], w[width];
        double steps_x[width], steps_z[width];
        double corner[4][width], above[4][width];
        double doubt[width];          ///< 0 where the cell is flyable throughout
        unsigned int have_above = 0;  ///< the lanes, as bits, whose patch has a part from above
    };

    /// Hubs in cells from the lower corner of a layer, and as shares of the patches.
    struct Place {
        T u, w, s, t;
    };

    static void enter(const MapPatch& patch, Patches& patches, int lane) {
        patches.u[lane] = patch.u;
        patches.w[lane] = patch.w;
        patches.steps_x[lane] = patch.steps_x;
        patches.steps_z[lane] = patch.steps_z;
        for (int i = 0; i < 4; ++i) {
            patches.corner[i][lane] = patch.corner[i];
            patches.above[i][lane] = patch.above[i];
        }
        patches.doubt[lane] = patch.flyability == CellFlyability::flyable ? 0 : 1;
        const unsigned int bit = 1U << static_cast<unsigned int>(lane);
        const bool has_above = patch.above[0] != 1 || patch.above[1] != 1 || patch.above[2] != 1 || patch.above[3] != 1;
        patches.have_above = has_above ? patches.have_above | bit : patches.have_above & ~bit;
    }

    [[nodiscard]] Place place(int rotor, T x_m, T z_m) const {
        const MapView& view = maps_.view[rotor];
        return in_patches(rotor, (x_m - T(view.x_low_m)) * T(view.cells_per_m),
                          (z_m - T(view.z_low_m)) * T(view.cells_per_m));
    }
    [[nodiscard]] Place in_patches(int rotor, T u, T w) const {
        const Patches& patches = patches_[rotor];
        return {u, w, (u - lane::load<T>(patches.u)) * lane::load<T>(patches.steps_x),
                (w - lane::load<T>(patches.w)) * lane::load<T>(patches.steps_z)};
    }

    /// The lanes whose hub is not in its patch, as bits. Exact: the share of a place in the patch is, and that of any
    /// other place falls outside [0, 1) however it is rounded. NaN is nowhere.
    static unsigned int elsewhere_bits(const Place& at) {
        return lane::bits_of(!((at.s >= T(0)) & (at.s < T(1)) & (at.t >= T(0)) & (at.t < T(1))));
    }

    static T interpolated(const double (&corners)[4][width], const Place& at) {
        const T corner[4] = {lane::load<T>(corners[0]), lane::load<T>(corners[1]), lane::load<T>(corners[2]),
                             lane::load<T>(corners[3])};
        return bilinear(corner, at.s, at.t);
    }

    /// Where no lane has a part from above, it is 1 and need not be interpolated.
    static SidedFactor<T> sides(const Patches& patches, const Place& at) {
        return {interpolated(patches.corner, at), patches.have_above != 0 ? interpolated(patches.above, at) : T(1)};
    }

    /// Enters the patches around hubs that have left theirs, given as bits. Those outside the map are in none.
    /// @return the lanes outside
    [[gnu::noinline]] unsigned int move_patches(int rotor, const Place& at, unsigned int elsewhere) {
        const MapView& view = maps_.view[rotor];
        unsigned int outside = 0;
        for (; elsewhere != 0; elsewhere &= elsewhere - 1) {
            const int lane = __builtin_ctz(elsewhere);
            const double u = lane::number_in(at.u, lane);
            const double w = lane::number_in(at.w, lane);
            if (view.contains(u, w)) {
                enter(patch_at(view, u, w), patches_[rotor], lane);
            } else {
                enter(nowhere, patches_[rotor], lane);
                outside |= 1U << static_cast<unsigned int>(lane);
            }
        }
        return outside;
    }

    /// K where some lanes, given as bits, have left their patches.
    [[gnu::noinline]] SidedFactor<T> look_up(int rotor, T x_m, T z_m, const Place& at, unsigned int elsewhere) {
        unsigned int outside = move_patches(rotor, at, elsewhere);
        const Place now = in_patches(rotor, at.u, at.w);
        SidedFactor<T> result = sides(patches_[rotor], now);
        for (; outside != 0; outside &= outside - 1) {
            const int lane = __builtin_ctz(outside);
            const SidedFactor<double> there =
                factor_outside(maps_, rotor, lane::number_in(x_m, lane), lane::number_in(z_m, lane));
            lane::set_number(result.all, lane, there.all);
            lane::set_number(result.above, lane, there.above);
        }
        return result;
    }

    const RotorMaps& maps_;
    Patches patches_[max_rotors + 2];
};

}  // namespace downwash::simulation
