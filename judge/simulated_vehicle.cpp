#include "downwash/judge/simulated_vehicle.hpp"

#include "downwash/judge/flown_vehicle.hpp"
#include "downwash/judge/goals.hpp"

namespace downwash::judge {

struct SimulatedVehicle::Parts {
    Setting setting;
    FlownVehicle vehicle;
    bool goes_on;
    std::int64_t tick = 0;

    Parts(const Problem& problem, const FlightConditions& conditions)
        : setting(problem), vehicle(setting, conditions), goes_on(vehicle.has_begun()) {
        goes_on = vehicle.umpire().sees(vehicle.loop(), at_rest(problem.start.at)) && goes_on;
    }
};

SimulatedVehicle::SimulatedVehicle(const Problem& problem, const FlightConditions& conditions)
    : parts_(std::make_unique<Parts>(problem, conditions)) {}
SimulatedVehicle::~SimulatedVehicle() = default;

bool SimulatedVehicle::follow(const ReferencePoint& now, const ReferencePoint& next) {
    if (parts_->goes_on) {
        parts_->vehicle.loop().next(parts_->tick++, now);
        parts_->goes_on = parts_->vehicle.umpire().sees(parts_->vehicle.loop(), next);
    }
    return parts_->goes_on;
}

SensorReadings SimulatedVehicle::readings() const {
    const Loop& loop = parts_->vehicle.loop();
    const Motion seen = loop.seen(parts_->tick);
    const auto& thrust_n = loop.state().thrust_n;
    return {{seen.position_m.x, seen.position_m.z, seen.pitch_rad, seen.arm_rad},
            seen.velocity_m_s.x,
            seen.velocity_m_s.z,
            seen.pitch_rate_rad_s,
            seen.arm_rate_rad_s,
            {thrust_n.begin(), thrust_n.begin() + loop.plant().vehicle().rotor_count}};
}

const JudgedFlight& SimulatedVehicle::flight() const noexcept {
    return parts_->vehicle.flight();
}

double SimulatedVehicle::used_share(const Goal& goal, const PlanarPose& pose) const {
    return goal_distance(goal, parts_->setting.problem.robot.arm, pose).used_share;
}

}  // namespace downwash::judge
