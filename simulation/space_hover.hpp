#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "downwash/aeromap/aero_settings.hpp"
#include "downwash/base/export.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/simulation/hover_analysis.hpp"
#include "downwash/simulation/space_effect.hpp"
#include "downwash/simulation/space_hover_trim.hpp"
#include "downwash/simulation/stability_margins.hpp"

namespace downwash {

/// Name of a loop in files: "pitch", "joint_1". @param loop of space_loops
[[nodiscard]] DOWNWASH_EXPORT std::string space_loop_name(int loop);

/// How a small disturbance of a hover in space develops; see HoverStability.
struct SpaceHoverStability {
    double spectral_radius = 0;
    double growth_rate_1_s = 0;
    double frequency_rad_s = 0;
    int growing_modes = 0;
    /// Where the slowest decay, or fastest growth, shows most: one of space_loops, by metres along the world's x, y and
    /// z, and radians about the body's axes and of the joints.
    int slowest_loop = 0;

    double force_slope_n_m = 0;     ///< dF/dz at the trim commands; positive pulls away from the height that is held
    double force_gain_n_m = 0;      ///< what the height's gain sets against it: force in effect per metre of error
    double roll_slope_nm_rad = 0;   ///< torque about the body's x per radian of roll at the trim commands; positive
                                    ///< tips over
    double pitch_slope_nm_rad = 0;  ///< the same about the body's y
};

/// Whether and how a vehicle in space can hover at a point with its own controller.
struct SpaceHoverAnalysis {
    HoldVerdict verdict = HoldVerdict::not_flyable;
    SpaceHoverTrim trim;            ///< from no_equilibrium on
    SpaceHoverStability stability;  ///< from unstable on; for unknown, as if the model were complete
};

/// Hovers of a robot in space among surfaces. Linear theory, like analyse_hover(). Immutable.
class DOWNWASH_EXPORT SpaceHover {
 public:
    /// @throws InputError if the robot has more joints than this library was built for, or as DirectSpaceEffect does
    /// @pre space_robot_errors(robot) is empty; robot outlives this
    SpaceHover(const SpaceRobot& robot, std::shared_ptr<const Scene> scene, const AeroSettings& aero);
    ~SpaceHover();
    SpaceHover(const SpaceHover&) = delete;
    SpaceHover& operator=(const SpaceHover&) = delete;

    /// Surfaces evaluated directly, for one thread at a time.
    [[nodiscard]] std::unique_ptr<simulation::SpaceEffect> direct_effect() const;

    /// Whether the vehicle can hover there, level but for what leans it.
    /// @param place finite; where the vehicle itself should be (not its reference)   @param surfaces whose K counts
    [[nodiscard]] SpaceHoverAnalysis at(const SpacePoint& place, simulation::SpaceEffect& surfaces) const;
    /// The same with surfaces evaluated directly.
    [[nodiscard]] SpaceHoverAnalysis at(const SpacePoint& place) const { return at(place, *direct_effect()); }

 private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};

/// The margins of a vehicle in space that hovers in free air, and how fast a disturbance of it decays.
struct SpaceLoopMargins {
    std::vector<LoopMargins> loops;  ///< one for each of space_loops that it has
    SpaceHoverStability stability;
};

/// @param joints_rad one for each joint   @pre space_robot_errors(robot) is empty
/// @throws InputError when it cannot hover or is unstable there, or has too many joints
[[nodiscard]] DOWNWASH_EXPORT SpaceLoopMargins space_loop_margins(const SpaceRobot& robot,
                                                                  const std::vector<double>& joints_rad);

/// Poses of the arm in which margins tell the most: all joints as near to zero as their limits allow, the pose that
/// loads one rotor most, and the one with the centre of mass highest. Without an arm one without joints.
struct ExaminedPose {
    std::string name;  ///< "zero", "aside", "up"
    std::vector<double> joints_rad;
};
[[nodiscard]] DOWNWASH_EXPORT std::vector<ExaminedPose> examined_poses(const SpaceRobot& robot);

}  // namespace downwash
