#pragma once

// Private to simulation/.

#include <cstddef>
#include <vector>

#include "downwash/base/vector3.hpp"
#include "downwash/dynamics/lane_vector.hpp"
#include "downwash/effects/rotor_layout.hpp"
#include "downwash/simulation/space_robot.hpp"

namespace downwash::simulation {

/// Where the rotors of a vehicle in space are as seen from each other, in its frame [m].
struct SpaceRotorPlaces {
    explicit SpaceRotorPlaces(const SpaceRobot& robot);

    /// Of a rotor of the level vehicle that heads along x.
    [[nodiscard]] RotorNeighbours neighbours(std::size_t rotor) const;

    std::vector<Vector3> hubs_m;                      ///< from the multirotor's centre of mass
    std::vector<std::vector<std::size_t>> neighbour;  ///< the others of each rotor, in the order of neighbours()
    std::vector<std::vector<Vector3>> neighbours_m;   ///< from each hub to those
    std::vector<Vector3> from_center_m;               ///< of each hub from the centre between them
    double reach_m = 0;                               ///< level distance from that centre to the farthest hub
    double radius_m;                                  ///< R
};

/// Places at an attitude. @param from_m where they are relative to   @param[out] at_m as many as offsets
void place_at(const dynamics::LaneVector<double>& from_m, const dynamics::LaneRotation<double>& attitude,
              const std::vector<Vector3>& offsets_m, std::vector<Vector3>& at_m);

/// The attitude of a level vehicle that heads along x.
inline constexpr dynamics::LaneRotation<double> level_attitude{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

}  // namespace downwash::simulation
