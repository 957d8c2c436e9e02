#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

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

/// The distinct combinations of lateral offset and surface effect among the rotors of a vehicle, of its body where the
/// ground model has a fountain, and of walls where they act.
struct EffectLayers {
    std::vector<MapLayer> layers;
    std::vector<std::size_t> of_rotor;    ///< number of every rotor's layer
    std::optional<std::size_t> of_body;   ///< empty without a fountain
    std::optional<std::size_t> of_walls;  ///< empty without walls
};
/// The layers of a vehicle in a scene. Rotors that share offset and effect share a layer.
/// @param heading_rad of the plane of motion, for the models that see a rotor's neighbours, and for walls
[[nodiscard]] DOWNWASH_EXPORT EffectLayers effect_layers(const RotorParameters& rotors,
                                                         const std::shared_ptr<const Scene>& scene,
                                                         const AeroSettings& aero, double heading_rad = 0);

/// A robot in its world: everything that a flight needs and never changes. Safe to share between threads.
class DOWNWASH_EXPORT FlightModel {
 public:
    /// @param checker who answers collisions()   @pre robot_errors(robot) is empty
    FlightModel(const Robot& robot, const PlaneOfMotion& plane, std::shared_ptr<const Scene> scene,
                const AeroSettings& aero, CollisionCheckerKind checker = CollisionCheckerKind::own);

    [[nodiscard]] const Robot& robot() const noexcept { return robot_; }
    [[nodiscard]] const PlaneOfMotion& plane() const noexcept { return plane_; }
    [[nodiscard]] const simulation::TickModel& tick() const noexcept { return tick_; }
    /// The world in which everything is nominal.
    [[nodiscard]] const FlownWorld& nominal_world() const noexcept { return nominal_world_; }
    /// Whether the plain tick is that of the nominal world: there is no drag, and the controller sees the state at
    /// once.
    [[nodiscard]] bool flies_plainly() const noexcept {
        return robot_.controller.delay_s == 0 && !tick_.plant.has_drag;
    }
    /// Collisions and clearances in everything but what executed_clearance_m() says.
    [[nodiscard]] const CollisionChecker& collisions() const noexcept { return collisions_; }
    /// The clearance in an executed flight [m]: that of collisions(), but FCL decides whether there is contact.
    [[nodiscard]] double executed_clearance_m(const PlanarPose& pose) const;
    /// The layers of surface effects: those that a map of this model has.
    [[nodiscard]] const std::vector<MapLayer>& layers() const noexcept { return layers_.layers; }
    /// Number of the layer of rotor i.
    [[nodiscard]] std::size_t rotor_layer(int rotor) const noexcept {
        return layers_.of_rotor[static_cast<std::size_t>(rotor)];
    }
    /// Number of the layer of the body. @pre tick().plant.has_fountain
    [[nodiscard]] std::size_t body_layer() const noexcept { return *layers_.of_body; }
    /// Number of the layer of walls, which is 1 more than how near they are. @pre tick().plant.has_walls
    [[nodiscard]] std::size_t wall_layer() const noexcept { return *layers_.of_walls; }
    /// The surface effect on rotor i with its place beside the plane, as a map stores it.
    [[nodiscard]] const MapLayer& layer(int rotor) const noexcept { return layers()[rotor_layer(rotor)]; }
    [[nodiscard]] const DirectEffect& effect(int rotor) const noexcept { return *layer(rotor).effect; }
    /// Distance of rotor i to the left of the plane [m].
    [[nodiscard]] double rotor_lateral_m(int rotor) const noexcept { return layer(rotor).lateral_m; }
    [[nodiscard]] const Scene& scene() const noexcept { return *scene_; }
    /// Whether surfaces act on the rotors at all.
    [[nodiscard]] bool has_effects() const noexcept { return layers().front().effect->settings().enabled; }
    /// K by side in a layer, of a level vehicle, evaluated exactly at a point in plane coordinates.
    [[nodiscard]] SidedFactor<double> factor_in_layer(std::size_t layer, double x_m, double z_m) const {
        return layers()[layer].effect->sided_factor(plane_.to_world(x_m, layers()[layer].lateral_m, z_m));
    }
    /// K by side of level rotor i with its hub there.
    [[nodiscard]] SidedFactor<double> sided_factor(int rotor, double x_m, double z_m) const {
        return factor_in_layer(rotor_layer(rotor), x_m, z_m);
    }
    /// K of level rotor i with its hub there.
    [[nodiscard]] double direct_factor(int rotor, double x_m, double z_m) const {
        return sided_factor(rotor, x_m, z_m).all;
    }

    /// The map over every rotor position that a vehicle within the bounds can reach, at any pitch. It fills where
    /// flights ask.
    /// @param cache folder in which maps are kept between runs; empty: nowhere
    [[nodiscard]] std::shared_ptr<const AeroMap> make_map(const Bounds& bounds,
                                                          const std::filesystem::path& cache = {}) const;

    /// The same, filled as a whole and kept in the cache: for measurements that no filling may disturb.
    /// @param threads,on_progress,is_over see AeroMap::fill()
    [[nodiscard]] std::shared_ptr<const AeroMap> make_whole_map(const Bounds& bounds, int threads = 1,
                                                                const std::function<void(double)>& on_progress = {},
                                                                const std::filesystem::path& cache = {},
                                                                const StopCondition& is_over = {}) const;

    /// The map of this scene from that of the scene before parts of it changed; see AeroMap::rebuilt().
    /// @param before map of the same robot, model and bounds   @param changed boxes around the parts, before and after
    [[nodiscard]] std::shared_ptr<const AeroMap> remake_map(const AeroMap& before,
                                                            const std::vector<BoundingBox>& changed) const;

    /// Whether a map is the one that make_map() makes for these bounds.
    [[nodiscard]] bool matches(const AeroMap& map, const Bounds& bounds) const;

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
    CollisionChecker contacts_;  ///< FCL's
    EffectLayers layers_;
};

/// The world of a flight.
struct FlightWorld {
    const FlownWorld* world = nullptr;  ///< nullptr: the nominal one
    std::int64_t first_tick = 0;        ///< control tick, from the start of the whole flight, with which it begins
};

/// The world to fly in tick by tick; nullptr if the plain tick suffices.
[[nodiscard]] inline const FlownWorld* flown_world(const FlightModel& model, const FlownWorld* world) noexcept {
    return world != nullptr || model.flies_plainly() ? world : &model.nominal_world();
}

/// A pose as the obstacles of a world see it.
[[nodiscard]] inline PlanarPose among_obstacles(PlanarPose pose, const FlownWorld* world) noexcept {
    if (world != nullptr) {
        pose.x_m -= world->world.scene_x_m;
        pose.z_m -= world->world.scene_z_m;
        pose.lateral_m += world->lateral_m;
    }
    return pose;
}

/// Every rotor position that a vehicle within the bounds can reach, at any pitch.
[[nodiscard]] DOWNWASH_EXPORT Bounds rotor_extent(const RotorParameters& rotors, const Bounds& bounds);

/// The pose of a state, for collision checks.
[[nodiscard]] inline PlanarPose pose_of(const FlightState& state) noexcept {
    return pose_of(state.plant.q);
}

}  // namespace downwash
