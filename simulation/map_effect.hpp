#pragma once

#include "downwash/aeromap/map_view.hpp"
#include "downwash/base/export.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/simulation/effect_field.hpp"

// Surface effects along a flight, one template over the lane type: kernels for wide instructions include this. What is
// no template here is always inlined, so that no copy of it that only some processors understand reaches the linker.

namespace downwash {
class AeroMap;
class FlightModel;
}  // namespace downwash

namespace downwash::simulation {

/// The layers of a map that rotors and body of a vehicle fly through.
struct RotorMaps {
    const AeroMap* map;            ///< nullptr: there is none, and no surface has an effect
    MapView view[max_rotors + 2];  ///< map of every rotor; at body_place and wall_place those of the body and of walls
    std::size_t layer[max_rotors + 2];  ///< layer of the map, in the same order
    /// The earliest rotor, or the rotor itself, whose look-up serves wherever the blocks of both layers hold the same:
    /// rotors one behind the other as seen along the lateral axis.
    int same_as[max_rotors];
    unsigned int followers[max_rotors + 2];  ///< the other rotors that may be served by one, as bits

    static constexpr int body_place = max_rotors;      ///< filled where there is a fountain
    static constexpr int wall_place = max_rotors + 1;  ///< filled where there are walls
};

/// @pre the map outlives the result, and has the model's layers
[[nodiscard]] DOWNWASH_EXPORT RotorMaps rotor_maps(const FlightModel& model, const AeroMap& map);

/// K beyond the map, evaluated directly. @param place number of a rotor, body_place or wall_place
[[nodiscard]] DOWNWASH_EXPORT SidedFactor<double> factor_outside(const RotorMaps& maps, int place, double x_m,
                                                                 double z_m);

/// No map, through which all rotors share one look-up.
[[nodiscard]] inline RotorMaps no_rotor_maps() noexcept {
    return {nullptr, {}, {}, {}, {}};
}

/// The patches of one layer that some flights are in; [..][flight]. Nothing but double.
template <int flights>
struct alignas(flights % 8 == 0 ? 64 : 8) MapPatches {
    double u[flights], w[flights];  ///< members of MapPatch
    double steps_x[flights], steps_z[flights];
    double corner[4][flights], above[4][flights];
    double doubt[flights];      ///< 0 where the cell is flyable throughout
    double has_above[flights];  ///< 1 where the patch has a part from above
    double is_apart[flights];   ///< 1 where a follower of the layer's rotor needs a look-up of its own
};

/// Makes a flight enter a patch. @param is_apart whether a follower of the layer's rotor needs a look-up of its own
template <int flights>
[[gnu::always_inline]] inline void enter(const MapPatch& patch, MapPatches<flights>& patches, int flight,
                                         bool is_apart = false) {
    patches.u[flight] = patch.u;
    patches.w[flight] = patch.w;
    patches.steps_x[flight] = patch.steps_x;
    patches.steps_z[flight] = patch.steps_z;
    for (int i = 0; i < 4; ++i) {
        patches.corner[i][flight] = patch.corner[i];
        patches.above[i][flight] = patch.above[i];
    }
    patches.doubt[flight] = patch.flyability == CellFlyability::flyable ? 0 : 1;
    const bool has_above = patch.above[0] != 1 || patch.above[1] != 1 || patch.above[2] != 1 || patch.above[3] != 1;
    patches.has_above[flight] = has_above ? 1 : 0;
    patches.is_apart[flight] = is_apart ? 1 : 0;
}

/// The patches of every layer, in the order of RotorMaps, of the flights in the lanes of T.
template <class T>
struct OwnPatches {
    static constexpr int flights = lane::width<T>;
    static constexpr int first = 0;
    MapPatches<flights> of_place[max_rotors + 2];
};

/// The same of as many of a greater number of flights, kept by someone else.
template <int count>
struct LentPatches {
    static constexpr int flights = count;
    int first;  ///< flight in the first lane of T
    MapPatches<count>* of_place;
};

/// The EffectField looked up in a map along the flights of all lanes. It remembers the patch of the map in which every
/// rotor is; the values are those of AeroMap::factor() to the last bit.
/// @tparam Patches OwnPatches or LentPatches
template <class T, class Patches = OwnPatches<T>>
class MapEffect {
 public:
    /// @pre `maps` outlives the object
    explicit MapEffect(const RotorMaps& maps) : maps_(maps) {
        for (auto& patches : patches_.of_place) {
            for (int lane = 0; lane < width; ++lane) {
                enter(nowhere, patches, lane);
            }
        }
    }
    /// @param patches in which the flights are, each perhaps in none   @pre `maps` outlives the object
    MapEffect(const RotorMaps& maps, const Patches& patches) : maps_(maps), patches_(patches) {}

    SidedFactor<T> at_rotor(int rotor, const T& x_m, const T& z_m) { return at_place(rotor, x_m, z_m); }
    /// Holds for the place where the earlier rotor was looked up last.
    [[nodiscard]] int same_as(int rotor) const {
        const int earlier = maps_.same_as[rotor];
        const bool are_together = lane::bits_of(load(patches_.of_place[earlier].is_apart) > T(0)) == 0;
        return are_together ? earlier : rotor;
    }
    SidedFactor<T> at_body(const T& x_m, const T& z_m) { return at_place(RotorMaps::body_place, x_m, z_m); }
    T wall_nearness(const T& x_m, const T& z_m) { return at_place(RotorMaps::wall_place, x_m, z_m).all - T(1); }
    MapEffect& as_read() { return *this; }

