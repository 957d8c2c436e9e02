#include "downwash/simulation/flight_loop.hpp"

#include <utility>

#include "downwash/dynamics/contact_step.hpp"
#include "downwash/simulation/closed_loop.hpp"
#include "downwash/simulation/noise.hpp"

namespace downwash::simulation {
namespace {

/// The chosen step, as what a tick integrates with.
struct ChosenStep {
    const Integration& choice;

    template <class Around>
    dynamics::PlantState<double> operator()(const PlantModel& model, const dynamics::PlantState<double>& state,
                                            const dynamics::Motion<double>& motion,
                                            const dynamics::PlantCommand<double>& command, double dt_s,
                                            const Around& around) const {
        return std::visit([&](const auto& step) { return step(model, state, motion, command, dt_s, around); }, choice);
    }
};

/// One step in the nominal world: what flies through maps and without effects, thousands of ticks at a time.
template <class Law>
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
[[gnu::flatten]]  // in one piece it takes a fifth less
#endif
VehicleState<double>
plain_tick(const TickModel& model, const Law& law, const VehicleState<double>& state, const ReferencePoint& reference,
           FlightEffect& effect, controllers::Actuation<double>& given) {
    const auto motion = dynamics::motion_at(model.plant, state.plant.q, state.plant.u);
    return simulation::tick(model, law, state, motion, reference, effect, given);
}

}  // namespace

void FlightLoop::tick_with(const double* noise, const FlightState& state, const ReferencePoint& reference,
                           controllers::Actuation<double>& given, const Integration& integration,
                           FlightState& next) const {
    const ChosenStep step{integration};
    controllers::visit_flown(model_.law, [&](const auto& law) {
        if (world_ != nullptr) {
            tick_in_world(model_, law, world_->numbers, noise, state, reference, effect_, given, next, step);
            return;
        }
        const VehicleState<double>& vehicle = state;
        VehicleState<double>& next_vehicle = next;
        if (std::holds_alternative<dynamics::OneStep>(integration)) {
            next_vehicle = plain_tick(model_, law, vehicle, reference, effect_, given);
        } else {
            const auto motion = dynamics::motion_at(model_.plant, state.plant.q, state.plant.u);
            next_vehicle = simulation::tick(model_, law, vehicle, motion, reference, effect_, given, step);
        }
        next.world = state.world;
    });
}

void FlightLoop::noisy_tick(std::int64_t number, const FlightState& state, const ReferencePoint& reference,
                            controllers::Actuation<double>& given, const Integration& integration,
                            FlightState& next) const {
    double noise[noise_count] = {};
    if (world_ != nullptr && world_->has_noise) {
        draw_noise(normal_levels(), world_->world.tape, number, noise, 1);
    }
    tick_with(noise, state, reference, given, integration, next);
}

FlightState FlightLoop::tick(std::int64_t number, const FlightState& state, const ReferencePoint& reference,
                             controllers::Actuation<double>& given, const Integration& integration) const {
    FlightState next;
    noisy_tick(number, state, reference, given, integration, next);
    return next;
}

FlightState FlightLoop::quiet_tick(const FlightState& state, const ReferencePoint& reference,
                                   controllers::Actuation<double>& given, const Integration& integration) const {
    const double noise[noise_count] = {};
    FlightState next;
    tick_with(noise, state, reference, given, integration, next);
    return next;
}

Rejection FlightLoop::fly(std::int64_t first_tick, const ReferenceSegment& segment, FlightState& state,
                          const AfterTick& after, const Integration& integration) const {
    ReferencePoint reference = segment.from();
    Rejection rejection = Rejection::none;
    FlightState other{};
    FlightState* now = &state;
    FlightState* next = &other;
    for (std::int64_t t = 0; t < segment.ticks() && rejection == Rejection::none; ++t) {
        controllers::Actuation<double> given{};
        noisy_tick(first_tick + t, *now, reference, given, integration, *next);
        const ReferencePoint next_reference = segment.at_tick(t + 1);
        rejection = after(*now, reference, given, *next, next_reference);
        std::swap(now, next);
        reference = next_reference;
    }
    if (now != &state) {
        state = std::move(other);
    }
    return rejection;
}

}  // namespace downwash::simulation
