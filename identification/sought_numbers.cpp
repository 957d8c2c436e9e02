#include "downwash/identification/sought_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace downwash::identification {
namespace {

/// Standard deviation of K - 1 near a surface before a flight says anything.
constexpr double surface_effect_sd = 0.3;

/// Whether flights in free air show a number.
bool is_sought(std::string_view name) {
    return name.starts_with("vehicle.") || name.starts_with("sensing.pitch_bias") ||
           name.starts_with("sensing.yaw_bias");
}

}  // namespace

Known known_of(const SpaceWorldParameter& parameter, const Uncertainty& uncertainty, const SpaceRobot& robot) {
    const Spread& spread = uncertainty.*parameter.spread;
    const bool is_of_robot = parameter.nominal != nullptr;
    const double nominal = is_of_robot ? parameter.nominal(robot) : 0;
    const auto at = [&](double p) { return spread.difference(p, nominal, is_of_robot); };
    return {at(0.5), spread.form == Spread::Form::sd ? spread.high : (at(1) - at(0)) / std::sqrt(12.0)};
}

SoughtNumbers::SoughtNumbers(const SpaceRobot& robot, const IdentifySettings& settings, const SurfaceNodes& surface)
    : robot_(robot), has_drag_(robot.plant.drag.is_any()) {
    const Uncertainty vehicle = robot.uncertainty.value_or(Uncertainty{});
    for (const SpaceWorldParameter* parameter : space_world_parameters_of(robot)) {
        if (parameter->name.starts_with("wind.steady")) {
            wind_[static_cast<std::size_t>(parameter->number)] = known_of(*parameter, settings.air, robot);
        }
        const Known known = known_of(*parameter, vehicle, robot);
        if (!is_sought(parameter->name) || !(known.sd > 0)) {
            continue;
        }
        parameters_.push_back(parameter);
        double least = -10;
        if (parameter->nominal != nullptr) {  // lag and delay stay above a share of what they are, and above zero
            constexpr double least_share = 0.1;
            least = ((least_share - 1) * parameter->nominal(robot) - known.mean) / known.sd;
        }
        add(parameter->name, known, least);
    }
    if (has_drag_ && settings.drag_sd > 0) {
        add("multirotor.drag", {0, settings.drag_sd}, -0.95 / settings.drag_sd);
    }
    has_drag_ = has_drag_ && settings.drag_sd > 0;
    surface_effects_ = static_cast<Eigen::Index>(surface.count());
    for (Eigen::Index i = 0; i < surface_effects_; ++i) {
        add("K - 1", {0, surface_effect_sd});
    }
}

void SoughtNumbers::add(const std::string& name, const Known& known, double least) {
    names_.push_back(name);
    known_.push_back(known);
    least_.push_back(least);
}

Trial SoughtNumbers::trial(const double* vehicle, const double* wind) const {
    Trial trial{robot_, {}, {}};
    Eigen::Index i = 0;
    for (const SpaceWorldParameter* parameter : parameters_) {
        parameter->place(trial.world, parameter->number) = value(i, vehicle[i]);
        ++i;
    }
    if (has_drag_) {
        const double scale = 1 + value(i, vehicle[i]);
        trial.robot.plant.drag.linear_n_s_m *= scale;
        trial.robot.plant.drag.quadratic_n_s2_m2 *= scale;
        ++i;
    }
    for (; i < of_vehicle(); ++i) {
        trial.surface_effects.push_back(value(i, vehicle[i]));
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        trial.world.wind_m_s[axis] = wind_[axis].mean + wind[axis] * wind_[axis].sd;
    }
    return trial;
}

}  // namespace downwash::identification
