#include "downwash/identification/recorded_flight.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/base/text.hpp"

namespace downwash {
namespace {

/// Rows that are farther apart have nothing between them [s].
constexpr double max_gap_s = 0.2;

struct Needed {
    std::string_view name;
    LogSeries FlightLog::*series;
    std::size_t width;
};

/// What a log of a robot has to have.
std::vector<Needed> needed_of(const SpaceRobot& robot) {
    const auto joints = static_cast<std::size_t>(robot.joints());
    std::vector<Needed> all{{"position", &FlightLog::position_m, 3},
                            {"attitude", &FlightLog::attitude, 4},
                            {"velocity", &FlightLog::velocity_m_s, 3},
                            {"body rates", &FlightLog::body_rates_rad_s, 3},
                            {"rotor commands", &FlightLog::rotor_commands, robot.plant.rotors.size()}};
    if (joints > 0) {
        all.push_back({"joints", &FlightLog::joints_rad, joints});
        all.push_back({"joint rates", &FlightLog::joint_rates_rad_s, joints});
        all.push_back({"joint torques", &FlightLog::joint_torques_nm, joints});
    }
    return all;
}

void require(const FlightLog& log, const std::vector<Needed>& needed) {
    std::vector<KeyError> errors;
    for (const Needed& each : needed) {
        const LogSeries& series = log.*each.series;
        const std::string file = log.files.empty() ? std::string("the log") : log.files.front();
        if (series.empty()) {
            errors.push_back({"", file + ": has no " + std::string(each.name) +
                                      ": expected position, attitude, velocity, body rates and rotor commands, and of "
                                      "robots with an arm joints, joint rates and joint torques"});
        } else if (series.width < each.width) {
            errors.push_back({"", file + ": has " + std::to_string(series.width) + " " + std::string(each.name) +
                                      ": expected " + std::to_string(each.width) + ", as the robot has"});
        }
    }
    throw_if_any(std::move(errors));
}

/// Thrusts of rotor commands.
class Thrusts {
 public:
    Thrusts(const FlightLog& log, const SpaceRobot& robot, const std::optional<double>& exponent)
        : unit_(log.rotor_unit), robot_(robot), exponent_(exponent.value_or(1)) {
        if (unit_ != RotorUnit::newton && !exponent) {
            throw_input_error(
                "rotor commands are no thrusts: expected --thrust-exponent P, for thrusts that are max_thrust_n times "
                "the share of the full command to the power P (1 where the autopilot makes thrust linear, 2 for "
                "speeds)");
        }
    }
    [[nodiscard]] double of(double command, std::size_t rotor) const {
        if (unit_ == RotorUnit::newton) {
            return command;
        }
        constexpr double stop_us = 1000, full_us = 2000;
        const double share = unit_ == RotorUnit::share ? command : (command - stop_us) / (full_us - stop_us);
        return robot_.max_thrust_n[rotor] * std::pow(std::clamp(share, 0.0, 1.0), exponent_);
    }

 private:
    RotorUnit unit_;
    const SpaceRobot& robot_;
    double exponent_;
};

/// A cursor for each series that is read.
struct Cursors {
    explicit Cursors(const FlightLog& log)
        : position(log.position_m, max_gap_s),
          attitude(log.attitude, max_gap_s),
          velocity(log.velocity_m_s, max_gap_s),
          rates(log.body_rates_rad_s, max_gap_s),
          joints(log.joints_rad, max_gap_s),
          joint_rates(log.joint_rates_rad_s, max_gap_s),
          torques(log.joint_torques_nm, max_gap_s),
          setpoint(log.setpoint_m, infinity_) {}
    static constexpr double infinity_ = 1e9;
    LogCursor position, attitude, velocity, rates, joints, joint_rates, torques, setpoint;
};

template <class Numbers>
bool read(LogCursor& cursor, double t_s, std::size_t width, Numbers& out) {
    const auto place = cursor.place(t_s);
    for (std::size_t i = 0; place && i < width; ++i) {
        out[i] = cursor.number(*place, i);
    }
    return place.has_value();
}

bool read_tick(Cursors& cursors, std::size_t joints, LoggedTick& tick) {
    SpaceMotion& seen = tick.seen;
    bool is_whole = read(cursors.position, tick.t_s, 3, seen.position_m) &&
                    read(cursors.attitude, tick.t_s, 4, seen.attitude) &&
                    read(cursors.velocity, tick.t_s, 3, seen.velocity_m_s) &&
                    read(cursors.rates, tick.t_s, 3, seen.body_rates_rad_s);
    if (joints > 0) {
        is_whole = is_whole && read(cursors.joints, tick.t_s, joints, seen.joints_rad) &&
                   read(cursors.joint_rates, tick.t_s, joints, seen.joint_rates_rad_s) &&
                   read(cursors.torques, tick.t_s, joints, tick.joint_torque_nm);
    }
    double length = 0;
    for (const double number : seen.attitude) {
        length += number * number;
    }
    for (double& number : seen.attitude) {
        number /= std::sqrt(length);
    }
    const auto& q = seen.attitude;
    tick.reference.position[space::yaw] =
        lane::atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
    std::copy_n(seen.joints_rad.begin(), joints, tick.reference.position + space::first_joint);
    return is_whole;
}

}  // namespace

LoggedFlight recorded_flight(const FlightLog& log, const SpaceRobot& robot, const RecordedFlightOptions& options) {
    require(log, needed_of(robot));
    const Thrusts thrusts(log, robot, options.thrust_exponent);
    const auto joints = static_cast<std::size_t>(robot.joints());
    Cursors cursors(log);
    LoggedFlight longest, current;
    const auto keep_longer = [&] {
        if (current.ticks.size() > longest.ticks.size()) {
            longest = current;
        }
        current.ticks.clear();
    };
    const LogSeries& commands = log.rotor_commands;
    bool has_reference = !log.setpoint_m.empty();
    for (std::size_t row = 0; row < commands.rows(); ++row) {
        LoggedTick tick;
        tick.t_s = commands.t_s[row];
        for (std::size_t i = 0; i < robot.plant.rotors.size(); ++i) {
            tick.rotor_command_n[i] = thrusts.of(commands.row(row)[i], i);
        }
        const bool is_late = !current.ticks.empty() && tick.t_s - current.ticks.back().t_s > max_gap_s;
        if (!read_tick(cursors, joints, tick) || is_late) {
            keep_longer();
            continue;
        }
        has_reference = has_reference && read(cursors.setpoint, tick.t_s, 3, tick.reference.position);
        current.ticks.push_back(tick);
    }
    keep_longer();
    longest.name = log.files.empty() ? std::string("log") : log.files.front();
    longest.is_true_motion = options.is_true_motion;
    longest.has_reference = has_reference;
    return longest;
}

}  // namespace downwash
