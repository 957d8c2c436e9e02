#include "downwash/ompl/flight_setup.hpp"

#include <ompl/base/ScopedState.h>
#include <ompl/control/PathControl.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "downwash/ompl_planners/flight_controls.hpp"
#include "downwash/planner/direct_flight.hpp"
#include "downwash/planner/worlds.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/search/flight_tree_planner.hpp"

namespace downwash {
namespace {

namespace ob = ::ompl::base;
namespace oc = ::ompl::control;

PlannableProblem with_one_goal(Problem problem) {
    if (!problem.goals_before.empty()) {
        throw InputError({KeyError{"goal", "is a list of goals to visit in turn: expected one goal"}});
    }
    if (!plans_flights(problem.planner.variant)) {
        throw InputError(
            {KeyError{"planner.variant", "is mp-arm, which flies nothing: expected mp-arm-da or mp-arm-ada"}});
    }
    return plannable(std::move(problem));
}

/// The planner's own model with a map or in free air, and the true one, which has the effects of surfaces.
planning::PlannerModel model_of(const PlannableProblem& plannable, const std::shared_ptr<const AeroMap>& map) {
    const Problem& problem = plannable.problem;
    const bool needs_true_map = problem.uncertainty && problem.planner.certify && problem.aero.enabled;
    planning::PlannerModel model(problem.planner.variant, plannable.model,
                                 map || !needs_true_map ? map : plannable.model->make_map(problem.bounds));
    model.own_map = map;
    return model;
}

/// Lets flights lead to the problem's goal again in the end.
class GoalScope {
 public:
    explicit GoalScope(planning::PlannedFlights& flights) : flights_(flights) {}
    ~GoalScope() { flights_.lead_to(nullptr); }
    GoalScope(const GoalScope&) = delete;
    GoalScope& operator=(const GoalScope&) = delete;

 private:
    planning::PlannedFlights& flights_;
};

/// Our planner among those over controls: the edges of its solutions are controls.
class ControlledFlightTree : public planning::FlightTreePlanner {
 public:
    using FlightTreePlanner::FlightTreePlanner;

 protected:
    [[nodiscard]] ob::PathPtr make_path(const std::vector<planning::FlightPoint>& moments) const override {
        const auto information = std::static_pointer_cast<oc::SpaceInformation>(si_);
        auto path = std::make_shared<oc::PathControl>(information);
        ob::ScopedState<> state(information);
        oc::Control* control = information->allocControl();
        planning::point_of(state.get()) = moments.front();
        path->append(state.get());
        for (std::size_t i = 1; i < moments.size(); ++i) {
            planning::follow(control, moments[i].reference, moments[i].ticks - moments[i - 1].ticks);
            planning::point_of(state.get()) = moments[i];
            path->append(state.get(), control, information->getPropagationStepSize());
        }
        information->freeControl(control);
        return path;
    }
};

}  // namespace

struct FlightSetup::Impl {
    Impl(Problem given, const std::shared_ptr<const AeroMap>& map)
        : plannable(with_one_goal(std::move(given))),
          model(model_of(plannable, map)),
          start(planning::Course::from_start(plannable.problem, *model.flight)),
          worlds(plannable.problem.uncertainty
                     ? std::make_unique<planning::ProblemWorlds>(plannable.problem, model, SolveOptions{})
                     : nullptr),
          search_worlds(worlds != nullptr ? worlds->for_search(start) : planning::SearchWorlds{}),
          task(plannable.problem, *model.flight, model.own_map.get(), {}, worlds != nullptr ? &search_worlds : nullptr),
          planned(task),
          flights(planned),
          random(plannable.problem.planner.seed),
          setup(std::make_shared<oc::SimpleSetup>(planning::make_flight_information(flights, random))) {
        const auto& information = setup->getSpaceInformation();
        ob::ScopedState<> state(information);
        planning::point_of(state.get()) = flights.start();
        setup->setStartState(state);
        setup->setGoal(planning::make_closing_goal(information, flights, random));
        setup->setOptimizationObjective(planning::make_flight_objective(information));
    }

    const Certificate& certify(const Plan& plan, const StopCondition& is_over) {
        return certificate.emplace(worlds->certify(plan, ++attempts, is_over));
    }

