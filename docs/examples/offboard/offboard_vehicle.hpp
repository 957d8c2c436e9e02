#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include <downwash/mavlink/frame.hpp>
#include <downwash/problems/space_problem_model.hpp>
#include <downwash/simulation/space_effect.hpp>
#include <downwash/simulation/space_loop.hpp>

/// A simulated vehicle under PX4, as far as those know it who fly it in offboard mode. It begins in Hold, at the start
/// of a problem, and flies PX4's cascade through the effects of surfaces.
///
/// - It follows set-points with a position (SET_POSITION_TARGET_LOCAL_NED), and joints (MAV_CMD_DO_SET_ACTUATOR).
/// - It enters offboard mode on demand (MAV_CMD_DO_SET_MODE), after a second of set-points.
/// - It leaves it for Hold on demand, and as a failsafe when no set-point has come for loss_timeout_s. Until then it
///   holds on to the last one, with its velocity and acceleration.
/// - In Hold it stops (stop_in_hold()) and stays there.
class OffboardVehicle {
 public:
    /// @param truth what is really there; its robot's law is PX4's   @param world in which it flies
    OffboardVehicle(const downwash::SpaceProblem& truth, const downwash::SpaceWorld& world);

    /// Reads what has arrived, and answers commands with the next sent().
    void take(std::string_view datagram);
    /// What it sends now: at 50 Hz where it is and how it is turned, once a second its heartbeat.
    [[nodiscard]] std::string sent();
    /// Its heartbeat, which says the mode.
    [[nodiscard]] std::string heartbeat();
    /// Flies one control tick. Nothing more happens once it has collided or is unstable.
    void tick();

    [[nodiscard]] double time_s() const { return static_cast<double>(tick_) * tick_s_; }
    [[nodiscard]] bool is_telemetry_due() const { return tick_ % ticks_between_setpoints_ == 0; }
    [[nodiscard]] bool is_offboard() const { return mode_ == downwash::mavlink::px4_offboard_mode; }
    /// Whether it is in Hold because set-points did not come.
    [[nodiscard]] bool is_in_failsafe() const { return is_in_failsafe_; }
    [[nodiscard]] downwash::Outcome outcome() const { return outcome_; }
    [[nodiscard]] double min_clearance_m() const { return min_clearance_m_; }
    [[nodiscard]] downwash::SpaceMotion motion() const { return loop_->motion(); }
    [[nodiscard]] const downwash::SpacePoint& reference() const { return reference_; }
    [[nodiscard]] int setpoints() const { return setpoints_; }

 private:
    void take(const downwash::mavlink::SetPositionTargetLocalNed& setpoint);
    void take(const downwash::mavlink::CommandLong& command);
    std::uint8_t set_mode(const downwash::mavlink::CommandLong& command);
    void set_joints(const downwash::mavlink::CommandLong& command);
    void hold(bool is_failsafe);
    void move_reference();
    void judge();

    /// A servo of the arm: it moves on at the rate of the last commands.
    struct Servo {
        double angle_rad = 0, rate_rad_s = 0, commanded_s = 0;
    };

    downwash::SpaceProblemModel model_;
    downwash::SpaceWorld world_;
    std::unique_ptr<downwash::simulation::SpaceEffect> effect_;
    std::unique_ptr<downwash::simulation::SpaceLoop> loop_;
    double tick_s_;
    std::int64_t tick_ = 0, ticks_between_setpoints_;

    std::uint32_t mode_ = downwash::mavlink::px4_hold_mode;
    bool is_in_failsafe_ = false;
    downwash::SpacePoint reference_;
    downwash::SpacePlan stop_;  ///< of Hold, and the tick at which it began
    std::int64_t stopping_since_ = 0;
    double first_setpoint_s_ = 0, last_setpoint_s_ = -1;  ///< of a stream without a gap
    int setpoints_ = 0;
    std::array<Servo, downwash::max_joints> servos_;

    downwash::mavlink::FrameWriter writer_{1, downwash::mavlink::autopilot_component};
    std::string answers_;
    double next_heartbeat_s_ = 0;
    downwash::Outcome outcome_ = downwash::Outcome::ok;
    double min_clearance_m_;
};
