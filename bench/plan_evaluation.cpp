#include "downwash/bench/plan_evaluation.hpp"

#include <string>
#include <utility>

#include "downwash/problems/problem_model.hpp"
#include "downwash/simulation/space_world_parameters.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash::bench {
namespace {

/// The world in which one parameter is at a quantile of its spread and all else is nominal, noise included.
World world_of(const WorldParameter& parameter, const Uncertainty& uncertainty, const Robot& robot, double at) {
    World world;
    parameter.put(world, uncertainty, robot, at);
    return world;
}

/// @param fails whether the flight in a world failed: those drawn, then two of each parameter
template <class Fails>
WorldFigures counted(std::uint64_t worlds, const std::vector<std::string>& parameters, const Fails& fails) {
    WorldFigures figures;
    figures.worlds = worlds;
    for (std::size_t i = 0; i < worlds; ++i) {
        figures.failures += fails(i) ? 1 : 0;
    }
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const std::size_t low = worlds + 2 * i;
        figures.alone.push_back({parameters[i], fails(low), fails(low + 1)});
    }
    return figures;
}

}  // namespace

PlanEvaluation::PlanEvaluation(Problem problem, std::uint64_t worlds, std::shared_ptr<const AeroMap> map)
    : problem_(std::move(problem)), world_count_(worlds), model_(make_flight_model(problem_)), map_(std::move(map)) {
    const Robot& robot = problem_.robot;
    const Uncertainty& uncertainty = problem_.uncertainty.value();
    for (std::uint64_t i = 1; i <= worlds; ++i) {
        worlds_.push_back(make_world(robot, draw_world(uncertainty, robot, evaluation_seed, i)));
    }
    const int rotors = model_->tick().plant.rotor_count;
    for (const WorldParameter* parameter : world_parameters_of(robot)) {
        if ((uncertainty.*parameter->spread).form != downwash::Spread::Form::exact && parameter->rotor < rotors) {
            parameters_.emplace_back(parameter->name);
            for (const double at : {low_quantile, high_quantile}) {
                worlds_.push_back(make_world(robot, world_of(*parameter, uncertainty, robot, at)));
            }
        }
    }
}

std::unique_ptr<WorldFlights> PlanEvaluation::take() {
    {
        const std::scoped_lock lock(free_mutex_);
        if (!free_.empty()) {
            std::unique_ptr<WorldFlights> flights = std::move(free_.back());
            free_.pop_back();
            return flights;
        }
    }
    return std::make_unique<WorldFlights>(problem_, model_, map_);
}

void PlanEvaluation::give_back(std::unique_ptr<WorldFlights> flights) {
    const std::scoped_lock lock(free_mutex_);
    free_.push_back(std::move(flights));
}

WorldFigures PlanEvaluation::evaluate(const Plan& plan) {
    std::unique_ptr<WorldFlights> flights = take();
    std::call_once(has_starts_, [&] { starts_ = flights->starts_in(worlds_); });
    const std::vector<WorldFlight> flown = flights->fly_from(starts_, plan, flights->goals().size(), worlds_);
    give_back(std::move(flights));
    return counted(world_count_, parameters_,
                   [&](std::size_t world) { return flown[world].rejection != Rejection::none; });
}

SpacePlanEvaluation::SpacePlanEvaluation(SpaceProblem problem, std::uint64_t worlds)
    : problem_(std::move(problem)),
      world_count_(worlds),
      model_(std::make_shared<const SpaceProblemModel>(problem_)),
      volumes_(problem_.aero.enabled ? make_volumes(*model_, {}) : nullptr) {
    const SpaceRobot& robot = problem_.robot;
    const Uncertainty& uncertainty = problem_.uncertainty.value();
    for (std::uint64_t i = 1; i <= worlds; ++i) {
        worlds_.push_back(draw_space_world(uncertainty, robot, evaluation_seed, i));
    }
    for (const SpaceWorldParameter* parameter : space_world_parameters_of(robot)) {
        if ((uncertainty.*parameter->spread).form != downwash::Spread::Form::exact) {
            parameters_.push_back(parameter->name);
            for (const double at : {low_quantile, high_quantile}) {
                parameter->put(worlds_.emplace_back(), uncertainty, robot, at);
            }
        }
    }
}

std::optional<WorldFigures> SpacePlanEvaluation::evaluate(const SpacePlan& plan, const std::optional<VisitOrder>& order,
                                                          const std::stop_token& stop) const {
    const auto model = order ? std::make_shared<const SpaceProblemModel>(in_order(problem_, order)) : model_;
    try {
        const std::vector<WorldSample> flown =
            fly_in_worlds(model, volumes_, plan, worlds_, [&stop] { return stop.stop_requested(); });
        return counted(world_count_, parameters_,
                       [&](std::size_t world) { return flown[world].outcome != Outcome::ok; });
    } catch (const WorkStopped&) {
        return std::nullopt;
    }
}

}  // namespace downwash::bench
