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
      direct_(std::make_shared<const DirectEffect>(scene, aero, robot.rotors.radius_m)),
      lateral_offsets_m_(lateral_offsets_m(robot.rotors)) {
    for (std::size_t i = 0; i < robot.rotors.positions_m.size(); ++i) {
        rotor_lateral_m_[i] = robot.rotors.positions_m[i][1];
        const auto layer = std::find(lateral_offsets_m_.begin(), lateral_offsets_m_.end(), rotor_lateral_m_[i]);
        rotor_layer_[i] = static_cast<std::size_t>(layer - lateral_offsets_m_.begin());
    }
}

std::shared_ptr<const AeroMap> FlightModel::make_map(const Bounds& bounds, int threads) const {
    return std::make_shared<const AeroMap>(direct_, plane_, rotor_extent(robot_.rotors, bounds), lateral_offsets_m_,
                                           threads);
}

MapExtent rotor_extent(const RotorParameters& rotors, const Bounds& bounds) {
    double reach_m = 0;
    for (const Vector3& hub_m : rotors.positions_m) {
        reach_m = std::max(reach_m, std::sqrt(hub_m[0] * hub_m[0] + hub_m[2] * hub_m[2]));
    }
    return {bounds.x_low_m - reach_m, bounds.x_high_m + reach_m, bounds.z_low_m - reach_m, bounds.z_high_m + reach_m};
}

std::vector<double> lateral_offsets_m(const RotorParameters& rotors) {
    std::vector<double> offsets_m;
    for (const Vector3& hub_m : rotors.positions_m) {
        if (std::find(offsets_m.begin(), offsets_m.end(), hub_m[1]) == offsets_m.end()) {
            offsets_m.push_back(hub_m[1]);
        }
    }
    return offsets_m;
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
