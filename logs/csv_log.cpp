#include "downwash/logs/csv_log.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/base/csv_reader.hpp"
#include "downwash/base/line_errors.hpp"
#include "downwash/base/quantile.hpp"
#include "downwash/base/text.hpp"
#include "downwash/logs/csv_columns.hpp"
#include "downwash/logs/log_jumps.hpp"
#include "downwash/logs/rotation.hpp"

namespace downwash::logs {
namespace {

constexpr std::size_t max_rows = 20'000'000, max_columns = 2000;

/// The columns of one series.
struct Group {
    LogSeries* series;
    std::vector<std::optional<SignalColumn>> columns;  ///< empty: that number is 0
    std::vector<std::size_t> valid;                    ///< columns of flags without which a row does not count
    std::size_t invalid_rows = 0;
};

/// The columns of a counter of resets.
struct WatchedColumns {
    ResetWatch watch;
    std::size_t counter;
    std::vector<std::size_t> delta;
};

/// What a unit in the name of a column makes of its number at once. Times and angles are turned when all are read.
double factor_of(const SignalColumn& column) {
    return column.dimension == Dimension::angle || column.dimension == Dimension::time ? 1 : column.factor;
}

/// Whether a cell says no: "0", "False".
bool is_false(std::string_view cell) {
    return is_same_word(cell, "false") || parse_number<double>(cell) == 0.0;
}

bool is_missing(std::string_view cell) {
    return cell.empty() || is_same_word(cell, "nan");
}

/// Reads the rows of a table into the series of a log.
class CsvLog {
 public:
    CsvLog(std::string_view text, const std::string& file, const LogOptions& options)
        : file_(file),
          options_(options),
          errors_(file),
          csv_(text, errors_, {max_rows, max_columns}),
          columns_(csv_.names(), options.columns, file) {}

    CsvFlight read() {
        check_declared();
        log_.files = {file_};
        log_.format = LogFormat::csv;
        const auto time = columns_.find("t");
        if (!time) {
            errors_.add(csv_.header_line(), "has no column of times in '" + excerpt(joined(csv_.names(), ", ")) +
                                                "': expected t_s, time or timestamp, or --column t=NAME");
        }
        find_groups();
        watch_counters();
        errors_.throw_any();
        read_rows(*time);
        errors_.throw_any();
        scale_times(*time);
        turn_angles();
        turn_odometry();
        choose_rotor_unit();
        choose_axes();
        if (columns_.is_topic_by_name()) {
            log_.remarks.push_back(file_ +
                                   ": its name tells a table that ulog2csv made of PX4's log: axes are north, " +
                                   "east, down; --axes says otherwise");
        }
        for (const Group& group : groups_) {
            if (group.invalid_rows > 0) {
                log_.remarks.push_back(std::to_string(group.invalid_rows) + " rows of " + group.series->source +
                                       " are skipped, since the autopilot says that they are not valid");
            }
        }
        if (late_rows_ > 0) {
            log_.remarks.push_back(file_ + ": " + std::to_string(late_rows_) +
                                   " rows are skipped, since their times are not later than those before");
        }
        return {std::move(log_), csv_.names()};
    }

 private:
    void check_declared() {
        for (const auto& [signal, column] : options_.columns) {
            if (!is_csv_signal(signal)) {
                errors_.add(0, "--column " + excerpt(signal) + "=" + excerpt(column) +
                                   ": there is no such signal; expected t, x, y, z, vx, vy, vz, qw, qx, qy, qz, roll, "
                                   "pitch, yaw, wx, wy, wz, ax, ay, az, set_x, set_y, set_z, joint_1, joint_rate_1 or "
                                   "rotor_1");
            }
        }
        errors_.throw_any();
    }

    /// A series is there if its first and last columns are; one between may be missing in a vertical plane.
    void add_group(LogSeries& series, std::initializer_list<std::string_view> signals, bool is_whole) {
        std::vector<std::optional<SignalColumn>> columns;
        for (const std::string_view signal : signals) {
            columns.push_back(columns_.find(signal));
        }
        const auto is_there = [](const auto& column) { return column.has_value(); };
        if (is_whole ? !std::ranges::all_of(columns, is_there) : !std::ranges::any_of(columns, is_there)) {
            return;
        }
        add(series, std::move(columns));
    }

