#pragma once

#include <array>
#include <optional>
#include <vector>

#include "downwash/controllers/reference_point.hpp"
#include "downwash/judge/observer.hpp"
#include "downwash/judge/plant.hpp"

// The controller of docs/model.md 5, from its equations. Private: not installed.

namespace downwash::judge {

/// What a controller keeps between ticks.
struct ControlMemory {
    Planar position_integral;         ///< Integral of the position error [m s].
    double pitch_rate_integral = 0;   ///< Integral of the pitch rate error [rad].
    double arm_integral = 0;          ///< Integral of the arm error [rad s].
    double pitch_reference_rad = 0;   ///< q5_ref of the tick before
    double pitch_reference_rate = 0;  ///< its filtered derivative [rad/s]
    double rate_reference = 0;        ///< u5_ref of the tick before [rad/s]

    // Of the cascade.
    Planar velocity_integral;   ///< Integral of the velocity error [m].
    double joint_integral = 0;  ///< Integral of the arm error [rad s].
    Planar velocity_before;     ///< seen at the tick before [m/s]
    double rate_before = 0;     ///< pitch rate seen then [rad/s]

    ObserverMemory observed;
};

/// The controller of a robot.
class ControlLaw {
 public:
    /// @pre robot_errors(robot) is empty
    DOWNWASH_EXPORT explicit ControlLaw(const Robot& robot);

    [[nodiscard]] double tick_s() const noexcept { return tick_s_; }

    /// The thrusts that carry the weight of the nominal vehicle, without a pitch torque [N].
    [[nodiscard]] std::array<double, max_rotors> resting_thrust_n() const noexcept;

    /// The memory at the start of a flight. @param motion of the point that the robot file calls the centre of mass
    [[nodiscard]] DOWNWASH_EXPORT ControlMemory memory_at_start(const Motion& motion) const;

    /// The memory in the middle of a flight. @param numbers as Start::controller_memory has them
    [[nodiscard]] ControlMemory memory_of(const std::vector<double>& numbers) const;

    /// One tick. @param seen what the sensors tell, about the point that the robot file calls the centre of mass
    /// @param rotor_n thrusts that the rotors' lag has reached [N]
    /// @param nominal surfaces as the controller's map has them, where it is right
    /// @param[in,out] memory that of the tick before, then that of this one
    [[nodiscard]] DOWNWASH_EXPORT Command command(const Motion& seen, const std::array<double, max_rotors>& rotor_n,
                                                  const ReferencePoint& reference, const Surroundings& nominal,
                                                  ControlMemory& memory) const;

    /// Lets integrals and the observer stand still over a tick, as those of a vehicle that touches something.
    /// @param before memory of before the tick   @param from,to motion at its ends, about the point of the robot file
    void stand_still(const ControlMemory& before, const Motion& from, const Motion& to, ControlMemory& memory) const;

 private:
    struct Inversion;
    struct Wanted;
    struct Tilt;
    struct Demand;
    struct Read;
    struct Rotors;

    Demand inverted(const ModelInversion& gain, const Inversion& inversion, const Motion& seen,
                    const ReferencePoint& reference, ControlMemory& kept, ControlMemory& integrated) const;
    Demand falling(const PlanarLyapunov& gain, const Inversion& inversion, const Motion& seen,
                   const ReferencePoint& reference, ControlMemory& kept, ControlMemory& integrated) const;
    Demand cascaded(const CascadedPid& gain, const Motion& seen, const ReferencePoint& reference, ControlMemory& kept,
                    ControlMemory& integrated) const;
    Demand demand(const Motion& seen, const ReferencePoint& reference, const Inversion& inversion, ControlMemory& kept,
                  ControlMemory& integrated) const;
    template <class Gain>
    Tilt tilt(const Gain& gain, const Inversion& inversion, const Wanted& wanted, const ControlMemory& kept) const;
    Read read(const Motion& seen, const Surroundings& nominal) const;
    Rotors limit(const Demand& demand, const Read& read, const std::array<double, max_rotors>& rotor_n,
                 Command& command) const;

    Robot robot_;
    Vehicle nominal_vehicle_;
    double tick_s_;
    double rotor_lead_;
    std::optional<controllers::FeedForward> feed_forward_;
    bool has_observer_;
    Observer observer_;
    std::array<std::array<double, 2>, max_rotors> share_{};  ///< Shares of thrust and pitch torque: the pseudo-inverse.
};

}  // namespace downwash::judge
