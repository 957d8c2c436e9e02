#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "downwash/aeromap/aero_settings.hpp"
#include "downwash/base/export.hpp"
#include "downwash/effects/effect_curve.hpp"
#include "downwash/scene/scene.hpp"

namespace downwash {

class CurveMean;
class Footprints;
class RotorImages;
enum class Side : std::uint8_t;

/// The exact surface effect on one rotor at any point of the world. Maps interpolate it, and executed flights evaluate
/// it. The disc is level and rays are vertical (docs/model.md 4.1). Immutable.
class DOWNWASH_EXPORT DirectEffect {
 public:
    /// The effect on a rotor.
    /// @param rotor_radius_m R > 0   @param neighbours the vehicle's other rotors, for the multirotor models
    /// @throws InputError if a setting or the radius is out of range
    DirectEffect(std::shared_ptr<const Scene> scene, const AeroSettings& settings, double rotor_radius_m,
                 const RotorNeighbours& neighbours = {});

    /// The fountain's push on a vehicle's body at its centre between the rotors: 1 + (K_whole - K_images), averaged
    /// over the discs of all rotors (docs/model.md 4.3). Defined everywhere, so that everything is flyable.
    /// @param neighbours of any of its rotors   @pre settings.ground.model is multirotor_body
    [[nodiscard]] static DirectEffect fountain(std::shared_ptr<const Scene> scene, const AeroSettings& settings,
                                               double rotor_radius_m, const RotorNeighbours& neighbours);

    /// The same field at the disc of one rotor, whatever the heading: a fountain's push is its mean over all discs.
    [[nodiscard]] static DirectEffect fountain_on_disc(std::shared_ptr<const Scene> scene, const AeroSettings& settings,
                                                       double rotor_radius_m, const RotorNeighbours& neighbours);

    /// What the image of one rotor does to another, as if it were K, and only on the sides whose model is one of
    /// several rotors (docs/model.md 4.1): a field over places, whatever the heading. sided_factor() has its sides.
    /// @param distance_radii of the two rotors
    [[nodiscard]] static DirectEffect image(std::shared_ptr<const Scene> scene, const AeroSettings& settings,
                                            double rotor_radius_m, double distance_radii);

    /// How near walls are: 1 + cos(angle) exp(-gap / decay), with the angle between the plane of motion and the nearest
    /// wall at the height of the centre between the rotors, and the gap between that wall and the nearest rotor's edge
    /// (docs/model.md 4.8). Above 1 where the wall is ahead. Defined everywhere, so that everything is flyable.
    /// @param reach_m from that centre to the hub of the foremost rotor, >= 0   @param heading_rad of the plane
    [[nodiscard]] static DirectEffect walls(std::shared_ptr<const Scene> scene, const AeroSettings& settings,
                                            double rotor_radius_m, double reach_m, double heading_rad);

    /// The same for a vehicle in space, which has no plane of motion: see towards_wall(). factors() are not defined.
    /// @param reach_m from the centre between the rotors to the farthest hub, >= 0
    [[nodiscard]] static DirectEffect walls_around(std::shared_ptr<const Scene> scene, const AeroSettings& settings,
                                                   double rotor_radius_m, double reach_m);

    /// The vector towards the nearest wall at the height of the centre between the rotors: level, of length
    /// exp(-gap / decay), and 0 where no wall is. gap is that between the wall and the edge of a rotor on this side,
    /// whatever the heading. Between two walls it turns over 2 cm; there it is shorter. 0 when not finite.
    /// @pre made by walls_around()
    [[nodiscard]] Vector3 towards_wall(const Vector3& center_m) const;

    /// The two one-sided factors and their superposition at a rotor hub.
    struct Factors {
        double ground = 1;   ///< surfaces below; 1 + disc average of k - 1
        double ceiling = 1;  ///< surfaces above
        double total = 1;    ///< 1 + (ground - 1) + (ceiling - 1), capped at max_factor (docs/model.md 4.2)
    };

    /// Factors at the world position of a rotor hub; 1 for a position that is not finite. A point of the disc inside an
    /// obstacle counts as touching it. A given map has no one-sided factors (NaN) and is 1 where it does not reach.
    /// Inside a mesh only its triangles count, as sheets. Absolute quadrature error in the flyable area: below 1e-11
    /// under level faces with straight edges, below 2e-3 for any, below 5e-3 with more than 24 parts
    /// (Scene::part_count) over or under the disc. In scenes of more than 2048 parts: below 1e-3 in the flyable area
    /// (docs/model.md 4.9). The last three hold where K differs by at most 1 over the disc, as with the default
    /// max_factor of 2; where it differs by more they grow in proportion, to 9 times under a max_factor of 10.
    [[nodiscard]] Factors factors(const Vector3& hub_m) const;

