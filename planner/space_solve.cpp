#include "downwash/planner/space_solve.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "downwash/aeromap/volume_map.hpp"
#include "downwash/base/text.hpp"
#include "downwash/planner/any_order.hpp"
#include "downwash/planner/family_parts.hpp"
#include "downwash/planner/goals_in_order.hpp"
#include "downwash/planner/planner_model.hpp"
#include "downwash/planner/space_worlds.hpp"
#include "downwash/planner/stopwatch.hpp"
#include "downwash/problems/visit_order.hpp"

namespace downwash {
namespace {

using planning::Space;

/// Where hubs get while the vehicle is within its bounds.
struct HubSpace {
    Bounds extent;
    double y_low_m, y_high_m;
};

HubSpace hub_space(const SpaceProblem& problem) {
    double reach_m = 0;  // of hubs, from the multirotor's centre of mass
    for (const SpaceRotor& rotor : problem.robot.plant.rotors) {
        reach_m = std::max(reach_m, std::sqrt(dot(rotor.position_m, rotor.position_m)));
    }
    const Vector3& low_m = problem.bounds.low_m;
    const Vector3& high_m = problem.bounds.high_m;
    return {{low_m[0] - reach_m, high_m[0] + reach_m, low_m[2] - reach_m, high_m[2] + reach_m},
            low_m[1] - reach_m,
            high_m[1] + reach_m};
}

bool certifies(const SpaceProblem& problem) {
    return problem.uncertainty && problem.planner.certify;
}

/// Whether flights of a search, of its certificates or of stops are among surfaces.
bool needs_volumes(const SpaceProblem& problem, bool finds_stops) {
    if (problem.planner.variant == Variant::mp_arm_ada) {
        return problem.aero.enabled;
    }
    return has_surface_effects(problem) && (certifies(problem) || finds_stops);
}

}  // namespace

bool has_surface_effects(const SpaceProblem& problem) {
    const AeroSettings& aero = problem.aero;
    return aero.enabled && (aero.ground.model != EffectModel::none || aero.ceiling.model != EffectModel::none ||
                            aero.wall.is_any() || aero.map);
}

std::shared_ptr<const SurfaceVolumes> make_volumes(const SpaceProblemModel& model, const std::filesystem::path& cache) {
    const SpaceProblem& problem = model.problem();
    const HubSpace hubs = hub_space(problem);
    const auto volumes = std::make_shared<SurfaceVolumes>(model.shared_scene(), problem.aero, problem.robot,
                                                          PlaneOfMotion{}, hubs.extent, hubs.y_low_m, hubs.y_high_m);
    volumes->read(cache);
    return volumes;
}

std::vector<KeyError> space_planning_errors(const SpaceProblem& problem) {
    std::vector<KeyError> errors;
    const PlannerSettings& planner = problem.planner;
    if (planner.algorithm != "rrt-star" && problem.motion.yaw.mode != YawMode::free) {
        errors.push_back({"motion.yaw", "is a rule that '" + planner.algorithm + "' does not keep: expected free"});
    }
    if (const auto share = planner.parameters.find("passage_share");
        share != planner.parameters.end() && share->second > 0) {
        errors.push_back({"planner.parameters.passage_share",
                          "is above 0, and narrow passages are not looked for in space yet: expected 0"});
    }
    const HubSpace hubs = hub_space(problem);
    const double radius_m = problem.robot.rotor_radius_m;
    if (needs_volumes(problem, true) && !VolumeMap::fits(hubs.extent, hubs.y_low_m, hubs.y_high_m, radius_m)) {
        const auto volume_m3 = static_cast<std::int64_t>(VolumeMap::largest_m3(radius_m));
        errors.push_back({"environment.bounds", "are too large for maps of surface effects on rotors of " +
                                                    to_text(radius_m, 4) + " m: expected at most some " +
                                                    std::to_string(volume_m3) + " m3"});
    }
    return errors;
}

SpaceSearchResult solve(const std::shared_ptr<const SpaceProblemModel>& model, const SpaceSolveOptions& asked) {
    const planning::Stopwatch since_call;
    const SpaceProblem& problem = model->problem();
    SpaceSolveOptions options = asked;
    options.threads = std::max(1, options.threads);
    SpaceSearchResult result;
    result.seed = problem.planner.seed;
    const planning::Stopwatch map_clock;
    std::shared_ptr<const SurfaceVolumes> volumes;
    if (needs_volumes(problem, options.finds_stops)) {
        volumes = options.map ? options.map : make_volumes(*model, options.map_cache);
    }
    result.planning.map_wall_s = volumes ? map_clock.seconds() : 0;
    const double map_wall_s = result.planning.map_wall_s;
    const double setup_wall_s = since_call.seconds();
    try {
        const planning::PlannerModelOf<Space> own(problem.planner.variant, model, volumes);
        planning::SearchResultOf<Space> found = targets_of(problem).empty()
                                                    ? planning::search_in_order(problem, own, options)
                                                    : planning::search_in_any_order(problem, own, options);
        static_cast<FoundOf<Space>&>(result) = std::move(found.found);
        result.planning = std::move(found.record);
        result.planning.setup_wall_s = setup_wall_s;
        result.planning.map_wall_s = map_wall_s;
        if (result.plan && !(result.execution && result.status == Status::solved)) {
            planning::DirectFlightOf<Space> flight = planning::fly_directly(
                *model, start_state(*model, problem.start), *result.plan, goals_of(in_order(problem, result.order)),
                problem.energy_budget_j, planning::end_of_last_flight(options.stop));
            result.execution = std::move(flight.execution);
            result.flight_wall_s = flight.wall_s;
        }
    } catch (const WorkStopped&) {  // there is what was found before
    }
    if (volumes && !options.map) {
        volumes->keep(options.map_cache);
    }
    result.map = volumes;
    result.interrupted = options.stop.stop_requested();
    return result;
}

std::vector<WorldSample> fly_in_worlds(const std::shared_ptr<const SpaceProblemModel>& model,
                                       const std::shared_ptr<const SurfaceVolumes>& volumes, const SpacePlan& plan,
                                       std::span<const SpaceWorld> worlds, const StopCondition& is_over, int threads) {
    const SpaceProblem& problem = model->problem();
    const planning::PlannerModelOf<Space> own(problem.planner.variant, model, volumes);
    return planning::SpaceProblemWorlds(problem, own, threads).fly(plan, worlds, is_over);
}

}  // namespace downwash
