// Compiled for AVX-512, and called only where the processor has it.

#include "downwash/simulation/flight_kernel_body.hpp"

namespace downwash::simulation {

void fly_lanes_avx512(const FlightKernelModel& model, FlightLanes& lanes, int most_ticks) {
    fly_lanes(model, lanes, most_ticks);
}

}  // namespace downwash::simulation