    /// 0 in lanes whose hub is in a cell that is flyable throughout.
    [[nodiscard]] T doubt(int rotor, T x_m, T z_m) {
        if (maps_.map == nullptr) {
            return T(0);
        }
        const Position at = position(rotor, x_m, z_m);
        if (const unsigned int elsewhere = elsewhere_bits(at); elsewhere != 0) {
            move_patches(rotor, at, elsewhere);
        }
        return load(patches_.of_place[rotor].doubt);
    }

 private:
    static constexpr int width = lane::width<T>;
    static constexpr MapPatch nowhere = no_patch;  // a copy with the linkage of T

    /// Where the lanes are in cells from the lower corner of a layer, and as shares of the patches.
    struct Position {
        T u, w, s, t;
    };

    using PlacePatches = MapPatches<Patches::flights>;

    [[nodiscard]] T load(const double (&numbers)[Patches::flights]) const {
        return lane::load<T>(numbers + patches_.first);
    }

    SidedFactor<T> at_place(int place, const T& x_m, const T& z_m) {
        if (maps_.map == nullptr) {
            return {T(1), T(1)};
        }
        const PlacePatches& patches = patches_.of_place[place];
        const Position at = position(place, x_m, z_m);
        if (const unsigned int elsewhere = elsewhere_bits(at); elsewhere != 0) {
            return look_up(place, x_m, z_m, at, elsewhere);
        }
        return sides(patches, at);
    }

    [[nodiscard]] Position position(int place, T x_m, T z_m) const {
        const MapView& view = maps_.view[place];
        return in_patches(place, (x_m - T(view.x_low_m)) * T(view.cells_per_m),
                          (z_m - T(view.z_low_m)) * T(view.cells_per_m));
    }
    [[nodiscard]] Position in_patches(int place, T u, T w) const {
        const PlacePatches& patches = patches_.of_place[place];
        return {u, w, (u - load(patches.u)) * load(patches.steps_x), (w - load(patches.w)) * load(patches.steps_z)};
    }

    /// The lanes whose hub is not in its patch, as bits. Exact: the share of a place in the patch is, and that of any
    /// other place falls outside [0, 1) however it is rounded. NaN is nowhere.
    static unsigned int elsewhere_bits(const Position& at) {
        return lane::bits_of(!((at.s >= T(0)) & (at.s < T(1)) & (at.t >= T(0)) & (at.t < T(1))));
    }

    T interpolated(const double (&corners)[4][Patches::flights], const Position& at) const {
        const T corner[4] = {load(corners[0]), load(corners[1]), load(corners[2]), load(corners[3])};
        return bilinear(corner, at.s, at.t);
    }

    /// Where no lane has a part from above, it is 1 and need not be interpolated.
    SidedFactor<T> sides(const PlacePatches& patches, const Position& at) const {
        const bool have_above = lane::bits_of(load(patches.has_above) > T(0)) != 0;
        return {interpolated(patches.corner, at), have_above ? interpolated(patches.above, at) : T(1)};
    }

    /// A block by its number in a layer, filled if need be.
    static const MapBlock& block_in(const MapView& view, std::size_t number) {
        const MapBlock* const block = __atomic_load_n(view.blocks + number, __ATOMIC_ACQUIRE);
        if (block == nullptr) [[unlikely]] {
            return filled_block(view, number);
        }
        return *block;
    }

    /// Whether some rotors, as bits, have this block at the same place of their layers, which have the same grid.
    bool all_followers_have(const MapBlock& block, std::size_t number, unsigned int followers) const {
        for (; followers != 0; followers &= followers - 1) {
            if (&block_in(maps_.view[__builtin_ctz(followers)], number) != &block) {
                return false;
            }
        }
        return true;
    }

    /// Enters the patches around hubs that have left theirs, given as bits. Those outside the map are in none.
    /// @return the lanes outside
    [[gnu::noinline]] unsigned int move_patches(int place, const Position& at, unsigned int elsewhere) {
        const MapView& view = maps_.view[place];
        unsigned int outside = 0;
        for (; elsewhere != 0; elsewhere &= elsewhere - 1) {
            const int lane = __builtin_ctz(elsewhere);
            const double u = lane::number_in(at.u, lane);
            const double w = lane::number_in(at.w, lane);
            if (view.contains(u, w)) {
                const std::size_t number = block_number(view, u, w);
                const MapBlock& block = block_in(view, number);
                const bool is_apart = !all_followers_have(block, number, maps_.followers[place]);
                enter(patch_in(block, u, w), patches_.of_place[place], patches_.first + lane, is_apart);
            } else {
                enter(nowhere, patches_.of_place[place], patches_.first + lane, maps_.followers[place] != 0);
                outside |= 1U << static_cast<unsigned int>(lane);
            }
        }
        return outside;
    }

    /// K where some lanes, given as bits, have left their patches.
    [[gnu::noinline]] SidedFactor<T> look_up(int place, T x_m, T z_m, const Position& at, unsigned int elsewhere) {
        unsigned int outside = move_patches(place, at, elsewhere);
        const Position now = in_patches(place, at.u, at.w);
        SidedFactor<T> result = sides(patches_.of_place[place], now);
        for (; outside != 0; outside &= outside - 1) {
            const int lane = __builtin_ctz(outside);
            const SidedFactor<double> there =
                factor_outside(maps_, place, lane::number_in(x_m, lane), lane::number_in(z_m, lane));
            lane::set_number(result.all, lane, there.all);
            lane::set_number(result.above, lane, there.above);
        }
        return result;
    }

    const RotorMaps& maps_;
    Patches patches_;
};

}  // namespace downwash::simulation
