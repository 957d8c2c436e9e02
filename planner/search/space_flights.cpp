#include "downwash/search/space_flights.hpp"

#include <utility>

#include "downwash/simulation/instructions.hpp"

namespace downwash::planning {
namespace {

SpacePoolSetup setup_of(const SearchTaskOf<Space>& task, const std::optional<SpacePlanningRules>& rules,
                        std::function<bool()> is_over) {
    const SpaceRobot& robot = task.model.problem().robot;
    SpacePoolSetup setup{robot};
    if (task.map != nullptr) {
        setup.aero = simulation::space_aero(task.problem.aero, robot.rotor_radius_m);
        setup.volumes = task.map;
    }
    setup.checker = &task.model.collisions();
    setup.margin_m = rules ? task.problem.planner.safety_margin_m : 0;
    setup.rules = rules;
    setup.goal = &task.space.goal_rule();
    setup.measures_clearance = task.problem.planner.objective.weight(Objective::clearance) > 0;
    setup.is_over = std::move(is_over);
    return setup;
}

}  // namespace

SpaceFlights::SpaceFlights(const SearchTaskOf<Space>& task, std::optional<SpacePlanningRules> rules,
                           std::function<bool()> is_over, int threads)
    : pool_(setup_of(task, rules, std::move(is_over)), threads),
      again_(std::make_unique<SpacePool>(setup_of(task, rules, {}), 1, Instructions::baseline)) {}

std::uint64_t SpaceFlights::fly(std::span<SpaceFlightJob> jobs) {
    pool_.fly(jobs);
    std::uint64_t ticks = 0;
    for (const SpaceFlightJob& job : jobs) {
        for (const SpaceFlightLeg& leg : job.legs) {
            ticks += static_cast<std::uint64_t>(leg.flight.ticks);
        }
    }
    return ticks;
}

SpaceSegmentFlight SpaceFlights::fly_again(const SpaceSegment& segment, AnySpaceState& vehicle,
                                           const SpaceFlightWorld& in) const {
    SpaceFlightJob job{vehicle, {{segment}}, in.world, in.first_tick};
    {
        const std::scoped_lock lock(mutex_);
        again_->fly(std::span(&job, 1));
    }
    vehicle = job.legs.front().end;
    return job.legs.front().flight;
}

}  // namespace downwash::planning
