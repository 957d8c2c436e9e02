#include "downwash/search/line_flights.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "downwash/search/free_air_cost.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash::planning {

FlightState following(const FlightModel& model, const ReferencePoint& reference, double energy_j) {
    const double u[4] = {reference.velocity[plane::x], reference.velocity[plane::z], 0, reference.velocity[plane::arm]};
    FlightState state = model.state_at(level_at(configuration_of(reference)), u);
    state.plant.energy_j = energy_j;
    return state;
}

AnySpaceState following(const SpaceProblemModel& model, const SpacePoint& reference, double energy_j) {
    SpaceStart start;
    std::copy_n(reference.position, 3, start.position_m.begin());
    std::copy_n(reference.velocity, 3, start.velocity_m_s.begin());
    start.yaw_rad = reference.position[space::yaw];
    start.body_rates_rad_s[2] = reference.velocity[space::yaw];
    const auto joints = static_cast<std::size_t>(model.problem().robot.joints());
    start.joints_rad.assign(reference.position + space::first_joint, reference.position + space::first_joint + joints);
    start.joint_rates_rad_s.assign(reference.velocity + space::first_joint,
                                   reference.velocity + space::first_joint + joints);
    AnySpaceState state = start_state(model, start);
    state.plant.energy_j = energy_j;
    return state;
}

template <class Family>
LineFlightsOf<Family>::LineFlightsOf(const SearchTask& task, FlightRules rules)
    : task_(task), rules_(std::move(rules)), hover_power_w_(hover_power_w(task.model)) {}

template <class Family>
auto LineFlightsOf<Family>::flown(const ReferenceSegment& segment, FlightState& vehicle, std::uint64_t& checked) const
    -> SegmentFlight {
    // So densely that the margin covers what happens between two poses.
    const double spacing_m = std::min(max_unseen_motion_m(rules_.margin_m), 0.1);
    const SearchSpace& space = task_.space;
    const double tick_s = task_.tick_s;
    const std::int64_t samples = std::min(samples_along(segment, task_.space, spacing_m), segment.ticks());
    SegmentFlight flight;
    Configuration before = configuration_of(segment.from());
    for (std::int64_t i = 1; i <= samples; ++i) {
        const std::int64_t ticks = segment.ticks() * i / samples;
        const ReferencePoint reference = segment.at_tick(ticks);
        const Configuration at = configuration_of(reference);
        flight.rejection = space.rejection_at(at);
        ++checked;
        const double piece_s = static_cast<double>(ticks - flight.ticks) * tick_s;
        flight.ticks = ticks;
        flight.length_m += space.length_m(before, at);
        if (flight.rejection == Rejection::none && rules_.measures_clearance) {
            const double clearance_m = task_.model.collisions().clearance_m(level_at(at));
            flight.clearance_integral += piece_s * clearance_density(clearance_m);
        }
        before = at;
        if (flight.rejection != Rejection::none || i == samples) {
            const double flown_s = static_cast<double>(ticks) * tick_s;
            vehicle = following(task_.model, reference, vehicle.plant.energy_j + hover_power_w_ * flown_s);
            break;
        }
    }
    return flight;
}

template <class Family>
std::uint64_t LineFlightsOf<Family>::fly(std::span<FlightJob> jobs) {
    std::uint64_t checked = 0;
    for (FlightJob& job : jobs) {
        const bool is_over = rules_.is_over && rules_.is_over();
        FlightState vehicle = job.start;
        for (FlightLeg& leg : job.legs) {
            if (is_over) {
                leg.flight.rejection = Rejection::interrupted;
                break;
            }
            leg.flight = flown(leg.segment, vehicle, checked);
            leg.end = vehicle;
            if (leg.flight.rejection != Rejection::none) {
                break;
            }
        }
        if (job.judged_ticks > 0 && job.rejection() == Rejection::none && !task_.space.is_met(vehicle)) {
            job.legs.back().flight.rejection = Rejection::goal_missed;
        }
    }
    return checked;
}

template <class Family>
void LineFlightsOf<Family>::fly(std::span<FlightChain* const> chains) {
    for (FlightChain* chain : chains) {
        while (FlightJob* job = chain->next()) {
            fly(std::span(job, 1));
        }
    }
}

template <class Family>
auto LineFlightsOf<Family>::fly_again(const ReferenceSegment& segment, FlightState& vehicle, const FlightWorld&) const
    -> SegmentFlight {
    std::uint64_t checked = 0;
    return flown(segment, vehicle, checked);
}

template class LineFlightsOf<Plane>;
template class LineFlightsOf<Space>;

}  // namespace downwash::planning
