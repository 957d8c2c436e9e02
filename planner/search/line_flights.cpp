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

std::int64_t samples_along(const ReferenceSegment& segment, const SearchTask& task, double spacing_m) {
    const ReferencePoint& a = segment.from();
    const ReferencePoint& b = segment.to();
    const double arm_m = task.problem.robot.arm.length_m;
    const auto weighted = [arm_m, axes = task.space.axes()](const double* v) {
        double sum_m = 0;
        for (std::size_t axis = 0; axis < axes.size(); ++axis) {
            sum_m += (axes[axis].group == AxisGroup::translation ? 1 : arm_m) * std::abs(v[axis]);
        }
        return sum_m;
    };
    double step[max_axes];
    std::transform(b.position, b.position + max_axes, a.position, step, std::minus{});
    // Ends that move may lead beyond the line between them.
    const double motion_m = weighted(step) + (weighted(a.velocity) + weighted(b.velocity)) * segment.duration_s();
    return static_cast<std::int64_t>(std::ceil(motion_m / spacing_m)) + 1;
}

LineFlights::LineFlights(const SearchTask& task, FlightRules rules)
    : task_(task), rules_(std::move(rules)), hover_power_w_(hover_power_w(task.model)) {}

SegmentFlight LineFlights::flown(const ReferenceSegment& segment, FlightState& vehicle, std::uint64_t& checked) const {
    // So densely that the margin covers what happens between two poses.
    const double spacing_m = std::min(max_unseen_motion_m(rules_.margin_m), 0.1);
    const SearchSpace& space = task_.space;
    const double tick_s = task_.model.tick().tick_s;
    const std::int64_t samples = std::min(samples_along(segment, task_, spacing_m), segment.ticks());
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
        flight.length_m += space.distance_m(before, at);
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

std::uint64_t LineFlights::fly(std::span<FlightJob> jobs) {
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
        const Goal& goal = job.goal != nullptr ? *job.goal : task_.problem.goal;
        if (job.judged_ticks > 0 && job.rejection() == Rejection::none &&
            !meets_goal(goal, task_.model.tick().plant, vehicle)) {
            job.legs.back().flight.rejection = Rejection::goal_missed;
        }
    }
    return checked;
}

void LineFlights::fly(std::span<FlightChain* const> chains) {
    for (FlightChain* chain : chains) {
        while (FlightJob* job = chain->next()) {
            fly(std::span(job, 1));
        }
    }
}

SegmentFlight LineFlights::fly_again(const ReferenceSegment& segment, FlightState& vehicle, const FlightWorld&) const {
    std::uint64_t checked = 0;
    return flown(segment, vehicle, checked);
}

}  // namespace downwash::planning
