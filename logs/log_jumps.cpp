#include "downwash/logs/log_jumps.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "downwash/base/vector3.hpp"

namespace downwash::logs {
namespace {

LogJump jump_by(JumpKind kind, std::span<const double> delta) {
    LogJump jump;
    jump.kind = kind;
    if (delta.empty() || !std::ranges::all_of(delta, [](double number) { return std::isfinite(number); })) {
        return jump;
    }
    if (kind == JumpKind::position) {
        jump.step_m = {delta[0], delta[1], 0};
    } else if (kind == JumpKind::height) {
        jump.step_m = {0, 0, delta[0]};
    } else if (delta.size() == 4) {  // a quaternion
        jump.turn_rad = std::atan2(2 * (delta[0] * delta[3] + delta[1] * delta[2]),
                                   1 - 2 * (delta[2] * delta[2] + delta[3] * delta[3]));
    } else {
        jump.turn_rad = delta[0];
    }
    return jump;
}

/// Where places go from one row to the next other than the velocities of the log say. None where so many rows do that
/// the velocities must be of something else, such as the body's axes.
std::vector<LogJump> unsaid_jumps(const FlightLog& log) {
    constexpr double least_step_m = 0.1, hardest_m_s2 = 4, longest_s = 0.25;
    constexpr std::size_t rows_for_one = 500, always = 4;
    const LogSeries& places = log.position_m;
    LogCursor velocity(log.velocity_m_s);
    std::vector<LogJump> jumps;
    for (std::size_t i = 1; i < places.rows() && !log.velocity_m_s.empty(); ++i) {
        const double step_s = places.t_s[i] - places.t_s[i - 1];
        const auto at = velocity.place(places.t_s[i] - 0.5 * step_s);
        if (step_s > longest_s || !at) {
            continue;
        }
        Vector3 step_m{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            step_m[axis] = places.row(i)[axis] - places.row(i - 1)[axis] - step_s * velocity.number(*at, axis);
        }
        const double least_m = least_step_m + 0.5 * hardest_m_s2 * step_s * step_s;
        const auto add = [&](JumpKind kind, const Vector3& by_m) {
            jumps.push_back({kind, places.t_s[i], by_m, 0, places.source + " against its velocity"});
        };
        if (std::hypot(step_m[0], step_m[1]) > least_m) {
            add(JumpKind::position, {step_m[0], step_m[1], 0});
        }
        if (std::abs(step_m[2]) > least_m) {
            add(JumpKind::height, {0, 0, step_m[2]});
        }
    }
    return jumps.size() > always + places.rows() / rows_for_one ? std::vector<LogJump>() : jumps;
}

/// Whether a list has the jump already, as a counter tells it a row earlier or later.
bool is_told(const std::vector<LogJump>& jumps, const LogJump& jump) {
    constexpr double same_s = 0.15;
    return std::ranges::any_of(jumps, [&jump](const LogJump& other) {
        return std::abs(other.t_s - jump.t_s) <= same_s && other.kind == jump.kind && other.source != jump.source;
    });
}

}  // namespace

void ResetWatch::see(double t_s, double number, std::span<const double> delta) {
    if (before_ && *before_ != number) {
        LogJump jump = jump_by(counter_->kind, delta);
        jump.t_s = t_s;
        jump.source = std::string(counter_->message) + "." + std::string(counter_->counter);
        jumps_.push_back(std::move(jump));
    }
    before_ = number;
}

void find_jumps(FlightLog& log) {
    std::vector<LogJump> all;
    const auto add = [&all](std::vector<LogJump>& more) {
        for (LogJump& jump : more) {
            if (!is_told(all, jump)) {
                all.push_back(std::move(jump));
            }
        }
    };
    add(log.jumps);
    std::vector<LogJump> unsaid = unsaid_jumps(log);
    add(unsaid);
    std::ranges::stable_sort(all, {}, &LogJump::t_s);
    log.jumps = std::move(all);
}

}  // namespace downwash::logs