    void add_numbered(LogSeries& series, std::string_view beginning) {
        const std::vector<SignalColumn> found = columns_.find_numbered(beginning);
        if (!found.empty()) {
            add(series, {found.begin(), found.end()});
        }
    }

    void add(LogSeries& series, std::vector<std::optional<SignalColumn>> columns) {
        series.width = columns.size();
        std::string names;
        for (const auto& column : columns) {
            if (column) {
                names += (names.empty() ? "" : ", ") + csv_.names()[column->column];
            }
        }
        series.source = std::filesystem::path(file_).filename().string() + ": " + names;
        groups_.push_back({&series, std::move(columns), {}, 0});
        if (columns_.topic() == UlogTopic::local_position) {
            add_flags(&series == &log_.position_m     ? std::array{"xy_valid", "z_valid"}
                      : &series == &log_.velocity_m_s ? std::array{"v_xy_valid", "v_z_valid"}
                                                      : std::array{"", ""});
        }
    }

    /// Flags of the last group.
    void add_flags(const std::array<const char*, 2>& names) {
        for (const char* name : names) {
            if (const auto column = csv_.find(name)) {
                groups_.back().valid.push_back(*column);
            }
        }
    }

    void watch_counters() {
        if (columns_.topic() == UlogTopic::none) {
            return;
        }
        for (const ResetCounter& counter : reset_counters) {
            const auto column = csv_.find(counter.counter);
            if (!column) {
                continue;
            }
            WatchedColumns& watched = watched_.emplace_back(WatchedColumns{ResetWatch(counter), *column, {}});
            for (std::size_t i = 0; i < counter.count; ++i) {
                const std::string name(counter.delta);
                if (const auto delta = csv_.find(counter.count == 1 ? name : name + "[" + std::to_string(i) + "]")) {
                    watched.delta.push_back(*delta);
                }
            }
            if (watched.delta.size() < counter.count) {
                watched.delta.clear();
            }
        }
    }

    void see_counters(double time) {
        std::vector<double> delta;
        for (WatchedColumns& watched : watched_) {
            const auto number = parse_number<double>(csv_.cell(watched.counter));
            delta.clear();
            for (const std::size_t column : watched.delta) {
                delta.push_back(parse_number<double>(csv_.cell(column)).value_or(0));
            }
            if (number) {
                watched.watch.see(time, *number, delta);
            }
        }
    }

    void find_groups() {
        const bool is_planar = columns_.find("x") && !columns_.find("y") && columns_.find("z");
        add_group(log_.position_m, {"x", "y", "z"}, !is_planar);
        add_group(log_.velocity_m_s, {"vx", "vy", "vz"}, !is_planar);
        add_group(log_.attitude, {"qw", "qx", "qy", "qz"}, true);
        if (groups_.empty() || groups_.back().series != &log_.attitude) {
            add_group(angles_, {"roll", "pitch", "yaw"}, !is_planar);
        }
        add_group(log_.body_rates_rad_s, {"wx", "wy", "wz"}, !is_planar);
        add_group(log_.specific_force_m_s2, {"ax", "ay", "az"}, true);
        add_group(log_.setpoint_m, {"set_x", "set_y", "set_z"}, !is_planar);
        add_numbered(log_.joints_rad, "joint_");
        add_numbered(log_.joint_rates_rad_s, "joint_rate_");
        add_numbered(log_.joint_torques_nm, "joint_torque_");
        add_numbered(log_.rotor_commands, "rotor_");
    }

