#include "downwash/simulation/vehicle_state.hpp"

#include <algorithm>
#include <cstring>

namespace downwash {

bool is_same(const FlightState& a, const FlightState& b) noexcept {
    // Without the older motions a state is numbers only.
    if (std::memcmp(&a, &b, sizeof(double) * simulation::state_numbers) != 0) {
        return false;
    }
    const int oldest =
        simulation::recent_ticks + static_cast<int>(std::max(a.world.older.size(), b.world.older.size()));
    for (int age = simulation::recent_ticks + 1; age <= oldest; ++age) {
        if (std::memcmp(&simulation::past_at(a.world, age), &simulation::past_at(b.world, age),
                        sizeof(simulation::PastMotion<double>)) != 0) {
            return false;
        }
    }
    return true;
}

}  // namespace downwash
