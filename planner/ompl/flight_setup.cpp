#include "downwash/ompl/flight_setup.hpp"

#include <ompl/base/ScopedState.h>
#include <ompl/control/PathControl.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "downwash/ompl_planners/flight_controls.hpp"
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
    return plannable(std::move(problem));
}

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
    Impl(Problem given, std::shared_ptr<const AeroMap> given_map)
        : plannable(with_one_goal(std::move(given))),
          map(std::move(given_map)),
          task(plannable.problem, *plannable.model, map.get()),
          planned(task),
          flights(planned),
          random(plannable.problem.planner.seed),
          setup(std::make_shared<oc::SimpleSetup>(planning::make_flight_information(flights, random))) {
        const auto& information = setup->getSpaceInformation();
        ob::ScopedState<> start(information);
        planning::point_of(start.get()) = flights.start();
        setup->setStartState(start);
        setup->setGoal(planning::make_closing_goal(information, flights, random));
        setup->setOptimizationObjective(planning::make_flight_objective(information));
    }

    PlannableProblem plannable;
    std::shared_ptr<const AeroMap> map;
    planning::SearchTask task;
    planning::PlannedFlights planned;
    planning::SteeredFlights flights;
    planning::Random random;
    oc::SimpleSetupPtr setup;
};

FlightSetup::FlightSetup(Problem problem, std::shared_ptr<const AeroMap> map)
    : impl_(std::make_unique<Impl>(std::move(problem), std::move(map))) {}

FlightSetup::~FlightSetup() = default;

const oc::SimpleSetupPtr& FlightSetup::simple_setup() const noexcept {
    return impl_->setup;
}

ob::PlannerPtr FlightSetup::make_flight_tree_planner() const {
    const auto planner = std::make_shared<ControlledFlightTree>(impl_->setup->getSpaceInformation(), impl_->task);
    planner->set_max_iterations(impl_->plannable.problem.planner.max_iterations);
    return planner;
}

std::optional<Plan> FlightSetup::plan_of(const ob::Path& path) const {
    const auto* way = dynamic_cast<const oc::PathControl*>(&path);
    if (way == nullptr) {
        throw std::invalid_argument("FlightSetup::plan_of() wants a path over controls");
    }
    const std::vector<planning::FlightPoint> moments = planning::moments_along(*way, impl_->flights);
    if (moments.size() > 1 && planning::ends_with_hover(moments, impl_->planned)) {
        return planning::plan_through(moments, impl_->plannable.model->tick().tick_s);
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
