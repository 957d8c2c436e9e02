#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "downwash/aeromap/aero_settings.hpp"
#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/controllers/space_law.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/dynamics/plant.hpp"
#include "downwash/dynamics/space_contact.hpp"
#include "downwash/scene/space_pose.hpp"
#include "downwash/simulation/space_carry.hpp"
#include "downwash/simulation/space_effect.hpp"
#include "downwash/simulation/space_flight_state.hpp"
#include "downwash/simulation/space_robot.hpp"
#include "downwash/simulation/space_world.hpp"

// One vehicle in space in closed loop, with a number of joints that is known at run time. All that flies one vehicle at
// a time uses it.

namespace downwash {

namespace controllers {
struct ToldPush;  // space_actuate.hpp
}  // namespace controllers

/// Where a vehicle in space is and how it moves. Joints that it lacks stay at zero.
struct SpaceMotion {
    Vector3 position_m{};                        ///< of the multirotor's centre of mass by the robot file, world
    std::array<double, 4> attitude{1, 0, 0, 0};  ///< quaternion (w, x, y, z) from body axes to world axes, length 1
    std::array<double, max_joints> joints_rad{};
    Vector3 velocity_m_s{};      ///< of that point, world axes
    Vector3 body_rates_rad_s{};  ///< body axes
    std::array<double, max_joints> joint_rates_rad_s{};

    friend bool operator==(const SpaceMotion&, const SpaceMotion&) = default;
};

/// Where obstacles in their nominal places see a vehicle.
[[nodiscard]] DOWNWASH_EXPORT SpacePose among_obstacles(const SpaceMotion& motion, const SpaceWorld& world) noexcept;

/// How many numbers a law remembers that flies a vehicle with so many joints.
[[nodiscard]] DOWNWASH_EXPORT int memory_size(const SpaceLaw& law, int joints) noexcept;

/// What a vehicle of a robot carries.
[[nodiscard]] DOWNWASH_EXPORT SpaceCarry carry_of(const SpaceRobot& robot, const AnySpaceState& vehicle);

/// The vehicle in space at one control tick and the commands it holds until the next; SI units.
struct SpaceFlightRow {
    double t_s = 0;
    SpacePoint reference;
    SpaceMotion motion;
    double rotor_command_n[max_rotors] = {};  ///< free-air thrust, after clipping
    double rotor_lag_n[max_rotors] = {};      ///< thrust that the lag has reached; meaningful with rotor lag only
    double rotor_factor[max_rotors] = {};     ///< surface effect K at t_s
    double joint_torque_nm[max_joints] = {};
    double saturation = 0;   ///< greatest demand over its limit; above 1 something was clipped
    double clearance_m = 0;  ///< infinity without obstacles
    Vector3 end_effector_m{};
    double power_w = 0;
    double energy_j = 0;         ///< spent since the start
    double contact_force_n = 0;  ///< normal force of a surface that the robot touches, mean over the tick before
};

/// The greatest number of joints that this library was built for, from 3 to max_joints.
[[nodiscard]] DOWNWASH_EXPORT int max_built_joints() noexcept;

namespace simulation {

/// @throws InputError if the robot has more joints than this library was built for
DOWNWASH_EXPORT void require_built_joints(const SpaceRobot& robot);

/// How surfaces act on a robot besides the field that says where.
struct SpaceAero {
    TiltLoss tilt_loss;
    double wall_force = 0;     ///< see WallEffect
    double wall_moment_m = 0;  ///< moment over thrust
    /// Whether air between the rotors that comes back from the ground pushes the body (docs/model.md 4.3).
    bool has_fountain = false;
};

/// That of settings: nothing where effects are disabled.
[[nodiscard]] DOWNWASH_EXPORT SpaceAero space_aero(const AeroSettings& aero, double rotor_radius_m);

/// A vehicle in space in closed loop, in a world, among surfaces. It begins at rest in the world's origin: call
/// start().
class DOWNWASH_EXPORT SpaceLoop {
 public:
    SpaceLoop() = default;
    virtual ~SpaceLoop() = default;
    SpaceLoop(const SpaceLoop&) = delete;
    SpaceLoop& operator=(const SpaceLoop&) = delete;

    /// The vehicle in a motion: it has spent no energy and was always in this state.
    /// @pre what it carries is of this robot
    virtual void start(const SpaceMotion& motion, const SpaceCarry& carry) = 0;
    /// The same with a law that has come to rest there, and rotors that carry the weight.
    void start(const SpaceMotion& motion) { start(motion, {}); }
    /// The vehicle of another flight in the same world goes on here.
    virtual void take_over(const AnySpaceState& state) = 0;
    /// Everything about the vehicle that changes in flight.
    [[nodiscard]] virtual AnySpaceState state() const = 0;
    /// Forgets what the vehicle did before: from now on it was always in this state, and has spent no energy.
    virtual void forget() = 0;

    /// One control tick.
    /// @param number of the tick, from the start of the whole flight, for the noise of the world
    /// @param[in,out] row gets the commands of the tick, their saturation, and the power at its beginning
    virtual void tick(std::int64_t number, const SpacePoint& reference, SpaceFlightRow& row) = 0;
    /// tick() beside a surface that the robot may touch. Integrals and the estimate of an observer stand still in a
    /// tick with contact: a surface that pushes is not what they are there for.
    /// @param contact in the world; its points as of SpaceContactStep   @param push that the law is told of; nullptr:
    /// none
    /// @param is_at_surface they stand still anyway   @param[out] seen what happened at the surface
    virtual void touching_tick(std::int64_t number, const SpacePoint& reference, const dynamics::SpaceContact& contact,
                               const controllers::ToldPush* push, bool is_at_surface, SpaceFlightRow& row,
                               dynamics::SpaceContactRecord& seen) = 0;
    /// tick() without the noise and gusts of the world. @param[in,out] row as of tick()
    virtual void quiet_tick(const SpacePoint& reference, SpaceFlightRow& row) = 0;
    /// What the controller would command now without noise; nothing moves. @param[in,out] row as of tick()
    virtual void look(const SpacePoint& reference, SpaceFlightRow& row) = 0;
    /// Writes motion, lag, K, end effector and energy. @param[in,out] row
    virtual void describe(SpaceFlightRow& row) = 0;

    [[nodiscard]] virtual SpaceMotion motion() const = 0;
    [[nodiscard]] virtual double energy_j() const = 0;
    /// Whether every number of the state is at most so large in size.
    [[nodiscard]] virtual bool is_within(double max) const = 0;
    /// Whether every rotor is in the flyable area.
    [[nodiscard]] virtual bool is_flyable() = 0;
};

/// What a SpaceLoop is made of.
struct SpaceLoopSetup {
    const SpaceRobot& robot;
    SpaceWorld world = {};
    SpaceEffect& effect;  ///< outlives the loop
    SpaceAero aero = {};
    /// Whether the plant takes as many steps as a tick needs (RefinedSpaceStep); false: equal ones, as in planning.
    bool is_refined = true;
};

/// @throws InputError if the robot has more joints than this library was built for
/// @pre space_robot_errors(robot) is empty
[[nodiscard]] DOWNWASH_EXPORT std::unique_ptr<SpaceLoop> make_space_loop(const SpaceLoopSetup& setup);

}  // namespace simulation
}  // namespace downwash
