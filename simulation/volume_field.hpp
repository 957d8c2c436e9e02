#pragma once

#include "downwash/aeromap/volume_patches.hpp"
#include "downwash/dynamics/lane_vector.hpp"
#include "downwash/dynamics/plant.hpp"

// Volumes as the effects of surfaces along flights in space, one template over the lane type.

namespace downwash::simulation {

/// The volumes of a robot to look up in, and how K of several rotors is put together from them: see SurfaceVolumes.
struct SpaceVolumeViews {
    /// A rotor as another one sees it.
    struct Neighbour {
        dynamics::LaneVector<double> offset_m;  ///< of its hub, in the vehicle's axes
        int rotor = 0, image = 0;               ///< its number, and that of the volume of its image
    };
    static constexpr int max_images = max_rotors * (max_rotors - 1) / 2;

    bool has_rotors = false, has_walls = false, has_fountain = false;
    bool has_ground_images = false, has_ceiling_images = false;
    int rotor_count = 0;
    int image_count = 0;
    double max_factor = 1;  ///< the largest K
    VolumeView rotor{};     ///< of K of a rotor alone, the same for all rotors
    VolumeView walls{};     ///< of how near walls are
    VolumeView fountain{};  ///< of what a fountain does to one disc
    VolumeView image[max_images] = {};
    Neighbour neighbour[max_rotors][max_rotors - 1] = {};         ///< of each rotor rotor_count - 1
    dynamics::LaneVector<double> from_center_m[max_rotors] = {};  ///< of each hub from the centre between them

    /// The patches of each rotor, of walls, of each disc, of each rotor in each image: so many a field needs.
    [[nodiscard]] int patches() const {
        if (!has_rotors) {
            return 0;
        }
        return image_count > 0 || has_fountain ? first_image + max_rotors * image_count : first_disc;
    }
    static constexpr int of_walls = max_rotors;
    static constexpr int first_disc = of_walls + 1;
    static constexpr int first_image = first_disc + max_rotors;
};

/// A TurningSpaceField (space_surroundings.hpp) of volumes.
template <class T, int lanes = lane::width<T>>
class VolumeField {
 public:
    using Vector = dynamics::LaneVector<T>;
    using Rotation = dynamics::LaneRotation<T>;

    /// The attitude of a level vehicle that heads along x.
    static Rotation level() { return {{T(1), T(0), T(0)}, {T(0), T(1), T(0)}, {T(0), T(0), T(1)}}; }

    /// @param patches views.patches(), for as many lanes   @pre all outlive the field
    VolumeField(const SpaceVolumeViews& views, VolumePatches<lanes>* patches, int first_lane = 0)
        : views_(views), patches_(patches), first_(first_lane) {}

    SidedFactor<T> at_rotor(int rotor, const Vector& hub_m) { return at_turned_rotor(rotor, hub_m, level()); }
    SidedFactor<T> at_body(const Vector& center_m) { return at_turned_body(center_m, level()); }
    SidedFactor<T> at_turned_rotor(int rotor, const Vector& hub_m, const Rotation& attitude) {
        if (!views_.has_rotors) {
            return {T(1), T(1)};
        }
        const SidedFactor<T> alone = looked_up(views_.rotor, rotor, hub_m);
        return views_.image_count == 0 ? alone : among_images(rotor, hub_m, attitude, alone);
    }
    SidedFactor<T> at_turned_body(const Vector& center_m, const Rotation& attitude) {
        return views_.has_fountain ? in_fountain(center_m, attitude) : SidedFactor<T>{T(1), T(1)};
    }
    Vector wall_nearness(const Vector& center_m) {
        if (!views_.has_walls) {
            return {T(0), T(0), T(0)};
        }
        const SidedFactor<T> towards = looked_up(views_.walls, SpaceVolumeViews::of_walls, center_m);
        return {towards.all, towards.above, T(0)};
    }
    /// VolumeMap::margin_m() of the flyable area.
    T margin_m(int rotor, const Vector& hub_m) {
        return VolumeLookUp<T, lanes>(views_.rotor, patches_[rotor], first_).margin_m(hub_m.x, hub_m.y, hub_m.z);
    }

 private:
    SidedFactor<T> looked_up(const VolumeView& view, int patches, const Vector& at_m) {
        return VolumeLookUp<T, lanes>(view, patches_[patches], first_).at(at_m.x, at_m.y, at_m.z);
    }

    /// Each neighbour's image acts by the lesser of the values at both hubs (docs/model.md 4.11).
    [[gnu::noinline]] SidedFactor<T> among_images(int rotor, const Vector& hub_m, const Rotation& attitude,
                                                  const SidedFactor<T>& alone) {
        const auto is_calm = (alone.all >= T(1)) & (alone.all <= T(1)) & (alone.above >= T(1)) & (alone.above <= T(1));
        if (lane::bits_of(!is_calm) == 0) {
            return alone;
        }
        const auto in_image = [&](int image, int of_rotor, const Vector& at_m) {
            return looked_up(views_.image[image], SpaceVolumeViews::first_image + max_rotors * image + of_rotor, at_m);
        };
        T taken_below(0), taken_above(0);
        SidedFactor<T> own{T(1), T(1)};  // of the image that was looked at last
        for (int i = 0; i < views_.rotor_count - 1; ++i) {
            const SpaceVolumeViews::Neighbour& neighbour = views_.neighbour[rotor][i];
            if (i == 0 || neighbour.image != views_.neighbour[rotor][i - 1].image) {
                own = in_image(neighbour.image, rotor, hub_m);
            }
            const Vector other_m = hub_m + attitude * dynamics::spread<T>(neighbour.offset_m);
            const SidedFactor<T> other = in_image(neighbour.image, neighbour.rotor, other_m);
            taken_below = taken_below + lane::max(T(0), lane::min(own.all - own.above, other.all - other.above));
            taken_above = taken_above + lane::max(T(0), lane::min(own.above, other.above) - T(1));
        }
        T ground = alone.all - alone.above + T(1);
        T ceiling = alone.above;
        const auto with_images = [&](const T& factor, const T& taken) {
            return factor_with_loss(T(1) - T(1) / lane::max(T(1), factor) + taken, views_.max_factor);
        };
        if (views_.has_ground_images) {
            ground = with_images(ground, taken_below);
        }
        if (views_.has_ceiling_images) {
            ceiling = with_images(ceiling, taken_above);
        }
        const T max(views_.max_factor);
        const T all = lane::clamp(T(1) + (ground - T(1)) + (ceiling - T(1)), T(0), max);
        const T above = lane::clamp(ceiling, T(0), max);
        return {lane::select(is_calm, alone.all, all), lane::select(is_calm, alone.above, above)};
    }

    /// The mean over the discs of all rotors at their real places.
    [[gnu::noinline]] SidedFactor<T> in_fountain(const Vector& center_m, const Rotation& attitude) {
        T sum(0);
        for (int i = 0; i < views_.rotor_count; ++i) {
            const Vector hub_m = center_m + attitude * dynamics::spread<T>(views_.from_center_m[i]);
            sum = sum + looked_up(views_.fountain, SpaceVolumeViews::first_disc + i, hub_m).all;
        }
        return {sum / T(static_cast<double>(views_.rotor_count)), T(1)};
    }

    const SpaceVolumeViews& views_;
    VolumePatches<lanes>* patches_;
    int first_;
};

}  // namespace downwash::simulation
