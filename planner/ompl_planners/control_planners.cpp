#include "downwash/ompl_planners/control_planners.hpp"

#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/control/PathControl.h>
#include <ompl/control/planners/est/EST.h>
#include <ompl/control/planners/kpiece/KPIECE1.h>
#include <ompl/control/planners/rrt/RRT.h>
#include <ompl/control/planners/sst/SST.h>

#include <stdexcept>

#include "downwash/ompl_planners/flight_controls.hpp"
#include "downwash/ompl_planners/ompl_parameters.hpp"
#include "downwash/search/quiet_ompl.hpp"
#include "downwash/search/seeded.hpp"
#include "downwash/search/tree_record.hpp"

namespace downwash::planning {
namespace {

namespace ob = ompl::base;
namespace oc = ompl::control;

class SeededSst : public Seeded<oc::SST> {
 public:
    using Seeded::Seeded;

    /// From now on any solution will do again, not only those cheaper than the last.
    void forget_solution() { prevSolutionCost_ = opt_->infiniteCost(); }
};

struct ResumablePlanner {
    ob::PlannerPtr planner;
    bool is_anytime = false;
    std::function<void()> forget_solution = [] {};  ///< after one was discarded
};

ResumablePlanner prepared_planner(std::string_view algorithm, const oc::SpaceInformationPtr& information,
                                  const ob::ProblemDefinitionPtr& definition, std::uint32_t seed) {
    if (algorithm == "rrt") {
        return {with_linear_neighbours(std::make_shared<Seeded<oc::RRT>>(information, seed), definition)};
    }
    if (algorithm == "sst") {
        const auto sst = with_linear_neighbours(std::make_shared<SeededSst>(information, seed), definition);
        return {sst, true, [sst] { sst->forget_solution(); }};
    }
    if (algorithm == "kpiece1") {
        return {std::make_shared<Seeded<oc::KPIECE1>>(information, seed)};
    }
    if (algorithm == "est") {
        return {std::make_shared<Seeded<oc::EST>>(information, seed)};
    }
    throw std::logic_error("no planner over controls has this name");
}

/// The search for a plan and then for better ones, one OMPL solution at a time.
template <class Family>
class ControlSearch {
 public:
    using Plan = typename Family::Plan;
    using SteeredFlights = SteeredFlightsOf<Family>;
    using FlightPoint = FlightPointOf<Family>;
    using FlightStatistics = FlightStatisticsOf<Family>;
    using Closing = ClosingOf<Family>;
    using OmplHooks = OmplHooksOf<Family>;
    using OmplResult = OmplResultOf<Family>;

    ControlSearch(const SteeredFlights& flights, const OmplHooks& hooks)
        : flights_(flights), hooks_(hooks), nearest_{flights.start()} {}

    void run(const ResumablePlanner& prepared, const ob::ProblemDefinitionPtr& definition) {
        review({flights_.start()});
        while (!(result_.plan && !prepared.is_anytime) && !is_over_) {
            const std::uint64_t before = iterations_;
            const ob::PlannerStatus status =
                prepared.planner->solve(ob::PlannerTerminationCondition([this] { return ask(); }));
            if (const ob::PathPtr path = definition->getSolutionPath()) {
                // The planner's status counts an approximate solution as one.
                const bool is_exact = status == ob::PlannerStatus::EXACT_SOLUTION;
                std::vector<FlightPoint> moments = moments_along(*path->as<oc::PathControl>(), flights_);
                const Review review_of = is_exact ? review(moments) : Review::not_closed;
                if (review_of == Review::discarded) {
                    prepared.forget_solution();
                }
                if (review_of != Review::accepted && distance_m(moments.back()) < distance_m(nearest_.back())) {
                    nearest_ = std::move(moments);
                }
            }
            definition->clearSolutionPaths();
            if (iterations_ == before) {
                break;  // the planner will not go on
            }
        }
    }

    [[nodiscard]] OmplResult result() const {
        OmplResult result = result_;
        result.iterations = iterations_;
        if (!result.plan) {
            result.nearest_approach_m = distance_m(nearest_.back());
        }
        if (!result.plan && nearest_.size() > 1) {
            result.status = Status::approximate;
            result.plan = flights_.plan(nearest_, {});
            result.cost = nearest_.back().cost;
        }
        return result;
    }

 private:
    bool ask() {
        is_over_ = is_over_ || hooks_.is_over({iterations_, statistics().edges, statistics().rejections});
        iterations_ += is_over_ ? 0 : 1;
        return is_over_;
    }

    [[nodiscard]] const FlightStatistics& statistics() const { return flights_.flights().statistics(); }

    /// From the place of rest to the goal region.
    [[nodiscard]] double distance_m(const FlightPoint& moment) const {
        return flights_.space().goal_distance_m(moment.rest);
    }

    enum class Review { accepted, not_closed, no_better, discarded };

    /// Closes a flight and offers it.
    Review review(const std::vector<FlightPoint>& moments) {
        if (!flights_.is_worth_closing(moments.back())) {
            return Review::not_closed;
        }
        const std::optional<Closing> end = flights_.closing(moments.back());
        if (!end) {
            return Review::not_closed;
        }
        if (result_.plan && end->cost >= result_.cost) {
            return Review::no_better;
        }
        Plan plan = flights_.plan(moments, end);
        flights_.verify(moments, *end);
        if (!hooks_.accept(plan, end->cost, iterations_)) {
            flights_.flights().count_rejection("direct_flight");
            return Review::discarded;
        }
        result_ = {Status::solved, std::move(plan), end->cost, 0, {}, {}};
        return Review::accepted;
    }

    const SteeredFlights& flights_;
    const OmplHooks& hooks_;
    OmplResult result_;
    std::vector<FlightPoint> nearest_;  ///< the way to the place of rest that came nearest to the goal
    std::uint64_t iterations_ = 0;
    bool is_over_ = false;
};

}  // namespace

template <class Family>
OmplResultOf<Family> plan_by_controls(const SteeredFlightsOf<Family>& flights, Random& random,
                                      const OmplHooksOf<Family>& hooks) {
    using Configuration = typename Family::Configuration;
    const QuietOmpl quiet;
    const PlannerSettings& settings = flights.task().problem.planner;
    const oc::SpaceInformationPtr information = make_flight_information(flights, random);
    const auto definition = std::make_shared<ob::ProblemDefinition>(information);
    ob::ScopedState<> start(information);
    point_of<Family>(start.get()) = flights.start();
    definition->addStartState(start);
    definition->setGoal(make_closing_goal(information, flights, random));
    definition->setOptimizationObjective(make_flight_objective<Family>(information));

    const ResumablePlanner prepared = prepared_planner(settings.algorithm, information, definition, settings.seed);
    prepared.planner->setProblemDefinition(definition);
    set_parameters(*prepared.planner, settings);
    prepared.planner->setup();
    ControlSearch<Family> search(flights, hooks);
    search.run(prepared, definition);
    OmplResultOf<Family> result = search.result();
    if (hooks.keep_tree) {
        result.tree = tree_of<Configuration>(*prepared.planner,
                                             [](const ob::State* state) { return point_of<Family>(state).rest; });
    }
    return result;
}

template OmplResult plan_by_controls(const SteeredFlights&, Random&, const OmplHooks&);
template OmplResultOf<Space> plan_by_controls(const SteeredFlightsOf<Space>&, Random&, const OmplHooksOf<Space>&);

}  // namespace downwash::planning