    /// Whether a plan of our planner counts.
    bool counts(const Plan& plan, const StopCondition& is_over) {
        const Problem& problem = plannable.problem;
        try {
            if (problem.planner.check_execution &&
                !planning::is_good(planning::fly_directly(*model.flight, task.start, plan, {problem.goal},
                                                          problem.energy_budget_j, is_over)
                                       .execution,
                                   problem.planner.safety_margin_m)) {
                return false;
            }
        } catch (const WorkStopped&) {
            return false;
        }
        return worlds == nullptr || !problem.planner.certify || certify(plan, is_over).is_given;
    }

    PlannableProblem plannable;
    planning::PlannerModel model;
    planning::Course start;
    std::unique_ptr<planning::ProblemWorlds> worlds;  ///< nullptr without an uncertainty
    planning::SearchWorlds search_worlds;
    planning::SearchTask task;
    planning::PlannedFlights planned;
    planning::SteeredFlights flights;
    planning::Random random;
    oc::SimpleSetupPtr setup;
    std::uint64_t attempts = 0;
    std::optional<Certificate> certificate;
};

FlightSetup::FlightSetup(Problem problem, std::shared_ptr<const AeroMap> map)
    : impl_(std::make_unique<Impl>(std::move(problem), map)) {}

FlightSetup::~FlightSetup() = default;

const oc::SimpleSetupPtr& FlightSetup::simple_setup() const noexcept {
    return impl_->setup;
}

ob::PlannerPtr FlightSetup::make_flight_tree_planner() const {
    const auto planner = std::make_shared<ControlledFlightTree>(impl_->setup->getSpaceInformation(), impl_->task);
    planner->search().set_max_iterations(impl_->plannable.problem.planner.max_iterations);
    planning::CandidateHooks hooks;
    hooks.survives_execution = [impl = impl_.get(), asking = planner.get()](const planning::Candidate& candidate) {
        const Plan plan = planning::plan_through(candidate.moments, impl->task.blank_plan);
        return asking->has_users_goal() || impl->counts(plan, [asking] { return asking->search().is_over(); });
    };
    hooks.counterexamples = [impl = impl_.get()] {
        const bool has_failed = impl->certificate && !impl->certificate->is_given;
        return has_failed ? impl->worlds->counterexamples(*impl->certificate, impl->start)
                          : std::vector<planning::Counterexample>{};
    };
    planner->search().set_hooks(std::move(hooks));
    return planner;
}

Certificate FlightSetup::certify(const Plan& plan) {
    return impl_->certify(plan, {});
}

const std::optional<Certificate>& FlightSetup::certificate() const noexcept {
    return impl_->certificate;
}

const ob::StateSpacePtr& FlightSetup::places() const noexcept {
    return planning::places_of(*impl_->setup->getStateSpace());
}

Configuration FlightSetup::place_of(const ob::State* state) {
    return configuration_of(planning::point_of(state).vehicle.plant.q);
}

double FlightSetup::energy_j_of(const ob::State* state) {
    return planning::point_of(state).vehicle.plant.energy_j;
}

void FlightSetup::rest_at(const Configuration& place, ob::State* state) const {
    planning::point_of(state) = planning::resting_at(*impl_->model.flight, place);
}

std::optional<Plan> FlightSetup::plan_of(const ob::Path& path) const {
    const auto* way = dynamic_cast<const oc::PathControl*>(&path);
    if (way == nullptr) {
        throw std::invalid_argument("FlightSetup::plan_of() wants a path over controls");
    }
    const std::vector<planning::FlightPoint> moments = planning::moments_along(*way, impl_->flights);
    // The hover is judged by the goal that was searched for.
    const auto* goal = dynamic_cast<const ob::GoalSampleableRegion*>(impl_->setup->getGoal().get());
    std::optional<planning::OmplGoal> users_goal;
    if (goal != nullptr && dynamic_cast<const planning::FlightGoal*>(goal) == nullptr) {
        users_goal.emplace(impl_->setup->getSpaceInformation(), impl_->task, *goal);
    }
    impl_->planned.lead_to(users_goal ? &*users_goal : nullptr);
    const GoalScope scope(impl_->planned);
    if (moments.size() > 1 && planning::ends_with_hover(moments, impl_->planned)) {
        return planning::plan_through(moments, impl_->task.blank_plan);
    }
    const std::optional<planning::Closing> closing = impl_->flights.closing(moments.back());
    return closing ? std::optional(impl_->flights.plan(moments, closing)) : std::nullopt;
}

const Problem& FlightSetup::problem() const noexcept {
    return impl_->plannable.problem;
}

const FlightModel& FlightSetup::model() const noexcept {
    return *impl_->plannable.model;
}

}  // namespace downwash
