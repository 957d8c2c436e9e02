#include "downwash/problems/problem_model.hpp"

namespace downwash {

std::shared_ptr<const FlightModel> make_flight_model(const Problem& problem) {
    return std::make_shared<const FlightModel>(problem.robot, problem.plane,
                                               std::make_shared<const Scene>(problem.obstacles), problem.aero);
}

FlightState start_state(const FlightModel& model, const Start& start) {
    const double u[4] = {start.vx_m_s, start.vz_m_s, start.pitch_rate_rad_s, start.arm_rate_rad_s};
    return model.state_at({start.x_m, start.z_m, start.pitch_rad, start.arm_rad}, u);
}

}  // namespace downwash
