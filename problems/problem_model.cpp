#include "downwash/problems/problem_model.hpp"

#include <algorithm>

namespace downwash {

std::shared_ptr<const FlightModel> make_flight_model(const Problem& problem) {
    return std::make_shared<const FlightModel>(problem.robot, problem.plane,
                                               std::make_shared<const Scene>(problem.obstacles), problem.aero,
                                               problem.planner.collision_checker);
}

FlightState start_state(const FlightModel& model, const Start& start) {
    const double u[4] = {start.velocity[plane::x], start.velocity[plane::z], start.pitch_rate_rad_s,
                         start.velocity[plane::arm]};
    FlightState state = model.state_at(start.pose(), u);
    std::copy(start.rotor_thrust_n.begin(), start.rotor_thrust_n.end(), state.plant.thrust_n);
    std::copy(start.controller_memory.begin(), start.controller_memory.end(), state.memory.number);
    return state;
}

Start start_of(const FlightModel& model, const FlightState& state, const ReferencePoint& reference) {
    const double(&q)[4] = state.plant.q;
    const double(&u)[4] = state.plant.u;
    Start start{configuration_of(q), q[2], {u[0], u[1], u[3]}, u[2], reference, {}, {}};
    const PlantModel& plant = model.tick().plant;
    start.rotor_thrust_n.assign(state.plant.thrust_n, state.plant.thrust_n + plant.rotor_count);
    const int numbers = controllers::memory_size(model.tick().law);
    start.controller_memory.assign(state.memory.number, state.memory.number + numbers);
    return start;
}

}  // namespace downwash
