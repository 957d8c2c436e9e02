#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "downwash/aeromap/volume_map.hpp"
#include "downwash/base/export.hpp"
#include "downwash/simulation/space_effect.hpp"
#include "downwash/simulation/volume_field.hpp"

// The effects of surfaces in volumes, for flights in space: lazily filled, shared by all flights of a robot.

namespace downwash {

/// The volumes that the rotors of a robot fly through. They are fields over places, whatever the heading: where a model
/// is one of several rotors, K is put together from one volume of a rotor alone and one for each distance between two
/// rotors. Such a K adds up the errors of its parts, to 0.03 near the cap. Copies share what is filled. Safe to share
/// between threads: what a look-up finds does not depend on who asked first.
struct DOWNWASH_EXPORT SurfaceVolumes {
    /// Fills nothing, and looks at nothing in the scene. Outside the block everything is evaluated directly.
    /// @param frame,extent,lateral_low_m,lateral_high_m a block of places of hubs, as of VolumeMap
    /// @throws InputError if a setting is out of range, the block is empty or not finite, or too large
    SurfaceVolumes(const std::shared_ptr<const Scene>& scene, const AeroSettings& aero, const SpaceRobot& robot,
                   const PlaneOfMotion& frame, const Bounds& extent, double lateral_low_m, double lateral_high_m);

    /// Adds what a cache has of the volumes. @param folder of a MapCache; empty: no cache
    void read(const std::filesystem::path& folder);
    /// Keeps what is new in the volumes. @param folder of a MapCache; empty: nowhere
    void keep(const std::filesystem::path& folder) const;

    /// What the image of one rotor does to another at a distance.
    struct Image {
        double distance_radii;
        std::shared_ptr<VolumeMap> map;
    };

    std::shared_ptr<VolumeMap> rotor;     ///< of a rotor alone; its flyable area is that of all rotors
    std::vector<Image> images;            ///< empty where no model is one of several rotors
    std::shared_ptr<VolumeMap> fountain;  ///< of one disc; nullptr: there is none
    std::shared_ptr<VolumeMap> walls;     ///< nullptr: walls do nothing
    bool has_ground_images = false, has_ceiling_images = false;
};

namespace simulation {

/// Volumes of a robot to look up in. @pre they outlive the views
[[nodiscard]] DOWNWASH_EXPORT SpaceVolumeViews views_of(const SurfaceVolumes& volumes, const SpaceRobot& robot);

/// The effects of a scene on a robot's rotors, looked up in volumes along one flight: the VolumeField of one lane.
class DOWNWASH_EXPORT VolumeSpaceEffect final : public SpaceEffect {
 public:
    /// @param volumes of this robot; shared
    VolumeSpaceEffect(const SurfaceVolumes& volumes, const SpaceRobot& robot);

    SidedFactor<double> at_rotor(int rotor, const dynamics::LaneVector<double>& hub_m) override;
    SidedFactor<double> at_body(const dynamics::LaneVector<double>& center_m) override;
    SidedFactor<double> at_turned_rotor(int rotor, const dynamics::LaneVector<double>& hub_m,
                                        const dynamics::LaneRotation<double>& attitude) override;
    SidedFactor<double> at_turned_body(const dynamics::LaneVector<double>& center_m,
                                       const dynamics::LaneRotation<double>& attitude) override;
    dynamics::LaneVector<double> wall_nearness(const dynamics::LaneVector<double>& center_m) override;
    /// Exact.
    bool is_flyable(int rotor, const dynamics::LaneVector<double>& hub_m) override;

 private:
    SurfaceVolumes volumes_;
    SpaceVolumeViews views_;
    std::vector<VolumePatches<1>> patches_;
    VolumeField<double> field_;
};

}  // namespace simulation
}  // namespace downwash
