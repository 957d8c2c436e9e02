#pragma once

#include "downwash/controllers/control_law.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "downwash/dynamics/slipstreams.hpp"
#include "downwash/effects/sided_factor.hpp"

namespace downwash::simulation {

/// Everything about the vehicle that does not change in flight.
struct TickModel {
    PlantModel plant;  ///< nominal plant: the controller knows it, and it flies in the nominal world
    FlownLaw law;
    double tick_s;  ///< control period, 1 / rate_hz
    TiltLoss tilt_loss = {};
    Slipstreams slipstreams = {};  ///< on the arm, in the nominal world and in others
};

}  // namespace downwash::simulation
