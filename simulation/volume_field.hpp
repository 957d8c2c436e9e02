#pragma once

#include "downwash/aeromap/volume_patches.hpp"
#include "downwash/dynamics/lane_vector.hpp"
#include "downwash/dynamics/plant.hpp"

// Volumes as the effects of surfaces along flights in space, one template over the lane type.

namespace downwash::simulation {

/// Volumes to look up in.
struct SpaceVolumeViews {
    bool has_rotors = false, has_walls = false;
    VolumeView rotor{};  ///< of K, the same for all rotors
    VolumeView walls{};  ///< of how near walls are
};

/// A SpaceField (space_surroundings.hpp) of volumes. It keeps the boxes in which the rotors of all lanes are; what it
/// says does not depend on them.
template <class T>
class VolumeField {
 public:
    /// @pre the volumes outlive the field
    explicit VolumeField(const SpaceVolumeViews& views)
        : has_rotors_(views.has_rotors),
          has_walls_(views.has_walls),
          rotor_{Patches(views.rotor), Patches(views.rotor), Patches(views.rotor), Patches(views.rotor),
                 Patches(views.rotor), Patches(views.rotor), Patches(views.rotor), Patches(views.rotor)},
          walls_(views.walls) {}

    SidedFactor<T> at_rotor(int rotor, const dynamics::LaneVector<T>& hub_m) {
        return has_rotors_ ? rotor_[rotor].at(hub_m.x, hub_m.y, hub_m.z) : SidedFactor<T>{T(1), T(1)};
    }
    SidedFactor<T> at_body(const dynamics::LaneVector<T>& /*center_m*/) const { return {T(1), T(1)}; }
    dynamics::LaneVector<T> wall_nearness(const dynamics::LaneVector<T>& center_m) {
        if (!has_walls_) {
            return {T(0), T(0), T(0)};
        }
        const SidedFactor<T> towards = walls_.at(center_m.x, center_m.y, center_m.z);
        return {towards.all, towards.above, T(0)};
    }

 private:
    using Patches = VolumePatches<T>;
    static_assert(max_rotors == 8);

    bool has_rotors_, has_walls_;
    Patches rotor_[max_rotors];
    Patches walls_;
};

}  // namespace downwash::simulation
