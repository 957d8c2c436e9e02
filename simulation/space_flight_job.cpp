#include "downwash/simulation/space_flight_job.hpp"

#include <cstring>

#include "downwash/simulation/flight_memory.hpp"

namespace downwash {

bool is_same(const AnySpaceState& a, const AnySpaceState& b) noexcept {
    const auto are_same = [](const auto& one, const auto& other) {
        return std::memcmp(&one, &other, sizeof one) == 0;  // nothing but numbers
    };
    using Vehicle = simulation::SpaceVehicle<double, max_joints>;
    using Memory = simulation::SpaceWorldMemory<double, max_joints>;
    if (!are_same(static_cast<const Vehicle&>(a), static_cast<const Vehicle&>(b)) ||
        !are_same(static_cast<const Memory&>(a.world), static_cast<const Memory&>(b.world))) {
        return false;
    }
    const int oldest =
        simulation::recent_ticks + static_cast<int>(std::max(a.world.older.size(), b.world.older.size()));
    for (int age = simulation::recent_ticks + 1; age <= oldest; ++age) {
        if (!are_same(simulation::past_at(a.world, age), simulation::past_at(b.world, age))) {
            return false;
        }
    }
    return true;
}

}  // namespace downwash
