#pragma once

#include <memory>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/base/export.hpp"
#include "downwash/scene/collision_checker.hpp"
#include "downwash/simulation/closed_loop.hpp"
#include "downwash/simulation/goal.hpp"
#include "downwash/simulation/robot.hpp"

namespace downwash {

/// The state of a flight, one lane wide.
using FlightState = simulation::State<double>;

/// A robot in its world: everything that a flight needs and never changes. Safe to share between threads.
class DOWNWASH_EXPORT FlightModel {
 public:
    /// @pre robot_faults(robot) is empty
    FlightModel(const Robot& robot, const PlaneOfMotion& plane, std::shared_ptr<const Scene> scene,
                const AeroSettings& aero);

    [[nodiscard]] const Robot& robot() const noexcept { return robot_; }
    [[nodiscard]] const PlaneOfMotion& plane() const noexcept { return plane_; }
    [[nodiscard]] const simulation::TickModel& tick() const noexcept { return tick_; }
    [[nodiscard]] const CollisionChecker& collisions() const noexcept { return collisions_; }
    [[nodiscard]] const DirectEffect& direct() const noexcept { return *direct_; }

    /// Distance of rotor i to the left of the plane [m], and its layer in the aero map.
    [[nodiscard]] double rotor_lateral_m(int rotor) const noexcept { return rotor_lateral_m_[rotor]; }
    [[nodiscard]] std::size_t rotor_layer(int rotor) const noexcept { return rotor_layer_[rotor]; }

    /// The map over every rotor position that a vehicle within the bounds can reach, at any pitch.
    [[nodiscard]] std::shared_ptr<const AeroMap> make_map(const Bounds& bounds, int threads = 1) const;

    /// The vehicle at q = (x, z, pitch, arm) [m, m, rad, rad] with speeds u, controller rested, no energy spent.
    [[nodiscard]] FlightState state_at(const double q[4], const double u[4]) const noexcept;

 private:
    Robot robot_;
    PlaneOfMotion plane_;
    simulation::TickModel tick_;
    CollisionChecker collisions_;
    std::shared_ptr<const DirectEffect> direct_;
    std::vector<double> lateral_offsets_m_;
    double rotor_lateral_m_[max_rotors] = {};
    std::size_t rotor_layer_[max_rotors] = {};
};

/// Every rotor position that a vehicle within the bounds can reach, at any pitch.
[[nodiscard]] DOWNWASH_EXPORT MapExtent rotor_extent(const RotorParameters& rotors, const Bounds& bounds);

/// The distinct distances of rotors to the left of the plane [m], in the order of the rotors.
[[nodiscard]] DOWNWASH_EXPORT std::vector<double> lateral_offsets_m(const RotorParameters& rotors);

/// The pose whose collisions a state stands for.
[[nodiscard]] inline PlanarPose pose_of(const FlightState& state) noexcept {
    return {state.plant.q[0], state.plant.q[1], state.plant.q[2], state.plant.q[3]};
}

}  // namespace downwash
