#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/simulation/space_robot.hpp"

// What surfaces do to a vehicle in space, put together from fields of single level discs that are evaluated directly
// (docs/model.md 4.8 and 4.11). Private: not installed.

namespace downwash::judge {

/// Surfaces in their nominal places around a robot. Immutable and safe to share between threads.
class SpaceSurfaces {
 public:
    /// @throws InputError if a setting is out of range   @pre aero.enabled
    DOWNWASH_EXPORT SpaceSurfaces(const std::shared_ptr<const Scene>& scene, const AeroSettings& aero,
                                  const SpaceRobot& robot);

    /// K by side of the level discs of all rotors, one for each hub.
    /// @param hubs_m of all rotors, in the robot's order, wherever an attitude puts them
    [[nodiscard]] DOWNWASH_EXPORT std::vector<SidedFactor<double>> at_rotors(
        const std::vector<Eigen::Vector3d>& hubs_m) const;
    /// K_body - 1 of a level vehicle, a push from the ground; 0 without a fountain.
    [[nodiscard]] DOWNWASH_EXPORT double fountain(const std::vector<Eigen::Vector3d>& hubs_m) const;
    /// Level vector towards the nearest wall, of length exp(-gap / (l R)); 0 where walls do nothing.
    /// @param center_m between the rotors
    [[nodiscard]] DOWNWASH_EXPORT Eigen::Vector3d towards_wall(const Eigen::Vector3d& center_m) const;
    /// Whether a given map, if there is one, says that a rotor may be there.
    [[nodiscard]] DOWNWASH_EXPORT bool is_given_map_flyable(const Eigen::Vector3d& hub_m) const;

    [[nodiscard]] const AeroSettings& settings() const noexcept { return aero_; }
    [[nodiscard]] double rotor_radius_m() const noexcept { return rotor_.rotor_radius_m(); }

 private:
    /// What the image of a rotor does to another at a distance, as if it were K.
    struct Image {
        double distance_radii;
        DirectEffect field;
    };
    [[nodiscard]] double with_images(double alone, double taken) const;

    AeroSettings aero_;
    bool has_ground_images_, has_ceiling_images_;
    DirectEffect rotor_;  ///< one rotor alone
    std::vector<Image> images_;
    std::vector<std::vector<std::size_t>> image_;  ///< which of images_ belongs to two rotors
    std::optional<DirectEffect> fountain_, walls_;
};

}  // namespace downwash::judge
