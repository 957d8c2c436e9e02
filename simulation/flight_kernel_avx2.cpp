// Compiled for AVX2, and called only where the processor has it.

#include "downwash/simulation/flight_kernel_body.hpp"

namespace downwash::simulation {

FlightKernel avx2_kernel(std::size_t law) {
    return kernel_of(law);
}

}  // namespace downwash::simulation
