#pragma once

#include <memory>

#include "downwash/judge/vehicle.hpp"
#include "downwash/judge/vertical_rays.hpp"
#include "downwash/simulation/flight_model.hpp"

// K where there are many obstacles, from rays. Private: not installed.

namespace downwash::judge {

/// The surface effect on rotors as docs/model.md 4.1 and 4.2 define it, by rays from points spread evenly over the
/// disc. Of what computes flights it uses the curves k alone. Error: some 1e-3 where K differs by 1 over the disc. Safe
/// to share between threads.
class RayEffect {
 public:
    /// nullptr where the judge takes the direct evaluation of the model: among few parts, and where K depends on more
    /// than what is over and under the disc
    [[nodiscard]] DOWNWASH_EXPORT static std::shared_ptr<const RayEffect> made_for(
        const std::vector<Obstacle>& obstacles, std::shared_ptr<const FlightModel> model);

    /// There is one among more parts: primitives, triangles, and boxes of an octree's cubes that are merged.
    static constexpr std::size_t many_parts = 2048;

    /// K by side of a level rotor with its hub there in the plane [m].
    [[nodiscard]] DOWNWASH_EXPORT SidedFactor<double> at_rotor(int rotor, Planar hub_m) const;

    /// K by side of a rotor near a place, to first order.
    struct Tangent {
        Planar at_m;
        SidedFactor<double> factor, slope_x_1_m, slope_z_1_m;

        [[nodiscard]] SidedFactor<double> near(Planar hub_m) const noexcept {
            const Planar away = hub_m - at_m;
            return {factor.all + slope_x_1_m.all * away.x + slope_z_1_m.all * away.z,
                    factor.above + slope_x_1_m.above * away.x + slope_z_1_m.above * away.z};
        }
    };
    [[nodiscard]] Tangent tangent(int rotor, Planar hub_m) const;

    DOWNWASH_EXPORT RayEffect(VerticalRays rays, std::shared_ptr<const FlightModel> model);

 private:
    VerticalRays rays_;
    std::shared_ptr<const FlightModel> model_;  ///< plane, places of the rotors, and curves
};

}  // namespace downwash::judge