    void read_rows(const SignalColumn& time) {
        std::vector<double> row;
        while (csv_.next()) {
            if (is_missing(csv_.cell(time.column))) {
                continue;
            }
            const auto t = csv_.number(time.column);
            if (!t) {
                continue;
            }
            see_counters(*t);
            bool is_late = false;
            for (Group& group : groups_) {
                if (std::ranges::any_of(group.valid, [this](std::size_t flag) { return is_false(csv_.cell(flag)); })) {
                    ++group.invalid_rows;
                    continue;
                }
                row.clear();
                for (const auto& column : group.columns) {
                    if (!column) {
                        row.push_back(0);
                    } else if (!is_missing(csv_.cell(column->column))) {
                        row.push_back(factor_of(*column) * csv_.number(column->column).value_or(0));
                    }
                }
                is_late |= row.size() == group.columns.size() && !group.series->add(*t, row);
            }
            late_rows_ += is_late ? 1 : 0;
        }
        const auto has_rows = [](const Group& group) { return !group.series->empty(); };
        if (std::ranges::none_of(groups_, has_rows)) {
            std::string missing;
            for (const auto& [signal, column] : options_.columns) {
                missing += csv_.find(column) ? "" : "; there is no column " + excerpt(column) + " to be " + signal;
            }
            errors_.add(csv_.header_line(), "has nothing of a flight in '" + excerpt(joined(csv_.names(), ", ")) +
                                                "': expected columns such as x, y, z, or --column x=NAME for each of "
                                                "them" +
                                                missing);
        }
    }

    /// The twist of nav_msgs/Odometry is in the frame of the body. The attitude of the same rows turns it into the
    /// world.
    void turn_odometry() {
        const auto velocity = columns_.find("vx");
        if (!velocity || velocity->written != "twist.twist.linear.x" || log_.velocity_m_s.empty()) {
            return;
        }
        if (log_.attitude.t_s != log_.velocity_m_s.t_s) {
            log_.velocity_m_s = {};
            log_.remarks.push_back(file_ +
                                   ": velocities of twist.twist, in the frame of the body, are left out, since "
                                   "not all of their rows have an attitude");
            return;
        }
        for (std::size_t i = 0; i < log_.velocity_m_s.rows(); ++i) {
            const auto q = log_.attitude.row(i), v = log_.velocity_m_s.row(i);
            const Vector3 turned = rotated({q[0], q[1], q[2], q[3]}, {v[0], v[1], v[2]});
            std::ranges::copy(turned, log_.velocity_m_s.numbers.begin() + static_cast<std::ptrdiff_t>(3 * i));
        }
        log_.remarks.push_back(file_ +
                               ": velocities of twist.twist are in the frame of the body, as in nav_msgs/Odometry");
    }

    void scale_times(const SignalColumn& time) {
        const double unit_s = options_.time_unit_s ? *options_.time_unit_s : time_unit_s(time);
        for (const Group& group : groups_) {
            for (double& t : group.series->t_s) {
                t *= unit_s;
            }
        }
        for (const WatchedColumns& watched : watched_) {
            for (LogJump jump : watched.watch.jumps()) {
                jump.t_s *= unit_s;
                log_.jumps.push_back(std::move(jump));
            }
        }
    }

    /// The unit that the name of the column tells, or that in which rows are a likely time apart.
    double time_unit_s(const SignalColumn& time) {
        const std::string& name = csv_.names()[time.column];
        if (time.dimension == Dimension::time) {
            return time.factor;
        }
        if (name.ends_with("US") || (name == "timestamp" && columns_.topic() != UlogTopic::none)) {
            return 1e-6;
        }
        if (name == "%time") {
            return 1e-9;
        }
        std::vector<double> steps;
        for (const Group& group : groups_) {
            for (std::size_t i = 1; i < group.series->rows() && i < 10'000; ++i) {
                steps.push_back(group.series->t_s[i] - group.series->t_s[i - 1]);
            }
        }
        const double step = steps.empty() ? 0 : quantile(std::move(steps), 0.5);
        struct Unit {
            double below, unit_s;
            const char* name;
        };
        // Rows are from 0.2 ms to half a second apart.
        constexpr std::array units{Unit{0.9, 1, "seconds"}, Unit{500, 1e-3, "milliseconds"},
                                   Unit{5e5, 1e-6, "microseconds"}, Unit{INFINITY, 1e-9, "nanoseconds"}};
        const auto unit = std::ranges::find_if(units, [step](const Unit& each) { return step < each.below; });
        log_.remarks.push_back(file_ + ": the times in " + excerpt(name) + " are taken for " + unit->name +
                               "; --time-unit says otherwise");
        return unit->unit_s;
    }

