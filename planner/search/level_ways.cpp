#include "downwash/search/level_ways.hpp"

#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>

#include <algorithm>
#include <memory>

#include "downwash/search/ompl_space.hpp"
#include "downwash/search/quiet_ompl.hpp"
#include "downwash/search/seeded.hpp"
#include "downwash/simulation/flight_rules.hpp"

namespace downwash::planning {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

/// Numbers of the states of a path between which straight motions are free, each as far along as possible.
std::vector<std::size_t> corners_of(og::PathGeometric& path, const ob::SpaceInformation& information) {
    std::vector<std::size_t> corners;
    for (std::size_t from = 0; from + 1 < path.getStateCount();) {
        std::size_t to = path.getStateCount() - 1;
        while (to > from + 1 && !information.checkMotion(path.getState(static_cast<unsigned int>(from)),
                                                         path.getState(static_cast<unsigned int>(to)))) {
            --to;
        }
        corners.push_back(to);
        from = to;
    }
    return corners;
}

}  // namespace

template <class Family>
auto LevelWaysOf<Family>::find(Random& random, std::uint64_t max_iterations, const StopCondition& is_over) const
    -> std::vector<Configuration> {
    const QuietOmpl quiet;
    QueryCounts counts;
    const auto& space = task_.space;
    const double step_m = std::min(max_unseen_motion_m(task_.problem.planner.safety_margin_m), 0.1);
    const ob::SpaceInformationPtr information = make_space_information(space, random, step_m, counts);
    const auto definition = std::make_shared<ob::ProblemDefinition>(information);
    ob::ScopedState<> start(information);
    write(place_of(task_.problem.start), start.get(), space);
    definition->addStartState(start);
    definition->setGoal(make_goal_region(information, space, random));
    const auto seed = static_cast<std::uint32_t>(random.uniform(1, 4e9));
    const auto planner =
        with_linear_neighbours(std::make_shared<Seeded<og::RRTConnect>>(information, seed), definition);
    planner->setup();
    std::uint64_t iterations = 0;
    planner->solve(
        ob::PlannerTerminationCondition([&] { return ++iterations > max_iterations || (is_over && is_over()); }));

    std::vector<Configuration> way;
    if (!definition->hasExactSolution()) {
        return way;
    }
    auto& path = *definition->getSolutionPath()->template as<og::PathGeometric>();
    for (const std::size_t corner : corners_of(path, *information)) {
        way.push_back(read(path.getState(static_cast<unsigned int>(corner)), space));
    }
    return way;
}

template class LevelWaysOf<Space>;

}  // namespace downwash::planning
