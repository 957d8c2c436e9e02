#pragma once

// Private to logs/.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "downwash/logs/flight_log.hpp"

namespace downwash::logs {

/// A counter of PX4 that rises with every reset of its estimator, and the field that says by how much that jumps.
struct ResetCounter {
    std::string_view message, counter;
    JumpKind kind;
    std::string_view delta;
    std::size_t count;  ///< numbers of `delta`
};

/// Heading resets are also resets of the attitude: of two that tell the same, the first one counts.
inline constexpr std::array reset_counters{
    ResetCounter{"vehicle_local_position", "xy_reset_counter", JumpKind::position, "delta_xy", 2},
    ResetCounter{"vehicle_local_position", "z_reset_counter", JumpKind::height, "delta_z", 1},
    ResetCounter{"vehicle_local_position", "heading_reset_counter", JumpKind::heading, "delta_heading", 1},
    ResetCounter{"vehicle_attitude", "quat_reset_counter", JumpKind::heading, "delta_q_reset", 4},
    ResetCounter{"vehicle_odometry", "reset_counter", JumpKind::estimator, "", 0},
};

/// Watches a counter over the rows of a log.
class ResetWatch {
 public:
    /// @param counter must outlive this
    explicit ResetWatch(const ResetCounter& counter) : counter_(&counter) {}

    [[nodiscard]] const ResetCounter& counter() const noexcept { return *counter_; }
    /// A row. @param delta as many numbers as the counter has, or none where the log does not say it
    void see(double t_s, double number, std::span<const double> delta);
    /// The resets so far, with times of the log's own clock.
    [[nodiscard]] const std::vector<LogJump>& jumps() const noexcept { return jumps_; }

 private:
    const ResetCounter* counter_;
    std::optional<double> before_;
    std::vector<LogJump> jumps_;
};

/// Adds the jumps of places that nothing in the log tells of, then sorts all and leaves out what is told twice.
void find_jumps(FlightLog& log);

}  // namespace downwash::logs
