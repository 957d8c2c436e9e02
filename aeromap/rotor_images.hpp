#pragma once

// Private to aeromap.

#include <memory>
#include <span>
#include <vector>

#include "downwash/aeromap/disc_query.hpp"
#include "downwash/aeromap/footprint.hpp"

namespace downwash {

/// Over what a side of the discs is averaged.
struct DiscSide {
    const Scene& scene;
    const Footprints& footprints;
    Side side;
};

/// The rotors of a level vehicle and their images in finite surfaces (docs/model.md 4.1). A rotor's own image acts as
/// on a single rotor. That of a neighbour counts as far as both discs are over the surface: by the lesser of the means
/// over the two discs. Immutable.
class RotorImages {
 public:
    /// @param neighbours of the rotor that is asked for first
    RotorImages(double radius_m, double max_factor, const RotorNeighbours& neighbours);

    /// K of a rotor at a hub.
    [[nodiscard]] double factor(const DiscSide& on, const Vector3& hub_m) const;
    /// The same with the neighbours' hubs wherever the vehicle's attitude puts them. The image of each is that of the
    /// level vehicle. @param neighbours_m in the order of the neighbours that this was made with
    [[nodiscard]] double factor(const DiscSide& on, const Vector3& hub_m, std::span<const Vector3> neighbours_m) const;
    /// Upper bound of K - 1 where no surface is nearer than this to the rotor's own plane.
    [[nodiscard]] double largest_change_beyond(double z_over_r) const;

 private:
    /// What one rotor takes of another's induced velocity.
    struct Neighbour {
        double x_m, y_m;    ///< offset of its hub
        std::size_t image;  ///< which of images_
    };
    [[nodiscard]] double mean(const DiscSide& on, const Vector3& hub_m, const EffectCurve& curve,
                              const CurveMean* integral = nullptr) const;
    /// The share of a rotor's induced velocity that all images take; may exceed 1 close to a surface.
    /// @param neighbour_m the hub of a neighbour by its number
    template <class NeighbourHub>
    [[nodiscard]] double loss(const DiscSide& on, const Vector3& hub_m, const NeighbourHub& neighbour_m) const;

    double radius_m_;
    double max_factor_;
    EffectCurve single_;                         ///< one rotor alone
    std::shared_ptr<const CurveMean> integral_;  ///< the integral of single_
    std::vector<EffectCurve> images_;            ///< one for each distance that occurs
    std::vector<Neighbour> neighbours_;          ///< the nearest first
};

}  // namespace downwash
