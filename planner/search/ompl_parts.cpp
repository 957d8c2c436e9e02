#include "downwash/search/ompl_parts.hpp"

#include <cmath>
#include <utility>

#include "downwash/search/flight_space.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash::planning {
namespace {

namespace ob = ompl::base;

bool is_slow(const FlightState& vehicle) {
    const double* u = vehicle.plant.u;
    return std::sqrt(u[0] * u[0] + u[1] * u[1]) < goal_max_speed_m_s;
}

}  // namespace

OmplSampler::OmplSampler(const ob::SpaceInformationPtr& information, const SearchTask& task,
                         ob::InformedSamplerPtr informed)
    : task_(task),
      state_(information),
      beside_(information),
      sampler_(information->allocStateSampler()),
      informed_(std::move(informed)) {}

std::optional<Configuration> OmplSampler::anywhere(double most) {
    if (informed_ == nullptr || !std::isfinite(most)) {
        sampler_->sampleUniform(state_.get());
    } else if (!informed_->sampleUniform(state_.get(), ob::Cost(most))) {
        return std::nullopt;
    }
    return point_of(std::as_const(state_).get()).rest;
}

Configuration OmplSampler::near(const Configuration& place, double radius_m) {
    point_of(beside_.get()) = resting_at(task_.model, place);
    sampler_->sampleUniformNear(state_.get(), beside_.get(), radius_m);
    return point_of(std::as_const(state_).get()).rest;
}

OmplGoal::OmplGoal(const ob::SpaceInformationPtr& information, const SearchTask& task,
                   const ob::GoalSampleableRegion& goal)
    : task_(task), goal_(goal), state_(information) {}

std::optional<Configuration> OmplGoal::sample(Random&) const {
    constexpr int tries = 20;
    const std::scoped_lock lock(mutex_);
    for (int i = 0; i < tries && goal_.canSample(); ++i) {
        goal_.sampleGoal(state_.get());
        const Configuration& place = point_of(std::as_const(state_).get()).rest;
        if (task_.space.is_valid(place)) {
            return place;
        }
    }
    return std::nullopt;
}

std::optional<Configuration> OmplGoal::sample_near(const Configuration& configuration, double radius_m,
                                                   Random& random) const {
    const Configuration near = task_.space.sample_near(configuration, radius_m, random);
    return task_.space.is_valid(near) && contains(near) ? std::optional(near) : std::nullopt;
}

double OmplGoal::distance_m(const Configuration& configuration) const {
    const std::scoped_lock lock(mutex_);
    point_of(state_.get()) = resting_at(task_.model, configuration);
    return goal_.isSatisfied(state_.get()) ? 0 : goal_.distanceGoal(state_.get());
}

bool OmplGoal::contains(const Configuration& configuration) const {
    const std::scoped_lock lock(mutex_);
    point_of(state_.get()) = resting_at(task_.model, configuration);
    return goal_.isSatisfied(state_.get());
}

bool OmplGoal::is_met(const FlightState& vehicle) const {
    const std::scoped_lock lock(mutex_);
    const Configuration place = configuration_of(vehicle.plant.q);
    FlightPoint& point = point_of(state_.get());
    point = resting_at(task_.model, place);
    point.vehicle = vehicle;
    return is_slow(vehicle) && goal_.isSatisfied(state_.get());
}

OmplObjective::OmplObjective(const ob::SpaceInformationPtr& information, const SearchTask& task,
                             const ob::OptimizationObjective& objective, const ob::Goal& goal)
    : task_(task), objective_(objective), goal_(goal), from_(information), to_(information) {}

double OmplObjective::of_leg(const FlightState& from, const FlightLeg& leg) const {
    const std::scoped_lock lock(mutex_);
    point_of(from_.get()) = {from, {}, leg.segment.from(), configuration_of(leg.segment.from()), 0, 0};
    point_of(to_.get()) = {leg.end, {}, leg.segment.to(), configuration_of(leg.segment.to()), 0, leg.flight.ticks};
    return objective_.motionCost(from_.get(), to_.get()).value();
}

double OmplObjective::estimate(const Configuration& from, const Configuration& to) const {
    const std::scoped_lock lock(mutex_);
    point_of(from_.get()) = resting_at(task_.model, from);
    point_of(to_.get()) = resting_at(task_.model, to);
    return objective_.motionCostHeuristic(from_.get(), to_.get()).value();
}

double OmplObjective::min_to_goal(const Configuration& from) const {
    const std::scoped_lock lock(mutex_);
    point_of(from_.get()) = resting_at(task_.model, from);
    return objective_.costToGo(from_.get(), &goal_).value();
}

bool is_additive(const ob::OptimizationObjective& objective) {
    return objective.combineCosts(ob::Cost(1), ob::Cost(2)).value() == 3 &&
           objective.isCostBetterThan(ob::Cost(1), ob::Cost(2));
}

}  // namespace downwash::planning
