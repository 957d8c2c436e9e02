#include "downwash/logs/flight_log.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace downwash {
namespace {

void change_signs(LogSeries& series, std::size_t first, std::size_t last) {
    for (std::size_t row = 0; row < series.rows(); ++row) {
        for (std::size_t column = first; column < last; ++column) {
            double& number = series.numbers[row * series.width + column];
            number = -number;
        }
    }
}

/// Counts times from another moment. Rows that then are no longer apart, at times that are far from it, become one.
void shift(LogSeries& series, double first_s) {
    LogSeries shifted{series.source, series.width, {}, {}};
    const auto later = [&](std::size_t i) { return series.t_s[i] - first_s > series.t_s[i - 1] - first_s; };
    std::size_t first_merged = 1;
    while (first_merged < series.rows() && later(first_merged)) {
        ++first_merged;
    }
    if (first_merged >= series.rows()) {  // as always but in tables of nonsense
        for (double& time_s : series.t_s) {
            time_s -= first_s;
        }
        return;
    }
    for (std::size_t i = 0; i < series.rows(); ++i) {
        shifted.add(series.t_s[i] - first_s, series.row(i));
    }
    series = std::move(shifted);
}

void normalise_attitude(LogSeries& attitude) {
    constexpr double least_length = 0.5;  // of a quaternion that is one but for rounding
    LogSeries sound;
    sound.source = attitude.source;
    sound.width = attitude.width;
    for (std::size_t i = 0; i < attitude.rows(); ++i) {
        const auto q = attitude.row(i);
        const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        if (!(length > least_length)) {
            continue;
        }
        double sign = 1;
        if (!sound.empty()) {
            const auto before = sound.row(sound.rows() - 1);
            sign = before[0] * q[0] + before[1] * q[1] + before[2] * q[2] + before[3] * q[3] < 0 ? -1 : 1;
        }
        const double scale = sign / length;
        const std::array<double, 4> unit{scale * q[0], scale * q[1], scale * q[2], scale * q[3]};
        sound.add(attitude.t_s[i], unit);
    }
    attitude = std::move(sound);
}

}  // namespace

std::string_view name_of(LogFormat format) noexcept {
    switch (format) {
        case LogFormat::ulog:
            return "ULog";
        case LogFormat::dataflash:
            return "DataFlash";
        case LogFormat::rosbag:
            return "rosbag";
        case LogFormat::csv:
            return "CSV";
    }
    return "";
}

std::string_view name_of(JumpKind kind) noexcept {
    switch (kind) {
        case JumpKind::position:
            return "position";
        case JumpKind::height:
            return "height";
        case JumpKind::heading:
            return "heading";
        case JumpKind::estimator:
            return "estimator";
    }
    return "";
}

void turn_over(FlightLog& log) {
    for (LogSeries* series :
         {&log.position_m, &log.velocity_m_s, &log.body_rates_rad_s, &log.specific_force_m_s2, &log.setpoint_m}) {
        change_signs(*series, 1, 3);
    }
    change_signs(log.attitude, 2, 4);  // half a turn about x on either side of the rotation
    for (LogJump& jump : log.jumps) {
        jump.step_m = {jump.step_m[0], -jump.step_m[1], -jump.step_m[2]};
        jump.turn_rad = -jump.turn_rad;
    }
}

void finish(FlightLog& log) {
    double first_s = std::numeric_limits<double>::infinity(), last_s = -first_s;
    for (const NamedSeries& each : named_series) {
        const LogSeries& series = log.*each.series;
        if (!series.empty()) {
            first_s = std::min(first_s, series.t_s.front());
            last_s = std::max(last_s, series.t_s.back());
        }
    }
    if (!(first_s <= last_s)) {
        return;
    }
    for (const NamedSeries& each : named_series) {
        shift(log.*each.series, first_s);
    }
    log.start_s = first_s;
    log.duration_s = last_s - first_s;
    for (LogJump& jump : log.jumps) {
        jump.t_s -= first_s;
    }
    normalise_attitude(log.attitude);
    if (log.recorded_axes == LogAxes::down) {
        turn_over(log);
    }
}

}  // namespace downwash
