#include "downwash/planner/stop_finder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "downwash/planner/family_parts.hpp"
#include "downwash/problems/problem_model.hpp"

namespace downwash::planning {
namespace {

BrakingPartsOf<Plane>::MapAround everywhere(const std::shared_ptr<const AeroMap>& map) {
    return [map](const Bounds& /*places*/) { return map; };
}
BrakingPartsOf<Space>::MapAround everywhere(const std::shared_ptr<const SurfaceVolumes>& volumes) {
    return [volumes] { return volumes; };
}

WorldFlights flights_of(const Problem& problem, const std::shared_ptr<const FlightModel>& model,
                        const std::shared_ptr<const AeroMap>& map, int threads) {
    return {problem, model, map, threads};
}
SpaceProblemWorlds flights_of(const SpaceProblem& problem, const std::shared_ptr<const SpaceProblemModel>& model,
                              const std::shared_ptr<const SurfaceVolumes>& volumes, int threads) {
    return {problem, {problem.planner.variant, model, volumes}, threads};
}

/// Moves vehicles along a whole plan, a leg for each piece of it; touches are left out.
void advance(WorldFlights& flights, std::vector<FlightJob>& fleet, const Plan& plan) {
    flights.advance(fleet, plan, {});
}
void advance(SpaceProblemWorlds& flights, std::vector<SpaceFlightJob>& fleet, const SpacePlan& plan) {
    flights.advance(fleet, plan);
}

/// The vehicle after so many legs of a job, or where the flight ended before.
template <class Job>
const auto& state_at_leg(const Job& job, std::size_t legs) {
    if (const auto* const rejected = job.rejected_leg()) {
        legs = std::min(legs, static_cast<std::size_t>(rejected - job.legs.data()) + 1);
    }
    return legs == 0 ? job.start : job.legs[legs - 1].end;
}

}  // namespace

template <class Family>
StopFinderOf<Family>::StopFinderOf(const Problem& problem, std::shared_ptr<const FlightModel> model,
                                   std::shared_ptr<const Effects> map, std::vector<FlownWorld> worlds, int threads)
    : problem_(problem),
      model_(model),
      worlds_(std::move(worlds)),
      braking_(problem, model, everywhere(map), worlds_, threads),
      flights_(flights_of(problem, model, map, threads)) {}

template <class Family>
auto StopFinderOf<Family>::moments_of(const Plan& plan, const StopCondition& is_over) -> std::vector<Known> {
    const FlightState nominal = start_state(*model_, problem_.start);
    if (starts_.empty()) {
        starts_ = flights_.starts_in(worlds_);
    }
    std::vector<FlightJob> fleet{job_from(nominal, nominal_world_of(*model_))};
    for (std::size_t i = 0; i < worlds_.size(); ++i) {
        fleet.push_back(job_from(starts_[i].value_or(nominal), &worlds_[i]));
    }
    advance(flights_, fleet, plan);
    throw_if_over(is_over);
    std::vector<Known> all(plan.reference.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (const FlightJob& job : fleet) {
            all[i].moment.fleet.push_back(state_at_leg(job, i));
        }
        all[i].moment.reference = plan.reference[i].point;
        all[i].stop.tick = plan.reference[i].tick;
    }
    return all;
}

template <class Family>
auto StopFinderOf<Family>::known(const Known& asked) const -> const Known* {
    const auto found = std::ranges::find_if(known_, [&](const Known& each) {
        return each.stop.tick == asked.stop.tick && each.moment.reference == asked.moment.reference &&
               std::ranges::equal(each.moment.fleet, asked.moment.fleet,
                                  [](const FlightState& a, const FlightState& b) { return is_same(a, b); });
    });
    return found != known_.end() ? &*found : nullptr;
}

template <class Family>
auto StopFinderOf<Family>::along(const Plan& plan, const StopCondition& is_over) -> SafeStops {
    constexpr double step_s = 0.5;
    const Plan divided = plan.divided(std::max<std::int64_t>(1, std::llround(step_s / plan.tick_s)));
    std::vector<Known> all = moments_of(divided, is_over);
    std::vector<Known*> unknown;
    std::vector<typename Braking::Moment> asked;
    for (Known& each : all) {
        if (const Known* const before = known(each)) {
            each.stop = before->stop;
        } else {
            unknown.push_back(&each);
            asked.push_back(each.moment);
        }
    }
    const auto found = braking_.best_stops(std::move(asked), is_over);
    for (std::size_t i = 0; i < unknown.size(); ++i) {
        if (found[i] && found[i]->failures == 0) {
            unknown[i]->stop.rest = end_of(found[i]->plan);
            unknown[i]->stop.duration_s = found[i]->plan.duration_s();
        }
    }
    known_ = std::move(all);

    SafeStops stops;
    std::int64_t without = 0;
    for (std::size_t i = 0; i < known_.size(); ++i) {
        const auto& stop = known_[i].stop;
        stops.moments.push_back(stop);
        if (!stop.rest && i + 1 < known_.size()) {
            without += known_[i + 1].stop.tick - stop.tick;
        }
    }
    if (const std::int64_t ticks = divided.reference.back().tick; ticks > 0) {
        stops.share_without = static_cast<double>(without) / static_cast<double>(ticks);
    }
    return stops;
}

template class StopFinderOf<Plane>;
template class StopFinderOf<Space>;

}  // namespace downwash::planning
