#include "downwash/simulation/flight_kernel_body.hpp"

namespace downwash::simulation {

void fly_lanes_baseline(const FlightKernelModel& model, FlightLanes& lanes, int most_ticks) {
    fly_lanes(model, lanes, most_ticks);
}

}  // namespace downwash::simulation
