#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/base/export.hpp"
#include "downwash/scene/collision_checker.hpp"
#include "downwash/simulation/goal.hpp"
#include "downwash/simulation/robot.hpp"
#include "downwash/simulation/tick_model.hpp"
#include "downwash/simulation/vehicle_state.hpp"
#include "downwash/simulation/world.hpp"

namespace downwash {

/// A robot in its world: everything that a flight needs and never changes. Safe to share between threads.
class DOWNWASH_EXPORT FlightModel {
 public:
    /// @pre robot_errors(robot) is empty
    FlightModel(const Robot& robot, const PlaneOfMotion& plane, std::shared_ptr<const Scene> scene,
                const AeroSettings& aero);

    [[nodiscard]] const Robot& robot() const noexcept { return robot_; }
    [[nodiscard]] const PlaneOfMotion& plane() const noexcept { return plane_; }
    [[nodiscard]] const simulation::TickModel& tick() const noexcept { return tick_; }
    /// The world in which everything is as believed.
    [[nodiscard]] const FlownWorld& nominal_world() const noexcept { return nominal_world_; }
    /// Whether the plain tick is that of the nominal world: there is no drag, and the controller sees the state at
    /// once.
    [[nodiscard]] bool flies_plainly() const noexcept {
        return robot_.controller.delay_s == 0 && !tick_.plant.has_drag;
    }
    [[nodiscard]] const CollisionChecker& collisions() const noexcept { return collisions_; }
    /// The surface effect on rotor i, or on tick().plant.body(), or that of walls() (see rotor_wrench).
    [[nodiscard]] const DirectEffect& effect(int rotor) const noexcept { return *layers_[rotor_layer_[rotor]].effect; }
    /// The effect with its place beside the plane, as a map stores it.
    [[nodiscard]] const MapLayer& layer(int rotor) const noexcept { return layers_[rotor_layer_[rotor]]; }
    /// Distance of rotor i, or of the body, to the left of the plane [m].
    [[nodiscard]] double rotor_lateral_m(int rotor) const noexcept { return layers_[rotor_layer_[rotor]].lateral_m; }
    /// Number of its layer in the aero map, from 0.
    [[nodiscard]] std::size_t rotor_layer(int rotor) const noexcept { return rotor_layer_[rotor]; }
    [[nodiscard]] const Scene& scene() const noexcept { return *scene_; }
    /// Whether surfaces act on the rotors at all.
    [[nodiscard]] bool has_effects() const noexcept { return layers_.front().effect->settings().enabled; }
    /// K of a level rotor, evaluated exactly at a hub in plane coordinates.
    [[nodiscard]] double direct_factor(int rotor, double x_m, double z_m) const {
        return effect(rotor).factor(plane_.to_world(x_m, rotor_lateral_m(rotor), z_m));
    }
    /// The same by side.
    [[nodiscard]] SidedFactor<double> sided_factor(int rotor, double x_m, double z_m) const {
        return effect(rotor).sided_factor(plane_.to_world(x_m, rotor_lateral_m(rotor), z_m));
    }

    /// The map over every rotor position that a vehicle within the bounds can reach, at any pitch.
    /// @param on_progress,is_over see AeroMap   @param cache folder in which maps are kept between runs; empty: nowhere
    [[nodiscard]] std::shared_ptr<const AeroMap> make_map(const Bounds& bounds, int threads = 1,
                                                          const std::function<void(double)>& on_progress = {},
                                                          const std::filesystem::path& cache = {},
                                                          const StopCondition& is_over = {}) const;

    /// The same from that of a scene of which parts have changed; see AeroMap::rebuilt().
    /// @param before map of the same robot, model and bounds   @param changed boxes around the parts, before and after
    [[nodiscard]] std::shared_ptr<const AeroMap> remake_map(const AeroMap& before,
                                                            const std::vector<Scene::Bounds>& changed, int threads = 1,
                                                            const StopCondition& is_over = {}) const;

    /// Whether a map is the one that make_map() makes for these bounds.
    [[nodiscard]] bool is_mine(const AeroMap& map, const Bounds& bounds) const;

    /// The vehicle at a pose with the speeds u of its coordinates [m/s, m/s, rad/s, rad/s], controller rested, no
    /// energy spent.
    [[nodiscard]] FlightState state_at(const PlanarPose& pose, const double (&u)[4] = {0, 0, 0, 0}) const noexcept;

 private:
    Robot robot_;
    PlaneOfMotion plane_;
    std::shared_ptr<const Scene> scene_;
    simulation::TickModel tick_;
    FlownWorld nominal_world_;
    CollisionChecker collisions_;
    std::vector<MapLayer> layers_;
    std::size_t rotor_layer_[max_rotors + 2] = {};
};

/// The world of a flight.
struct FlightWorld {
    const FlownWorld* world = nullptr;  ///< nullptr: the nominal one
    std::int64_t first_tick = 0;        ///< control tick, from the start of the whole flight, with which it begins
};

/// The world in which to fly tick by tick; nullptr where that is the nominal one and the plain tick does.
[[nodiscard]] inline const FlownWorld* flown_world(const FlightModel& model, const FlownWorld* world) noexcept {
    return world != nullptr || model.flies_plainly() ? world : &model.nominal_world();
}

/// A pose as the obstacles of a world see it.
[[nodiscard]] inline PlanarPose among_obstacles(PlanarPose pose, const FlownWorld* world) noexcept {
    if (world != nullptr) {
        pose.x_m -= world->world.scene_x_m;
        pose.z_m -= world->world.scene_z_m;
    }
    return pose;
}

/// Every rotor position that a vehicle within the bounds can reach, at any pitch.
[[nodiscard]] DOWNWASH_EXPORT Bounds rotor_extent(const RotorParameters& rotors, const Bounds& bounds);

/// The distinct combinations of lateral offset and surface effect among the rotors of a vehicle, of its body where the
/// ground model has a fountain, and of walls where they act.
struct EffectLayers {
    std::vector<MapLayer> layers;
    std::vector<std::size_t> layer_of;  ///< of every rotor; then of the body (0 without a fountain); then of walls
};
/// Those of a vehicle in a scene; rotors that share offset and effect share a layer.
/// @param heading_rad of the plane of motion, for the models that see a rotor's neighbours, and for walls
[[nodiscard]] DOWNWASH_EXPORT EffectLayers effect_layers(const RotorParameters& rotors,
                                                         const std::shared_ptr<const Scene>& scene,
                                                         const AeroSettings& aero, double heading_rad = 0);

/// The pose whose collisions a state stands for.
[[nodiscard]] inline PlanarPose pose_of(const FlightState& state) noexcept {
    return pose_of(state.plant.q);
}

}  // namespace downwash
