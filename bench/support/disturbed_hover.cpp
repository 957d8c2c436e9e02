#include "disturbed_hover.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/simulation/direct_field.hpp"
#include "downwash/simulation/flight_loop.hpp"

namespace downwash::bench {
namespace {

double distance(const FlightState& a, const FlightState& b) {
    double most = 0;
    for (int i = 0; i < 4; ++i) {
        most = std::max(most, std::abs(a.plant.q[i] - b.plant.q[i]));
    }
    return most;
}

}  // namespace

DisturbedHover fly_disturbed(const FlightModel& model, const HoverTrim& trim, const Disturbance& disturbance,
                             test::Random& random) {
    FlightState state = trim.state;
    for (int i = 0; i < 4; ++i) {
        state.plant.q[i] += random.uniform(-disturbance.size, disturbance.size);
        state.plant.u[i] += random.uniform(-disturbance.size, disturbance.size);
    }
    const int ticks = static_cast<int>(disturbed_flight_s * model.robot().controller.rate_hz);
    double before = 0;
    double in_the_end = 0;
    double d = 0;
    simulation::FlightEffectOf effect{simulation::DirectField(model)};
    const simulation::FlightLoop loop(model.tick(), flown_world(model, nullptr), effect);
    for (int i = 0; i < ticks; ++i) {
        controllers::Actuation<double> given{};
        state = loop.quiet_tick(state, trim.reference, given);
        d = distance(state, trim.state);
        if (!(d < disturbance.leaving)) {
            return {true, d};
        }
        if (4 * i >= 3 * ticks) {
            in_the_end = std::max(in_the_end, d);
        } else if (4 * i >= 2 * ticks) {
            before = std::max(before, d);
        }
    }
    constexpr double as_far = 0.99;
    const bool is_in_limit_cycle = in_the_end > disturbance.size && in_the_end > as_far * before;
    return {is_in_limit_cycle || (in_the_end > before && in_the_end > 1e-9), d};
}

}  // namespace downwash::bench
