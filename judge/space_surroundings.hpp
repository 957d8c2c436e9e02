#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>

#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/simulation/space_world_description.hpp"

// What surfaces do to rotors in space in a world (docs/model.md 4 and 9), evaluated directly. Private: not installed.

namespace downwash::judge {

/// A place of the world as obstacles in their nominal places see it.
[[nodiscard]] inline Eigen::Vector3d nominal_place(const SpaceWorld& world, const Eigen::Vector3d& at_m) {
    const double c = std::cos(world.scene_yaw_rad);
    const double s = std::sin(world.scene_yaw_rad);
    Eigen::Matrix3d turn;
    turn << c, -s, 0, s, c, 0, 0, 0, 1;
    return turn.transpose() * (at_m - Eigen::Vector3d(world.scene_m[0], world.scene_m[1], world.scene_m[2]));
}

/// The effects of surfaces in one world. Safe to share between threads.
class SpaceSurroundings {
 public:
    /// @param effect nullptr: free air
    SpaceSurroundings(std::shared_ptr<const DirectEffect> effect, const SpaceWorld& world)
        : effect_(std::move(effect)), world_(world) {}

    /// K of a rotor. @param axis of its thrust, of length 1, in the world
    [[nodiscard]] double thrust_ratio(const Eigen::Vector3d& hub_m, const Eigen::Vector3d& axis) const {
        if (effect_ == nullptr) {
            return 1;
        }
        const Eigen::Vector3d at = nominal_place(world_, hub_m);
        const auto level = effect_->sided_factor({at.x(), at.y(), at.z()});
        const AeroSettings& aero = effect_->settings();
        const TiltLoss loss = aero.map ? TiltLoss{} : aero.tilt_loss;  // a given map is taken as it is
        const double below = faded(level.all - level.above, loss.ground, axis);
        const double above = faded(level.above - 1, loss.ceiling, axis);
        return 1 + (1 + world_.ground_scale) * below + (1 + world_.ceiling_scale) * above;
    }

    /// Whether a given map, if there is one, says that a rotor may be there.
    [[nodiscard]] bool is_given_map_flyable(const Eigen::Vector3d& hub_m) const {
        const Eigen::Vector3d at = nominal_place(world_, hub_m);
        return effect_ == nullptr || !effect_->settings().map || effect_->is_flyable({at.x(), at.y(), at.z()});
    }

    [[nodiscard]] const DirectEffect* effect() const noexcept { return effect_.get(); }

 private:
    /// K - 1 of a tilted rotor: half of the level one's where that is loss sin^2 of the tilt.
    [[nodiscard]] static double faded(double change, double loss, const Eigen::Vector3d& axis) {
        const double half = loss * axis.head<2>().squaredNorm();
        return half == 0 ? change : change / (1 + half / std::abs(change));
    }

    std::shared_ptr<const DirectEffect> effect_;
    SpaceWorld world_;
};

}  // namespace downwash::judge
