#include "downwash/planner/leg_estimates.hpp"

#include <algorithm>
#include <iterator>
#include <numbers>
#include <utility>

#include "downwash/search/ways_around.hpp"

namespace downwash::planning {
namespace {

template <class AnyProblem>
AnyProblem for_energy(AnyProblem problem) {
    problem.planner.objective = Objective::energy;
    return problem;
}

/// The model has them.
template <class AnyProblem>
AnyProblem without_obstacles(AnyProblem problem) {
    problem.obstacles.clear();
    return problem;
}

Vector3 position_m(const SpaceConfiguration& at) {
    return {at[0], at[1], at[2]};
}

/// Some configurations that meet a goal and are free; the same for every seed.
std::vector<SpaceConfiguration> places_at_goal(const SpaceSearchSpace& space, std::size_t number, std::size_t samples) {
    std::vector<SpaceConfiguration> places;
    Random random(number);
    for (std::size_t i = 0; i < samples; ++i) {
        if (const std::optional<SpaceConfiguration> at = space.sample_goal(random)) {
            places.push_back(*at);
        }
    }
    return places;
}

/// The level vehicle at a corner: turned, and its arm, as on the straight way between two configurations or, where
/// this is not free, the arm as at the start.
SpaceConfiguration at_corner(const SpaceConfiguration& between, const Vector3& corner_m,
                             const SpaceConfiguration& start, const SpaceSearchSpace& space) {
    SpaceConfiguration at = between;
    std::ranges::copy(corner_m, at.begin());
    if (space.is_valid(at)) {
        return at;
    }
    std::copy(start.begin() + space::first_joint, start.end(), at.begin() + space::first_joint);
    constexpr int headings = 8;
    for (int i = 0; i < headings && !space.is_valid(at); ++i) {
        at[space::yaw] += 2 * std::numbers::pi / headings;
    }
    return at;
}

/// The cheapest leg over some corners, from one of some configurations to one of others.
ExpectedLegOf<Space> cheapest_leg(std::span<const SpaceConfiguration> begins, std::span<const SpaceConfiguration> ends,
                                  const std::vector<Vector3>& corners_m, const SpaceConfiguration& start,
                                  const LegBoundsOf<Space>& bounds) {
    ExpectedLegOf<Space> cheapest;
    for (const SpaceConfiguration& begin : begins) {
        for (const SpaceConfiguration& sample : ends) {
            const SpaceConfiguration end = bounds.space().seen_from(begin, sample);
            std::vector<SpaceConfiguration> chain{begin};
            for (std::size_t i = 0; i < corners_m.size(); ++i) {
                const double share = static_cast<double>(i + 1) / static_cast<double>(corners_m.size() + 1);
                chain.push_back(at_corner(between(begin, end, share), corners_m[i], start, bounds.space()));
            }
            chain.push_back(end);
            const LegCost cost = bounds.along(chain, bounds.space().hold_s(end));
            if (cost.cost < cheapest.cost.cost) {
                cheapest = {cost, {chain.begin() + 1, chain.end()}};
            }
        }
    }
    return cheapest;
}

}  // namespace

template <class Family>
LegBoundsOf<Family>::LegBoundsOf(const Problem& problem, const Goal& goal, const FlightModel& model)
    : LegBoundsOf(without_obstacles(part_of(problem, goal, {})), model) {}

template <class Family>
LegBoundsOf<Family>::LegBoundsOf(Problem problem, const FlightModel& model)
    : problem_(std::move(problem)),
      energy_problem_(for_energy(problem_)),
      task_(problem_, model, nullptr),
      energy_task_(energy_problem_, model, nullptr),
      cost_(task_),
      energy_(energy_task_) {}

template <class Family>
LegCost LegBoundsOf<Family>::from(const Configuration& at) const {
    return {cost_.min_cost_to_goal(at), energy_.min_cost_to_goal(at)};
}

template <class Family>
LegCost LegBoundsOf<Family>::along(std::span<const Configuration> chain, double hold_s) const {
    LegCost sum{cost_.of_hold(chain.back(), hold_s), energy_.of_hold(chain.back(), hold_s)};
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
        sum.cost += cost_.of_motion(chain[i], chain[i + 1]);
        sum.energy_j += energy_.of_motion(chain[i], chain[i + 1]);
    }
    return sum;
}

std::vector<ExpectedLegOf<Space>> expected_legs(const SpaceProblem& problem,
                                                std::span<const std::unique_ptr<LegBoundsOf<Space>>> bounds,
                                                std::size_t targets, const StopCondition& is_over) {
    const SpaceConfiguration start = place_of(problem.start);
    std::vector<std::vector<SpaceConfiguration>> places;
    std::vector<std::vector<Vector3>> places_m;
    std::vector<Vector3> all_m;
    const auto add = [&](std::vector<SpaceConfiguration> some) {
        std::ranges::transform(some, std::back_inserter(places_m.emplace_back()), position_m);
        all_m.insert(all_m.end(), places_m.back().begin(), places_m.back().end());
        places.push_back(std::move(some));
    };
    constexpr std::size_t most_samples = 4, samples_in_all = 128;
    const std::size_t samples = std::clamp<std::size_t>(samples_in_all / bounds.size(), 1, most_samples);
    for (std::size_t to = 0; to < bounds.size(); ++to) {
        add(places_at_goal(bounds[to]->space(), to, samples));
    }
    add({start});
    constexpr double most_cells = 1 << 17, most_in_all = 1 << 22;  // a search through these takes about a second
    WaysAround ways(bounds.front()->space(), start, problem.robot.rotor_radius_m, all_m,
                    std::min(most_cells, most_in_all / static_cast<double>(places.size())));

    std::vector<ExpectedLegOf<Space>> legs((targets + 1) * (targets + 1));
    for (std::size_t from = 0; from <= targets; ++from) {
        if (is_over && is_over()) {
            return {};  // of legs of which little is known, those would look best of which nothing is
        }
        const std::size_t begin = from < targets ? from : places.size() - 1;
        const auto corners_m = ways.from(places_m[begin], std::span(places_m).first(bounds.size()));
        for (std::size_t to = 0; to < bounds.size(); ++to) {
            if (corners_m[to] && to != from) {
                legs[from * (targets + 1) + to] =
                    cheapest_leg(places[begin], places[to], *corners_m[to], start, *bounds[to]);
            }
        }
    }
    return legs;
}

template class LegBoundsOf<Plane>;
template class LegBoundsOf<Space>;

}  // namespace downwash::planning
