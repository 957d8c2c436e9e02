#pragma once

#include <optional>
#include <vector>

#include "downwash/judge/space_bodies.hpp"
#include "downwash/judge/space_surroundings.hpp"

// The plant in space over time, integrated by Boost.Odeint. Private: not installed.

namespace downwash::judge {

/// What is held over one control tick: free-air thrust of each rotor, and the torque of each joint.
struct SpaceCommands {
    std::vector<double> thrust_n;
    Eigen::VectorXd joints_nm;
};

/// The state of the plant.
struct SpacePlantState {
    BodyMotions bodies;
    std::vector<double> thrust_n;  ///< free-air thrust that the rotors' lag has reached
    double energy_j = 0;           ///< spent by rotors and joints
    double contact_n = 0;          ///< mean normal force of a surface over the last tick
};

class SpaceTouchSurface;

/// A vehicle among surfaces in moving air.
class SpacePlant {
 public:
    /// @param vehicle,surroundings outlive this   @param plane see Linkage   @param surface that the vehicle may touch
    SpacePlant(const SpaceVehicle& vehicle, const SpaceSurroundings& surroundings, std::optional<HeldPlane> plane = {},
               const SpaceTouchSurface* surface = nullptr)
        : vehicle_(vehicle), surroundings_(surroundings), linkage_(vehicle, std::move(plane)), surface_(surface) {}

    [[nodiscard]] const SpaceVehicle& vehicle() const noexcept { return vehicle_; }
    [[nodiscard]] const Linkage& linkage() const noexcept { return linkage_; }

    /// Six accelerations of each body, world axes.
    /// @param thrust_n free-air thrusts at the nominal coefficient   @param wind_m_s of the air, world
    /// @param[out] contact_n normal force of the surface; nullptr: not asked for
    [[nodiscard]] DOWNWASH_EXPORT Eigen::VectorXd accelerations(const BodyMotions& bodies,
                                                                const std::vector<double>& thrust_n,
                                                                const Eigen::VectorXd& joints_nm,
                                                                const Eigen::Vector3d& wind_m_s,
                                                                double* contact_n = nullptr) const;

    /// The state after `duration_s` with the commands held and a steady wind: Dormand and Prince's method of fifth
    /// order with steps controlled to 1e-9 (relative and absolute, SI units), restarted here. Constraints are mended at
    /// the end.
    [[nodiscard]] DOWNWASH_EXPORT SpacePlantState after(const SpacePlantState& state, const SpaceCommands& commands,
                                                        const Eigen::Vector3d& wind_m_s, double duration_s) const;

    /// Power of rotors with these free-air thrusts [W] (docs/model.md 3).
    [[nodiscard]] DOWNWASH_EXPORT double rotor_power_w(const std::vector<double>& thrust_n) const;

 private:
    const SpaceVehicle& vehicle_;
    const SpaceSurroundings& surroundings_;
    Linkage linkage_;
    const SpaceTouchSurface* surface_;
};

}  // namespace downwash::judge