    /// K of all surfaces and of those above alone. A given map does not tell them apart and counts as above.
    [[nodiscard]] SidedFactor<double> sided_factor(const Vector3& hub_m) const;

    /// sided_factor() of a rotor of a vehicle at any attitude: its neighbours are at their real places. The same where
    /// no model is one of several rotors.
    /// @param neighbours_m their hubs, in the order of the neighbours that this was made with
    [[nodiscard]] SidedFactor<double> sided_factor(const Vector3& hub_m, std::span<const Vector3> neighbours_m) const;

    /// The fountain's push on a body among rotors at their real places, 1 + (K_whole - K_images) averaged over their
    /// discs. @param hubs_m of all rotors   @pre made by fountain()
    [[nodiscard]] double fountain_factor(std::span<const Vector3> hubs_m) const;

    /// The thrust ratio K on the commanded free-air thrust.
    [[nodiscard]] double factor(const Vector3& hub_m) const { return factors(hub_m).total; }

    /// Whether the level disc keeps min_distance_radii * R from every obstacle (docs/model.md 4.4), and a given map
    /// reaches here and does not say otherwise (FactorGrid::is_flyable). With the effects disabled every finite
    /// position is flyable.
    [[nodiscard]] bool is_flyable(const Vector3& hub_m) const;

    [[nodiscard]] const Scene& scene() const noexcept { return *scene_; }
    [[nodiscard]] const AeroSettings& settings() const noexcept { return settings_; }
    [[nodiscard]] double rotor_radius_m() const noexcept { return rotor_radius_m_; }
    /// Radius of the column over and under which surfaces have an effect: the rotor's; with a fountain that of the
    /// circle around all rotors.
    [[nodiscard]] double column_radius_m() const noexcept { return column_radius_m_; }
    /// Least distance of the disc from every obstacle in the flyable area; negative: everything is flyable.
    [[nodiscard]] double min_clearance_m() const noexcept { return min_clearance_m_; }
    /// K of wide flat surfaces below and above; not used if the settings contain a map.
    [[nodiscard]] const EffectCurve& ground() const noexcept { return ground_; }
    [[nodiscard]] const EffectCurve& ceiling() const noexcept { return ceiling_; }
    /// The parts of the scene as rotors see them; private to aeromap.
    [[nodiscard]] const Footprints& footprints() const noexcept { return *footprints_; }
    /// Whether this is how near walls are, see walls(), and no thrust ratio.
    [[nodiscard]] bool is_of_walls() const noexcept { return wall_view_.has_value(); }
    /// Whether it is that of walls_around().
    [[nodiscard]] bool is_of_walls_around() const noexcept { return wall_view_.has_value() && wall_view_->is_around; }
    /// How far walls() looks: from the centre between the rotors to the hub of the foremost one. @pre is_of_walls()
    [[nodiscard]] double wall_reach_m() const noexcept { return wall_view_->reach_m; }
    /// Upper bounds of |K - 1| where no surface below, or above, is nearer than a distance in radii.
    [[nodiscard]] double largest_change_from_below(double beyond_radii) const;
    [[nodiscard]] double largest_change_from_above(double beyond_radii) const;

 private:
    /// Where to look for walls.
    struct WallView {
        double reach_m;
        Vector3 ahead;           ///< unit vector along the plane of motion, level
        bool is_around = false;  ///< in all directions, not ahead alone
    };

    /// @param neighbours_m where neighbours are, if the vehicle is not level
    [[nodiscard]] double one_sided(Side side, const Vector3& hub_m,
                                   const std::span<const Vector3>* neighbours_m = nullptr) const;
    [[nodiscard]] double averaged(Side side, const Vector3& hub_m, const EffectCurve& curve) const;
    [[nodiscard]] Factors superposed(double ground, double ceiling) const;
    [[nodiscard]] double wall_nearness(const Vector3& center_m) const;

    std::shared_ptr<const Scene> scene_;
    AeroSettings settings_;
    double rotor_radius_m_;
    double column_radius_m_;
    double min_clearance_m_;
    EffectCurve ground_, ceiling_;
    std::shared_ptr<const CurveMean> ground_mean_, ceiling_mean_;        ///< null for curves that have none
    std::shared_ptr<const RotorImages> ground_images_, ceiling_images_;  ///< images of the multirotor models
    std::vector<Vector3> fountain_hubs_m_;                               ///< from the centre, level; empty for a rotor
    std::optional<WallView> wall_view_;
    std::shared_ptr<const Footprints> footprints_;
};

}  // namespace downwash
