#include "downwash/simulation/flight_model.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "downwash/aeromap/map_cache.hpp"
#include "downwash/controllers/control.hpp"

namespace downwash {
namespace {

bool has_fountain(const AeroSettings& aero) {
    return aero.enabled && !aero.map && aero.ground.model == EffectModel::multirotor_body;
}

bool has_walls(const AeroSettings& aero) {
    return aero.enabled && aero.wall.is_any();
}

bool sees_neighbours(const AeroSettings& aero) {
    return is_multirotor(aero.ground.model) || is_multirotor(aero.ceiling.model);
}

}  // namespace

FlightModel::FlightModel(const Robot& robot, const PlaneOfMotion& plane, std::shared_ptr<const Scene> scene,
                         const AeroSettings& aero, CollisionCheckerKind checker)
    : robot_(robot),
      plane_(plane),
      scene_(scene),
      tick_{make_plant_model(robot.multirotor, robot.arm, robot.rotors, has_fountain(aero)),
            controllers::flown_law(robot.controller.law), 1 / robot.controller.rate_hz,
            aero.map ? TiltLoss{} : aero.tilt_loss, slipstreams_of(robot.arm, robot.rotors)},
      nominal_world_(make_world(robot, {})),
      collisions_(scene, plane, robot.shape(), checker),
      contacts_(checker == CollisionCheckerKind::fcl
                    ? collisions_
                    : CollisionChecker(scene, plane, robot.shape(), CollisionCheckerKind::fcl)) {
    if (has_walls(aero)) {
        tick_.plant.has_walls = true;
        tick_.plant.wall_force = aero.wall.force;
        tick_.plant.wall_moment_m = aero.wall.moment * robot.rotors.radius_m;
    }
    layers_ = effect_layers(robot.rotors, scene, aero, plane.heading_rad());
}

double FlightModel::executed_clearance_m(const PlanarPose& pose) const {
    constexpr double least_apart_m = 1e-8;  // solids that are less apart are in contact
    const double clearance_m = collisions_.clearance_m(pose);
    if (collisions_.kind() == CollisionCheckerKind::fcl) {
        return clearance_m;
    }
    if (contacts_.is_nearer_than(pose, 0)) {
        return std::min(clearance_m, 0.0);
    }
    return clearance_m > 0 ? clearance_m : least_apart_m;
}

std::shared_ptr<const AeroMap> FlightModel::make_map(const Bounds& bounds, const std::filesystem::path& cache) const {
    return cached_map(cache, layers(), plane_, rotor_extent(robot_.rotors, bounds));
}

std::shared_ptr<const AeroMap> FlightModel::make_whole_map(const Bounds& bounds, int threads,
                                                           const std::function<void(double)>& on_progress,
                                                           const std::filesystem::path& cache,
                                                           const StopCondition& is_over) const {
    auto map = make_map(bounds, cache);
    map->fill(threads, on_progress, is_over);
    keep_map(cache, *map);
    return map;
}

std::shared_ptr<const AeroMap> FlightModel::remake_map(const AeroMap& before,
                                                       const std::vector<BoundingBox>& changed) const {
    return std::make_shared<const AeroMap>(before.rebuilt(layers(), changed));
}

bool FlightModel::matches(const AeroMap& map, const Bounds& bounds) const {
    return map_key(map.layers(), map.plane(), map.extent()) ==
           map_key(layers(), plane_, rotor_extent(robot_.rotors, bounds));
}

Bounds rotor_extent(const RotorParameters& rotors, const Bounds& bounds) {
    double reach_m = 0;
    for (const Vector3& hub_m : rotors.positions_m) {
        reach_m = std::max(reach_m, std::sqrt(hub_m[0] * hub_m[0] + hub_m[2] * hub_m[2]));
    }
    return {bounds.x_low_m - reach_m, bounds.x_high_m + reach_m, bounds.z_low_m - reach_m, bounds.z_high_m + reach_m};
}

EffectLayers effect_layers(const RotorParameters& rotors, const std::shared_ptr<const Scene>& scene,
                           const AeroSettings& aero, double heading_rad) {
    const std::vector<Vector3>& hubs_m = rotors.positions_m;
    std::vector<std::pair<RotorNeighbours, std::shared_ptr<const DirectEffect>>> effects;
    EffectLayers all;
    const auto find_or_add = [&all](const std::shared_ptr<const DirectEffect>& effect, double lateral_m) {
        const auto found = std::find_if(all.layers.begin(), all.layers.end(), [&](const MapLayer& layer) {
            return layer.effect == effect && layer.lateral_m == lateral_m;
        });
        const auto number = static_cast<std::size_t>(found - all.layers.begin());
        if (found == all.layers.end()) {
            all.layers.push_back({effect, lateral_m});
        }
        return number;
    };
    for (std::size_t i = 0; i < hubs_m.size(); ++i) {
        const RotorNeighbours neighbours =
            sees_neighbours(aero) ? neighbours_of(hubs_m, i, rotors.radius_m, heading_rad) : RotorNeighbours{};
        auto known = std::find_if(effects.begin(), effects.end(), [&](const auto& e) { return e.first == neighbours; });
        if (known == effects.end()) {
            effects.emplace_back(neighbours,
                                 std::make_shared<const DirectEffect>(scene, aero, rotors.radius_m, neighbours));
            known = std::prev(effects.end());
        }
        all.of_rotor.push_back(find_or_add(known->second, hubs_m[i][1]));
    }
    Vector3 center_m{0, 0, 0};
    for (const Vector3& hub_m : hubs_m) {
        for (const std::size_t axis : {0U, 1U}) {
            center_m[axis] += hub_m[axis] / static_cast<double>(hubs_m.size());
        }
    }
    if (has_fountain(aero)) {
        all.of_body =
            find_or_add(std::make_shared<const DirectEffect>(DirectEffect::fountain(
                            scene, aero, rotors.radius_m, neighbours_of(hubs_m, 0, rotors.radius_m, heading_rad))),
                        center_m[1]);
    }
    if (has_walls(aero)) {
        double reach_m = 0;
        for (const Vector3& hub_m : hubs_m) {
            reach_m = std::max(reach_m, std::abs(hub_m[0] - center_m[0]));
        }
        all.of_walls = find_or_add(std::make_shared<const DirectEffect>(
                                       DirectEffect::walls(scene, aero, rotors.radius_m, reach_m, heading_rad)),
                                   center_m[1]);
    }
    return all;
}

FlightState FlightModel::state_at(const PlanarPose& pose, const double (&u)[4]) const noexcept {
    const double q[4] = {pose.x_m, pose.z_m, pose.pitch_rad, pose.arm_rad};
    FlightState state{};
    std::copy(q, q + 4, state.plant.q);
    std::copy(u, u + 4, state.plant.u);
    // Rotors that lag begin with the thrust that carries the weight.
    const PlantModel& plant = tick_.plant;
    for (int i = 0; i < plant.rotor_count; ++i) {
        state.plant.thrust_n[i] = plant.force_share[i] * plant.total_mass_kg * standard_gravity_m_s2;
    }
    state.memory = controllers::visit_flown(tick_.law, [&]<class Flown>(const Flown& law) {
        if constexpr (controllers::is_aided<Flown>) {
            return controllers::remembered(law.rested(plant, state.plant, tick_.tick_s));
        } else {
            return controllers::remembered(law.rested(plant, state.plant));
        }
    });
    state.world = memory_at_start(nominal_world_, state.plant);
    return state;
}

}  // namespace downwash
