#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "downwash/judge/space_surfaces.hpp"
#include "downwash/simulation/space_world_description.hpp"

// What surfaces do to a vehicle in space in a world (docs/model.md 4 and 9). Private: not installed.

namespace downwash::judge {

/// How a world turns its obstacles.
[[nodiscard]] inline Eigen::Matrix3d scene_turn(const SpaceWorld& world) {
    const double c = std::cos(world.scene_yaw_rad);
    const double s = std::sin(world.scene_yaw_rad);
    Eigen::Matrix3d turn;
    turn << c, -s, 0, s, c, 0, 0, 0, 1;
    return turn;
}

/// A place of the world as obstacles in their nominal places see it.
[[nodiscard]] inline Eigen::Vector3d nominal_place(const SpaceWorld& world, const Eigen::Vector3d& at_m) {
    return scene_turn(world).transpose() *
           (at_m - Eigen::Vector3d(world.scene_m[0], world.scene_m[1], world.scene_m[2]));
}

/// The effects of surfaces on a vehicle in one world. Safe to share between threads.
class SpaceSurroundings {
 public:
    /// @param surfaces nullptr: free air; they outlive this
    SpaceSurroundings(const SpaceSurfaces* surfaces, const SpaceWorld& world) : surfaces_(surfaces), world_(world) {}

    /// K of all rotors. @param hubs_m,axes of them, the axes of their thrusts of length 1, in the world
    [[nodiscard]] std::vector<double> thrust_ratios(const std::vector<Eigen::Vector3d>& hubs_m,
                                                    const std::vector<Eigen::Vector3d>& axes) const {
        std::vector<double> ratios(hubs_m.size(), 1);
        if (surfaces_ == nullptr) {
            return ratios;
        }
        const auto level = surfaces_->at_rotors(nominal_places(hubs_m));
        for (std::size_t i = 0; i < ratios.size(); ++i) {
            const double below = faded(level[i].all - level[i].above, loss().ground, axes[i]);
            const double above = faded(level[i].above - 1, loss().ceiling, axes[i]);
            ratios[i] += (1 + world_.ground_scale) * below + (1 + world_.ceiling_scale) * above;
        }
        return ratios;
    }

    /// K_body - 1: what a fountain adds to the thrust of all rotors. @param axis their mean, of length 1
    [[nodiscard]] double fountain(const std::vector<Eigen::Vector3d>& hubs_m, const Eigen::Vector3d& axis) const {
        return surfaces_ == nullptr ? 0
                                    : (1 + world_.ground_scale) *
                                          faded(surfaces_->fountain(nominal_places(hubs_m)), loss().ground, axis);
    }

    /// What walls do to the vehicle, world axes; the force acts at the multirotor's centre of mass.
    struct WallLoad {
        Eigen::Vector3d force_n = Eigen::Vector3d::Zero(), torque_nm = Eigen::Vector3d::Zero();
    };
    /// @param center_m between the rotors   @param thrust_n of all rotors in free air
    [[nodiscard]] WallLoad walls(const Eigen::Vector3d& center_m, double thrust_n) const {
        if (surfaces_ == nullptr) {
            return {};
        }
        const WallEffect& wall = surfaces_->settings().wall;
        const Eigen::Vector3d acting_n =
            thrust_n * (scene_turn(world_) * surfaces_->towards_wall(nominal_place(world_, center_m)));
        return {-wall.force * acting_n,
                wall.moment * surfaces_->rotor_radius_m() * Eigen::Vector3d::UnitZ().cross(acting_n)};
    }

    /// Whether a given map, if there is one, says that a rotor may be there.
    [[nodiscard]] bool is_given_map_flyable(const Eigen::Vector3d& hub_m) const {
        return surfaces_ == nullptr || surfaces_->is_given_map_flyable(nominal_place(world_, hub_m));
    }

    /// nullptr: free air.
    [[nodiscard]] const SpaceSurfaces* surfaces() const noexcept { return surfaces_; }

 private:
    [[nodiscard]] std::vector<Eigen::Vector3d> nominal_places(std::vector<Eigen::Vector3d> at_m) const {
        for (Eigen::Vector3d& place_m : at_m) {
            place_m = nominal_place(world_, place_m);
        }
        return at_m;
    }
    [[nodiscard]] TiltLoss loss() const {
        const AeroSettings& aero = surfaces_->settings();
        return aero.map ? TiltLoss{} : aero.tilt_loss;  // a given map is taken as it is
    }
    /// K - 1 of a tilted rotor: half of the level one's where that is loss sin^2 of the tilt.
    [[nodiscard]] static double faded(double change, double loss, const Eigen::Vector3d& axis) {
        const double half = loss * axis.head<2>().squaredNorm();
        return half == 0 ? change : change / (1 + half / std::abs(change));
    }

    const SpaceSurfaces* surfaces_;
    SpaceWorld world_;
};

}  // namespace downwash::judge
