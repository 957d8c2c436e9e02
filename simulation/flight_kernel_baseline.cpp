#include "downwash/simulation/flight_kernel_body.hpp"

namespace downwash::simulation {

FlightKernel baseline_kernel(std::size_t law) {
    return kernel_of(law);
}

}  // namespace downwash::simulation
