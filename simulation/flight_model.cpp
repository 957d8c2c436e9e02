#include "downwash/simulation/flight_model.hpp"

#include <algorithm>
#include <cmath>

namespace downwash {

FlightModel::FlightModel(const Robot& robot, const PlaneOfMotion& plane, std::shared_ptr<const Scene> scene,
                         const AeroSettings& aero)
    : robot_(robot),
      plane_(plane),
      tick_{make_plant_model(robot.multirotor, robot.arm, robot.rotors), robot.controller,
            1 / robot.controller.rate_hz},
      collisions_(scene, plane, robot.shape()),
      direct_(std::make_shared<const DirectEffect>(scene, aero, robot.rotors.radius_m)) {
    for (std::size_t i = 0; i < robot.rotors.positions_m.size(); ++i) {
        const double lateral_m = robot.rotors.positions_m[i][1];
        rotor_lateral_m_[i] = lateral_m;
        const auto known = std::find(lateral_offsets_m_.begin(), lateral_offsets_m_.end(), lateral_m);
        rotor_layer_[i] = static_cast<std::size_t>(known - lateral_offsets_m_.begin());
        if (known == lateral_offsets_m_.end()) {
            lateral_offsets_m_.push_back(lateral_m);
        }
    }
}

std::shared_ptr<const AeroMap> FlightModel::make_map(const Bounds& bounds, int threads) const {
    double reach_m = 0;
    for (const Vector3& hub_m : robot_.rotors.positions_m) {
        reach_m = std::max(reach_m, std::sqrt(hub_m[0] * hub_m[0] + hub_m[2] * hub_m[2]));
    }
    const MapExtent extent{bounds.x_low_m - reach_m, bounds.x_high_m + reach_m, bounds.z_low_m - reach_m,
                           bounds.z_high_m + reach_m};
    return std::make_shared<const AeroMap>(direct_, plane_, extent, lateral_offsets_m_, threads);
}

FlightState FlightModel::state_at(const double q[4], const double u[4]) const noexcept {
    FlightState state{};
    std::copy(q, q + 4, state.plant.q);
    std::copy(u, u + 4, state.plant.u);
    state.controller = controllers::rested_controller(q[2]);
    // Rotors that lag begin with the thrust that carries the weight.
    const PlantModel& plant = tick_.plant;
    for (int i = 0; i < plant.rotor_count; ++i) {
        state.plant.thrust_n[i] = plant.force_share[i] * plant.total_mass_kg * standard_gravity_m_s2;
    }
    return state;
}

}  // namespace downwash
