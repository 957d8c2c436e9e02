#pragma once

#include "downwash/base/export.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash {

/// The effect of surfaces on the whole vehicle at one pose. The rotor commands are those that carry its weight without
/// a pitch torque in free air (equal ones, for rotors placed symmetrically). Forces act along b3, torques about +y
/// (positive: nose down).
struct VehicleEffect {
    double force_factor = 1;         ///< sum K_i T_i / sum T_i
    double pitch_torque_nm = 0;      ///< parasitic, -sum x_i K_i T_i (thesis 3.2, figures 3.1 and 3.2)
    double pitch_torque_factor = 0;  ///< the same over weight * R
};

/// The effect at a pose (the arm does not matter), evaluated directly. It is defined everywhere, but means nothing
/// where the vehicle is not flyable.
[[nodiscard]] DOWNWASH_EXPORT VehicleEffect vehicle_effect(const FlightModel& model, const PlanarPose& pose);

/// Whether every rotor of a vehicle at this pose is inside the flyable area (docs/model.md 4.4), decided exactly. Like
/// the effect itself, the area is that of the plane: how far the vehicle is beside it does not count.
[[nodiscard]] DOWNWASH_EXPORT bool is_flyable(const FlightModel& model, const PlanarPose& pose);
/// Whether a map has every rotor of a vehicle at this pose inside its flyable area.
[[nodiscard]] DOWNWASH_EXPORT bool is_flyable(const FlightModel& model, const AeroMap& map, const PlanarPose& pose);

}  // namespace downwash
