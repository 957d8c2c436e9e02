#pragma once

#include <array>
#include <cstdint>
#include <future>
#include <optional>
#include <string>
#include <string_view>

#include <downwash/mavlink/frame.hpp>
#include <downwash/planner/planner.hpp>

/// What a streamer is asked to do.
struct StreamerOptions {
    std::optional<std::uint64_t> max_iterations = {};  ///< of each search, which makes a mission repeatable
    std::string lower = {};  ///< an obstacle that turns out lower than on the drawing; empty: none
    double lower_m = 0;      ///< by so much
    bool is_quiet = false;   ///< prints nothing
};

/// Plans a flight and sends it to a vehicle under PX4, set-point by set-point. It answers each telemetry of the
/// vehicle, whose clock is the only one, and knows nothing of sockets.
///
/// It flies no plan that PX4's loops do not follow closely, and none that a silent link would turn into a collision: at
/// moments of a plan it flies what PX4 makes of silence (flown_in_silence()). If there is an objection to a plan, it
/// plans again with half the speed.
class Streamer {
 public:
    /// @param drawing whose robot's law is PX4's
    Streamer(const downwash::SpaceProblem& drawing, const StreamerOptions& options);

    /// Plans from the start to the goals. @return whether there is a plan that is safe when the link falls silent
    bool plan();
    /// Takes another streamer's plan instead. @pre it is one for this problem
    void adopt(const downwash::SpaceProblem& planned, const downwash::SpacePlan& plan);

    /// The answer to a datagram from the vehicle: a set-point and what goes with it. Empty if it has no position.
    std::string answer(std::string_view datagram);
    /// Says "here I am": what a vehicle hears first.
    std::string greeting();

    [[nodiscard]] bool is_over() const { return phase_ == Phase::over; }
    /// Whether the vehicle hovers at the goal in Hold.
    [[nodiscard]] bool has_arrived() const { return has_arrived_; }
    /// Since offboard mode began; 0 before.
    [[nodiscard]] double flown_s() const { return static_cast<double>(tick_) / drawing_.robot.controller.rate_hz; }
    [[nodiscard]] const downwash::SpaceProblem& problem() const { return planner_->problem(); }
    [[nodiscard]] const downwash::SpacePlan& flown_plan() const { return plan_; }
    /// Greatest distance of the vehicle from the plan in offboard mode, by its telemetry [m].
    [[nodiscard]] double max_distance_m() const { return max_distance_m_; }

 private:
    enum class Phase { offering, flying, stopping, over };

    [[nodiscard]] std::int64_t ticks(double time_s) const;
    [[nodiscard]] std::optional<std::string> objection_to(const downwash::SpacePlan& plan, std::int64_t from) const;
    void proceed();
    void look_around();
    downwash::SpaceAnswer replan();
    void take_new_plan();
    void end(const std::string& why);
    [[nodiscard]] std::string frames();
    void say(const std::string& line) const;

    StreamerOptions options_;
    downwash::SpaceProblem drawing_;
    downwash::SpaceProblem believed_;
    std::optional<downwash::SpacePlanner> planner_;
    downwash::SpacePlan plan_;
    downwash::mavlink::FrameWriter writer_{1, downwash::mavlink::onboard_computer_component};

    Phase phase_ = Phase::offering;
    bool has_arrived_ = false;
    double now_s_ = 0;  ///< the vehicle's clock
    std::array<double, 3> at_m_{};
    std::uint32_t mode_ = 0;
    double since_s_ = -1;  ///< of the phase; negative: nothing has come from the vehicle
    double next_request_s_ = 0, next_heartbeat_s_ = 0;
    std::int64_t tick_ = 0;            ///< of the plan
    std::int64_t new_plan_from_ = -1;  ///< negative: none is being made
    bool leads_to_goal_ = true;
    bool knows_ = false;  ///< that the obstacle is lower
    std::future<downwash::SpaceAnswer> answer_;
    double max_distance_m_ = 0;
};
