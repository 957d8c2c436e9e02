#pragma once

#include <cstddef>
#include <vector>

#include "downwash/dynamics/plant.hpp"
#include "downwash/identification/logged_flight.hpp"
#include "downwash/identification/surface_nodes.hpp"
#include "downwash/simulation/space_robot.hpp"

// Private to identification/.

namespace downwash::identification {

/// How much K of each distance counts for each rotor, tick by tick. Between two distances z it is linear in (R/z)^2,
/// to which K - 1 of a rotor far from a surface is proportional (Cheeseman and Bennett 1955).
class SurfaceWeights {
 public:
    SurfaceWeights(const SpaceRobot& robot, const LoggedFlight& flight, const SurfaceNodes& surface);

    /// K of each rotor at a tick. @param effects K - 1 of each distance
    void find_ratios(const std::vector<double>& effects, std::size_t tick, double ratio[max_rotors]) const;

 private:
    void add(double z_over_r, double* weights) const;

    SurfaceNodes surface_;
    std::size_t rotors_;
    std::vector<double> weights_;  ///< tick by tick, rotor by rotor; empty: free air
};

}  // namespace downwash::identification