    [[nodiscard]] double angle_unit_rad(const LogSeries& angles, const char* what) {
        if (options_.angles_in_degrees) {
            return *options_.angles_in_degrees ? 1 / degrees_per_radian : 1;
        }
        if (const SignalColumn first = first_of(angles); first.dimension == Dimension::angle) {
            return first.factor;
        }
        constexpr double beyond_radians = 6.5;
        const bool is_in_degrees =
            std::ranges::any_of(angles.numbers, [](double angle) { return std::abs(angle) > beyond_radians; });
        log_.remarks.push_back(file_ + ": the angles of the " + what + " are taken for " +
                               (is_in_degrees ? "degrees" : "radians") + "; --angles says otherwise");
        return is_in_degrees ? 1 / degrees_per_radian : 1;
    }

    SignalColumn first_of(const LogSeries& series) const {
        const auto group = std::ranges::find(groups_, &series, &Group::series);
        const auto first = std::ranges::find_if(group->columns, [](const auto& column) { return column.has_value(); });
        return **first;
    }

    void turn_angles() {
        if (!log_.joints_rad.empty()) {
            const double unit = angle_unit_rad(log_.joints_rad, "joints");
            const bool have_rates_units =
                !log_.joint_rates_rad_s.empty() && first_of(log_.joint_rates_rad_s).dimension == Dimension::rate;
            for (double& angle : log_.joints_rad.numbers) {
                angle *= unit;
            }
            for (double& rate : log_.joint_rates_rad_s.numbers) {
                rate *= have_rates_units ? 1 : unit;
            }
        }
        if (angles_.empty()) {
            return;
        }
        const double unit = angle_unit_rad(angles_, "attitude");
        log_.attitude.width = 4;
        log_.attitude.source = angles_.source;
        for (std::size_t i = 0; i < angles_.rows(); ++i) {
            const auto row = angles_.row(i);
            log_.attitude.add(angles_.t_s[i], quaternion_of_angles(unit * row[0], unit * row[1], unit * row[2]));
        }
    }

    void choose_rotor_unit() {
        if (log_.rotor_commands.empty()) {
            return;
        }
        const Dimension dimension = first_of(log_.rotor_commands).dimension;
        if (dimension == Dimension::force || dimension == Dimension::time) {
            log_.rotor_unit = dimension == Dimension::force ? RotorUnit::newton : RotorUnit::microseconds;
            return;
        }
        const double most = *std::ranges::max_element(log_.rotor_commands.numbers);
        log_.rotor_unit = most > 500 ? RotorUnit::microseconds : most > 1.05 ? RotorUnit::newton : RotorUnit::share;
        log_.remarks.push_back(file_ + ": the rotor commands are taken for " +
                               (most > 500    ? "pulse widths in microseconds"
                                : most > 1.05 ? "thrusts in newton"
                                              : "shares of the full command"));
    }

    void choose_axes() {
        if (options_.axes) {
            log_.recorded_axes = *options_.axes;
            log_.axes_source = AxesSource::declared;
        } else if (const auto axes = columns_.axes()) {
            log_.recorded_axes = *axes;
            log_.axes_source = AxesSource::format;
        } else {
            log_.recorded_axes = guessed_axes();
            log_.axes_source = AxesSource::guessed;
        }
    }

    /// Vehicles fly above where they count from.
    [[nodiscard]] LogAxes guessed_axes() const {
        std::vector<double> heights;
        for (std::size_t i = 0; i < log_.position_m.rows(); ++i) {
            heights.push_back(log_.position_m.row(i)[2]);
        }
        return !heights.empty() && quantile(std::move(heights), 0.5) < 0 ? LogAxes::down : LogAxes::up;
    }

    const std::string& file_;
    const LogOptions& options_;
    LineErrors errors_;
    CsvReader csv_;
    CsvColumns columns_;
    FlightLog log_;
    LogSeries angles_;
    std::vector<Group> groups_;
    std::vector<WatchedColumns> watched_;
    std::size_t late_rows_ = 0;
};

}  // namespace

CsvFlight read_csv_log(std::string_view text, const std::string& file, const LogOptions& options) {
    return CsvLog(text, file, options).read();
}

}  // namespace downwash::logs
