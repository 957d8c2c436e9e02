#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <downwash/planner/planner.hpp>

#include "line_socket.hpp"

/// The vehicle's flight is over before the mission is.
struct FlightFailed : std::runtime_error {
    using runtime_error::runtime_error;
};

/// What the vehicle says of itself at a control tick.
struct Telemetry {
    std::int64_t tick = 0;
    double x_m = 0, z_m = 0, pitch_rad = 0, arm_rad = 0, vz_m_s = 0;
    std::optional<double> range_up_m;  ///< to the surface above; nothing where that is out of reach
};

/// A reference for the vehicle, and the vehicle with which it begins.
struct Command {
    std::int64_t from_tick = 0;
    downwash::Start start;
    downwash::Plan plan;
    downwash::Advice advice = downwash::Advice::follow;

    [[nodiscard]] bool leads_to_target() const {
        return advice == downwash::Advice::follow || advice == downwash::Advice::keep;
    }
    [[nodiscard]] std::int64_t end_tick() const { return from_tick + plan.reference.back().tick; }
};

/// The messages between mission planner and vehicle (README.md), as JSON over a socket.
/// Everything throws ConnectionLost where the vehicle is silent, gone, or says what cannot be understood.
class VehicleLink {
 public:
    explicit VehicleLink(const std::string& path);

    [[nodiscard]] double tick_s() const { return tick_s_; }
    /// Whether the vehicle waits for the mission planner at every tick.
    [[nodiscard]] bool is_lock_step() const { return is_lock_step_; }

    /// Waits for the next row of telemetry. @throws FlightFailed
    Telemetry next();
    /// The vehicle follows a command from its tick on, in place of those that begin no earlier, if it comes in time.
    void send(const Command& command);
    /// The last command that the vehicle has taken.
    [[nodiscard]] const Command& accepted() const { return accepted_; }
    /// Ends the mission, and waits until the vehicle has heard it.
    void end();

 private:
    LineSocket socket_;
    double tick_s_ = 0;
    bool is_lock_step_ = false;
    bool is_waiting_ = false;  ///< the vehicle, for the mission planner
    std::vector<Command> sent_;
    Command accepted_;
};
