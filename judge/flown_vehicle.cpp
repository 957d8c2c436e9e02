#include "downwash/judge/flown_vehicle.hpp"

#include <cmath>

#include "downwash/problems/problem_model.hpp"

namespace downwash::judge {
namespace {

/// How long a vehicle in a world has hovered at its start (docs/model.md 9).
constexpr double hover_before_start_s = 20;

}  // namespace

Setting::Setting(const Problem& of)
    : problem(of), obstacles(of.obstacles, of.plane, of.robot.shape(), of.robot.rotors.radius_m), law(of.robot) {
    if (of.aero.enabled) {
        effects.all = make_flight_model(of);
        effects.rays = RayEffect::made_for(of.obstacles, effects.all);
        effects.has_fountain = !of.aero.map && of.aero.ground.model == EffectModel::multirotor_body;
        effects.wall_force = of.aero.wall.force;
        effects.wall_moment_m = of.aero.wall.moment * of.robot.rotors.radius_m;
        if (!of.aero.map) {
            effects.ground_tilt_loss = of.aero.tilt_loss.ground;
            effects.ceiling_tilt_loss = of.aero.tilt_loss.ceiling;
        }
    }
}

FlownVehicle::FlownVehicle(const Setting& setting, const FlightConditions& conditions)
    : world_(conditions.world.value_or(World{})),
      effects_(conditions.aero && setting.problem.aero.enabled ? &setting.effects : nullptr),
      vehicle_(vehicle_in(world_, setting.problem.robot)),
      surroundings_(effects_, world_),
      nominal_surroundings_(effects_, nominal_),
      plant_(vehicle_, surroundings_),
      begin_(begin(setting, conditions.world && is_at_rest(setting.problem.start))),
      loop_(setting.law, nominal_surroundings_, plant_, world_, setting.problem.robot, begin_.state, begin_.memory),
      umpire_(setting.problem, effects_, setting.obstacles, world_, flight_) {
    if (!begin_.is_stable) {
        flight_.outcome = Outcome::unstable;
    }
}

FlownVehicle::Begin FlownVehicle::begin(const Setting& setting, bool hovers) const {
    const Start& start = setting.problem.start;
    Begin begin{start_of(start, setting.law, vehicle_), {}, true};
    begin.memory = start.controller_memory.empty() ? setting.law.memory_at_start(motion_of(start))
                                                   : setting.law.memory_of(start.controller_memory);
    if (!hovers) {
        return begin;
    }
    const World quiet = without_noise(world_);
    const ReferencePoint here = at_rest(start.at);
    Loop hover(setting.law, nominal_surroundings_, plant_, quiet, setting.problem.robot, begin.state, begin.memory);
    const std::int64_t ticks = std::llround(hover_before_start_s / setting.law.tick_s());
    for (std::int64_t tick = 0; tick < ticks; ++tick) {
        hover.next(tick, here);
        if (!is_stable(hover.motion(), here)) {
            begin.is_stable = false;
            return begin;
        }
    }
    begin.state = hover.state();
    begin.state.energy_j = 0;
    begin.memory = hover.memory();
    return begin;
}

}  // namespace downwash::judge
