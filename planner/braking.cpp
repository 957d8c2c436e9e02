#include "downwash/planner/braking.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "downwash/controllers/space_duration.hpp"
#include "downwash/planner/family_parts.hpp"

namespace downwash::planning {

template <class Family>
BrakingOf<Family>::BrakingOf(const Problem& problem, std::shared_ptr<const FlightModel> model, MapAround map_around,
                             std::vector<FlownWorld> worlds, int threads)
    : problem_(problem),
      model_(std::move(model)),
      worlds_(std::move(worlds)),
      parts_(problem, *model_, std::move(map_around), threads) {}

template <class Family>
auto BrakingOf<Family>::world(std::size_t number) const -> const FlownWorld* {
    return number == 0 ? nominal_world_of(*model_) : &worlds_[number - 1];
}

template <class Family>
auto BrakingOf<Family>::moment_of(const ReferencePoint& reference, const FlightState& vehicle) const -> Moment {
    Moment moment{reference, {}};
    for (std::size_t i = 0; i <= worlds_.size(); ++i) {
        moment.fleet.push_back(begun_in(vehicle, world(i)));
    }
    return moment;
}

template <class Family>
void BrakingOf<Family>::add_places(std::span<const Try> tries, const Moment& from,
                                   std::vector<Configuration>& places) const {
    places.push_back(parts_.place_of(from.fleet.front()));
    for (const Try& each : tries) {
        places.push_back(end_of(each.plan));
    }
}

template <class Family>
auto BrakingOf<Family>::all_tries(Moment moment) const -> Tries {
    const ReferencePoint from = moment.reference;
    const double margin_m = parts_.kept_margin_m(moment.fleet.front());
    Tries tries{std::move(moment), margin_m, {}};
    for (const Maneuver& maneuver : Parts::maneuvers()) {
        const auto limits = parts_.limits_of(maneuver);
        const Configuration rest = parts_.rest_of(from, limits, maneuver);
        if (parts_.is_inside(rest)) {
            Plan plan = blank_plan_of(*model_);
            plan.reference.push_back({0, from});
            plan.reference.push_back({shortest_ticks(from, at_rest(rest), limits, plan.tick_s), at_rest(rest)});
            tries.all.push_back({std::move(plan), parts_.hover_at(rest)});
        }
    }
    leave_out_near_rests(tries);
    return tries;
}

/// Ways to places without the margin, unless all are.
template <class Family>
void BrakingOf<Family>::leave_out_near_rests(Tries& tries) const {
    const auto is_near = [&](const Try& each) { return parts_.is_nearer_than(end_of(each.plan), tries.margin_m); };
    if (!std::ranges::all_of(tries.all, is_near)) {
        std::erase_if(tries.all, is_near);
    }
}

template <class Family>
bool BrakingOf<Family>::Tries::has_safe() const {
    return std::ranges::any_of(std::span(all).first(flown), [](const Try& each) { return each.failures == 0; });
}

template <class Family>
auto BrakingOf<Family>::next(Tries& tries, std::size_t count, std::size_t first_world) const -> Batch {
    const std::size_t first = tries.flown;
    tries.flown += std::min(count, tries.all.size() - first);
    return {&tries, std::span(tries.all).subspan(first, tries.flown - first), first_world, worlds_.size() + 1};
}

template <class Family>
auto BrakingOf<Family>::best_stop(Moment moment) -> std::optional<Stop> {
    std::vector<Moment> moments;
    moments.push_back(std::move(moment));
    return std::move(best_stops(std::move(moments)).front());
}

/// Mostly the first way is safe, else one of the next two, for which a small map is enough.
template <class Family>
auto BrakingOf<Family>::best_stops(std::vector<Moment> moments, const StopCondition& is_over)
    -> std::vector<std::optional<Stop>> {
    std::vector<Tries> tries;
    tries.reserve(moments.size());
    for (Moment& moment : moments) {
        tries.push_back(all_tries(std::move(moment)));
    }
    for (const std::size_t count : {1U, 2U}) {
        throw_if_over(is_over);
        std::vector<Batch> batches;
        std::vector<Configuration> places;
        for (Tries& each : tries) {
            if (each.is_open()) {
                const std::size_t first_tries = std::min<std::size_t>(3, each.all.size());
                add_places(std::span(each.all).first(first_tries), each.moment, places);
                batches.push_back(next(each, count, 0));
            }
        }
        if (!batches.empty()) {
            parts_.fly_around(places);
            fly(batches);
        }
    }
    std::vector<std::optional<Stop>> stops;
    for (Tries& each : tries) {
        throw_if_over(is_over);
        if (each.is_open()) {
            try_the_others(each);
        }
        const auto end = each.all.begin() + static_cast<std::ptrdiff_t>(each.flown);
        const auto best =
            std::min_element(each.all.begin(), end, [](const Try& a, const Try& b) { return a.failures < b.failures; });
        stops.push_back(each.all.empty() ? std::nullopt : std::optional(Stop{std::move(best->plan), best->failures}));
    }
    return stops;
}

/// They are flown in the nominal world, and those that are safe there in the worlds, until one is safe in all.
template <class Family>
void BrakingOf<Family>::try_the_others(Tries& tries) {
    const std::span others = std::span(tries.all).subspan(tries.flown);
    std::vector<Configuration> places;
    add_places(others, tries.moment, places);
    parts_.fly_around(places);
    fly(std::array{Batch{&tries, others, 0, 1}});
    std::stable_partition(others.begin(), others.end(), [](const Try& each) { return each.failures == 0; });
    while (tries.is_open()) {
        fly(std::array{next(tries, 2, 1)});
    }
}

template <class Family>
void BrakingOf<Family>::fly(std::span<const Batch> batches) {
    constexpr double no_margin = -1;
    struct Flown {
        Try* of;
        bool is_nominal;
        double margin_m;
    };
    std::vector<FlightJob> jobs;
    std::vector<Flown> flown;
    for (const Batch& batch : batches) {
        for (Try& each : batch.tries) {
            std::vector<FlightLeg> legs;
            for (const auto& segment : parts_.with_hover(each.plan, each.hover).segments()) {
                legs.push_back({segment});
            }
            for (std::size_t i = batch.first_world; i < batch.last_world; ++i) {
                FlightJob& job = jobs.emplace_back(job_from(batch.of->moment.fleet[i], world(i)));
                job.legs = legs;
                parts_.judge(job, each.hover, i == 0 ? batch.of->margin_m : no_margin);
                flown.push_back({&each, i == 0, batch.of->margin_m});
            }
        }
    }
    parts_.fly(jobs);
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        flown[i].of->failures += Parts::fails(jobs[i], flown[i].is_nominal, flown[i].margin_m) ? 1 : 0;
    }
}

template class BrakingOf<Plane>;
template class BrakingOf<Space>;

}  // namespace downwash::planning
