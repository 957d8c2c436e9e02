#include "downwash/comparison/log_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/scene/space_pose.hpp"

namespace downwash {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double row_step_s = 0.02;

/// Sums of errors, one sample after the other.
class ErrorSums {
 public:
    void add(const Vector3& error_m, double t_s) {
        const std::array<double, 4> each{error_m[0], error_m[1], error_m[2], std::sqrt(dot(error_m, error_m))};
        if (each[3] > figures_.max_m[3]) {
            figures_.max_at_s = t_s;
        }
        for (std::size_t i = 0; i < each.size(); ++i) {
            sum_[i] += each[i];
            square_[i] += each[i] * each[i];
            figures_.max_m[i] = std::max(figures_.max_m[i], std::abs(each[i]));
        }
        ++figures_.samples;
    }
    [[nodiscard]] ErrorFigures figures() const {
        ErrorFigures figures = figures_;
        const auto count = static_cast<double>(std::max<std::size_t>(1, figures.samples));
        for (std::size_t i = 0; i < sum_.size(); ++i) {
            figures.mean_m[i] = sum_[i] / count;
            figures.rms_m[i] = std::sqrt(square_[i] / count);
        }
        return figures;
    }

 private:
    ErrorFigures figures_;
    std::array<double, 4> sum_{}, square_{};
};

class AngleSums {
 public:
    void add(double error_rad) {
        const double turn_rad = 2 * std::numbers::pi;
        const double size_rad = std::abs(error_rad - turn_rad * std::round(error_rad / turn_rad));
        ++figures_.samples;
        square_ += size_rad * size_rad;
        figures_.max_rad = std::max(figures_.max_rad, size_rad);
    }
    [[nodiscard]] AngleFigures figures() const {
        AngleFigures figures = figures_;
        figures.rms_rad = std::sqrt(square_ / static_cast<double>(std::max<std::size_t>(1, figures.samples)));
        return figures;
    }

 private:
    AngleFigures figures_;
    double square_ = 0;
};

/// The planned flight between its ticks.
class PlannedMoments {
 public:
    explicit PlannedMoments(const PlannedFlight& planned) : planned_(planned) {}

    [[nodiscard]] std::size_t row(double t_s) const {
        const double tick = std::floor(t_s / planned_.tick_s);
        return std::min(static_cast<std::size_t>(std::max(tick, 0.0)), planned_.rows.size() - 1);
    }
    [[nodiscard]] Vector3 between(Vector3 PlannedRow::*what, double t_s) const {
        const std::size_t i = row(t_s);
        const Vector3& here = planned_.rows[i].*what;
        if (i + 1 == planned_.rows.size()) {
            return here;
        }
        const double share = (t_s - planned_.rows[i].t_s) / (planned_.rows[i + 1].t_s - planned_.rows[i].t_s);
        return here + share * (planned_.rows[i + 1].*what - here);
    }

 private:
    const PlannedFlight& planned_;
};

std::array<double, 4> turned_by(double yaw_rad, const std::array<double, 4>& q) {
    const double c = std::cos(0.5 * yaw_rad), s = std::sin(0.5 * yaw_rad);
    return {c * q[0] - s * q[3], c * q[1] - s * q[2], c * q[2] + s * q[1], c * q[3] + s * q[0]};
}

class Comparison {
 public:
    Comparison(FlightLog log, const ComparedPlan& plan, const ComparisonOptions& options)
        : log_(std::move(log)), plan_(plan), options_(options), planned_(plan.fly(true)) {
        if (planned_.rows.size() < 2) {
            throw_input_error("the plan's own flight ends at its start (" + planned_.outcome +
                              "): there is nothing to compare a log with");
        }
    }

    LogComparison compare() {
        result_.alignment = align(log_, planned_, options_.alignment);
        if (result_.alignment.is_turned_over) {
            turn_over(log_);
            log_.recorded_axes = log_.recorded_axes == LogAxes::down ? LogAxes::up : LogAxes::down;
        }
        result_.planned_outcome = planned_.outcome;
        result_.duration_s = planned_.rows.back().t_s;
        result_.row_step_s = row_step_s;
        result_.has_attitude = !log_.attitude.empty();
        result_.has_joints = !log_.joints_rad.empty() && log_.joints_rad.width >= plan_.joints();
        phases_ = phases_of(planned_);
        place_jumps();
        track();
        track_angles();
        add_rows();
        find_least_clearances();
        weigh_thrust();
        if (options_.worlds.count > 0 && plan_.has_uncertainty()) {
            compare_with_worlds();
        }
        return std::move(result_);
    }

 private:
    void place_jumps() {
        const LogAlignment& alignment = result_.alignment;
        for (LogJump jump : log_.jumps) {
            jump.t_s = (jump.t_s - alignment.offset_s) / alignment.rate;
            if (jump.t_s >= 0 && jump.t_s <= result_.duration_s) {
                jump.step_m = alignment.turned(jump.step_m);
                result_.jumps.push_back(std::move(jump));
            }
        }
    }

    [[nodiscard]] bool is_behind_jump(double t_s) const {
        return std::ranges::any_of(
            result_.jumps, [t_s](const LogJump& jump) { return t_s >= jump.t_s && t_s <= jump.t_s + after_jump_s; });
    }

    /// Errors at every position of the log while the plan lasts.
    void track() {
        const PlannedMoments moments(planned_);
        const LogAlignment& alignment = result_.alignment;
        ErrorSums tracking, from_planned, apart;
        std::array<ErrorSums, all_flight_phases.size()> by_phase;
        const LogSeries& places = log_.position_m;
        for (std::size_t i = 0; i < places.rows(); ++i) {
            const double t_s = (places.t_s[i] - alignment.offset_s) / alignment.rate;
            if (t_s < 0 || t_s > result_.duration_s) {
                continue;
            }
            const auto row = places.row(i);
            const Vector3 flown_m = alignment.placed({row[0], row[1], row[2]});
            const Vector3 error_m = flown_m - moments.between(&PlannedRow::reference_m, t_s);
            tracking.add(error_m, t_s);
            if (!is_behind_jump(t_s)) {
                apart.add(error_m, t_s);
            }
            from_planned.add(flown_m - moments.between(&PlannedRow::position_m, t_s), t_s);
            by_phase[static_cast<std::size_t>(phases_[moments.row(t_s)])].add(error_m, t_s);
        }
        result_.tracking = tracking.figures();
        result_.from_planned = from_planned.figures();
        result_.tracking_apart = apart.figures();
        for (const FlightPhase phase : all_flight_phases) {
            if (const auto ticks = std::ranges::count(phases_, phase); ticks > 0) {
                result_.phases.push_back({phase, static_cast<double>(ticks) * planned_.tick_s,
                                          by_phase[static_cast<std::size_t>(phase)].figures(), infinite});
            }
        }
    }

    void track_angles() {
        AngleSums yaw;
        std::vector<AngleSums> joints(result_.has_joints ? plan_.joints() : 0);
        LogCursor attitude(log_.attitude), angles(log_.joints_rad);
        for (const PlannedRow& row : planned_.rows) {
            const double log_s = result_.alignment.log_time(row.t_s);
            if (const auto at = attitude.place(log_s)) {
                const Matrix3 rotation = rotation_of({attitude.number(*at, 0), attitude.number(*at, 1),
                                                      attitude.number(*at, 2), attitude.number(*at, 3)});
                yaw.add(std::atan2(rotation[1][0], rotation[0][0]) + result_.alignment.yaw_rad - row.reference_yaw_rad);
            }
            const auto at = angles.place(log_s);
            for (std::size_t i = 0; at && i < joints.size(); ++i) {
                joints[i].add(angles.number(*at, i) - row.reference_joints_rad[i]);
            }
        }
        if (result_.has_attitude && !plan_.is_in_plane()) {
            result_.yaw = yaw.figures();
        }
        for (const AngleSums& joint : joints) {
            result_.joints.push_back(joint.figures());
        }
    }

    [[nodiscard]] FlownPose pose_at(double log_s, const Vector3& position_m, const PlannedRow& planned) {
        FlownPose pose;
        pose.position_m = position_m;
        pose.attitude = turned_by(planned.reference_yaw_rad, {1, 0, 0, 0});
        if (const auto at = attitude_.place(log_s)) {
            pose.attitude = turned_by(result_.alignment.yaw_rad, {attitude_.number(*at, 0), attitude_.number(*at, 1),
                                                                  attitude_.number(*at, 2), attitude_.number(*at, 3)});
        }
        pose.joints_rad = planned.reference_joints_rad;
        const auto at = result_.has_joints ? joints_.place(log_s) : std::nullopt;
        for (std::size_t i = 0; at && i < plan_.joints(); ++i) {
            pose.joints_rad[i] = joints_.number(*at, i);
        }
        return pose;
    }

    void add_rows() {
        const PlannedMoments moments(planned_);
        LogCursor places(log_.position_m), commands(log_.rotor_commands);
        const auto steps = static_cast<std::size_t>(result_.duration_s / row_step_s);
        result_.rows.reserve(steps + 1);
        for (std::size_t i = 0; i <= steps; ++i) {
            const double t_s = static_cast<double>(i) * row_step_s;
            const double log_s = result_.alignment.log_time(t_s);
            const PlannedRow& planned = planned_.rows[moments.row(t_s)];
            ComparedRow row;
            row.t_s = t_s;
            row.reference_m = moments.between(&PlannedRow::reference_m, t_s);
            row.planned_m = moments.between(&PlannedRow::position_m, t_s);
            row.planned_clearance_m = planned.clearance_m;
            row.planned_thrust_n = planned.thrust_n;
            row.flown_m = {not_a_number, not_a_number, not_a_number};
            row.clearance_m = row.thrust_n = row.free_air_thrust_n = not_a_number;
            if (const auto at = places.place(log_s)) {
                row.flown_m =
                    result_.alignment.placed({places.number(*at, 0), places.number(*at, 1), places.number(*at, 2)});
                row.clearance_m = plan_.clearance_m(pose_at(log_s, row.flown_m, planned));
            }
            if (const auto at = commands.place(log_s)) {
                row.thrust_n = 0;
                for (std::size_t rotor = 0; rotor < log_.rotor_commands.width; ++rotor) {
                    row.thrust_n += commanded(commands.number(*at, rotor));
                }
            }
            result_.rows.push_back(row);
        }
    }

    /// A command as a share of the full one, or in newton.
    [[nodiscard]] double commanded(double number) const {
        constexpr double least_pulse_us = 1000, pulse_range_us = 1000;
        return log_.rotor_unit == RotorUnit::microseconds
                   ? std::clamp((number - least_pulse_us) / pulse_range_us, 0.0, 1.0)
                   : number;
    }

    void find_least_clearances() {
        const PlannedMoments moments(planned_);
        LeastClearance& flown = result_.clearance;
        LeastClearance& planned = result_.planned_clearance;
        flown.clearance_m = planned.clearance_m = infinite;
        Vector3 flown_at_m{};
        for (const ComparedRow& row : result_.rows) {
            if (row.clearance_m < flown.clearance_m) {
                flown = {row.clearance_m, row.t_s, {}};
                flown_at_m = row.flown_m;
            }
            const FlightPhase phase = phases_[moments.row(row.t_s)];
            const auto figures = std::ranges::find(result_.phases, phase, &PhaseFigures::phase);
            if (row.clearance_m < figures->min_clearance_m) {
                figures->min_clearance_m = row.clearance_m;
            }
        }
        for (const PlannedRow& row : planned_.rows) {
            if (row.clearance_m < planned.clearance_m) {
                planned = {row.clearance_m, row.t_s, {}};
            }
        }
        if (std::isfinite(flown.clearance_m)) {
            flown.obstacle = plan_.nearest_obstacle(
                pose_at(result_.alignment.log_time(flown.at_s), flown_at_m, planned_.rows[moments.row(flown.at_s)]));
        }
        if (std::isfinite(planned.clearance_m)) {
            const PlannedRow& row = planned_.rows[moments.row(planned.at_s)];
            FlownPose pose;
            pose.position_m = row.position_m;
            pose.attitude = turned_by(row.reference_yaw_rad, {1, 0, 0, 0});
            pose.joints_rad = row.reference_joints_rad;
            planned.obstacle = plan_.nearest_obstacle(pose);
        }
    }

    void weigh_thrust() {
        const bool has_commands =
            std::ranges::any_of(result_.rows, [](const ComparedRow& row) { return std::isfinite(row.thrust_n); });
        if (!has_commands) {
            return;
        }
        const PlannedFlight free = plan_.fly(false);
        const PlannedMoments moments(free);
        ThrustFigures& thrust = result_.thrust.emplace();
        double logged = 0, with = 0, without = 0;
        for (ComparedRow& row : result_.rows) {
            row.free_air_thrust_n =
                row.t_s <= free.rows.back().t_s ? free.rows[moments.row(row.t_s)].thrust_n : not_a_number;
            if (!counts(row)) {
                continue;
            }
            ++thrust.samples;
            logged += row.thrust_n * row.thrust_n;
            with += row.thrust_n * row.planned_thrust_n;
            without += row.thrust_n * row.free_air_thrust_n;
        }
        const bool is_in_newton = log_.rotor_unit == RotorUnit::newton;
        thrust.unit_n = is_in_newton || logged == 0 ? 1 : with / logged;
        const double free_unit_n = is_in_newton || logged == 0 ? 1 : without / logged;
        double with_square = 0, free_square = 0;
        for (ComparedRow& row : result_.rows) {
            if (counts(row)) {
                const double off_n = thrust.unit_n * row.thrust_n - row.planned_thrust_n;
                const double free_off_n = free_unit_n * row.thrust_n - row.free_air_thrust_n;
                with_square += off_n * off_n;
                free_square += free_off_n * free_off_n;
                thrust.mean_logged_n += thrust.unit_n * row.thrust_n;
                thrust.mean_planned_n += row.planned_thrust_n;
                thrust.mean_free_air_n += row.free_air_thrust_n;
            }
            row.thrust_n *= thrust.unit_n;
        }
        const auto samples = static_cast<double>(std::max<std::size_t>(1, thrust.samples));
        thrust.rms_with_effects_n = std::sqrt(with_square / samples);
        thrust.rms_in_free_air_n = std::sqrt(free_square / samples);
        thrust.mean_logged_n /= samples;
        thrust.mean_planned_n /= samples;
        thrust.mean_free_air_n /= samples;
    }

    static bool counts(const ComparedRow& row) {
        return std::isfinite(row.thrust_n) && std::isfinite(row.free_air_thrust_n);
    }

    void compare_with_worlds() {
        EnvelopeFigures& figures = result_.envelope.emplace();
        figures.envelope = world_envelope(plan_, planned_.tick_s, options_.worlds);
        const WorldEnvelope& envelope = figures.envelope;
        figures.expected_axis_share = 2 / (static_cast<double>(envelope.flown) + 1);
        std::size_t covered = 0, outside = 0;
        for (const ComparedRow& row : result_.rows) {
            const auto tick = static_cast<std::size_t>(std::llround(row.t_s / envelope.tick_s));
            if (!std::isfinite(row.flown_m[0]) || tick >= envelope.low_m.size()) {
                continue;
            }
            ++covered;
            OutsideTime here{row.t_s, row.t_s, 0, 0};
            for (std::size_t axis = 0; axis < 3; axis += plan_.is_in_plane() ? 2 : 1) {
                const double excess_m = std::max(envelope.low_m[tick][axis] - row.flown_m[axis],
                                                 row.flown_m[axis] - envelope.high_m[tick][axis]);
                if (excess_m > here.excess_m) {
                    here.excess_m = excess_m;
                    here.axis = axis;
                }
            }
            if (here.excess_m > 0) {
                ++outside;
                add_outside(figures.outside, here);
            }
        }
        figures.share = covered == 0 ? 0 : static_cast<double>(outside) / static_cast<double>(covered);
    }

    static void add_outside(std::vector<OutsideTime>& times, const OutsideTime& here) {
        constexpr double same_s = 0.2;
        if (times.empty() || here.begin_s - times.back().end_s >= same_s) {
            times.push_back(here);
            return;
        }
        OutsideTime& last = times.back();
        last.end_s = here.end_s;
        if (here.excess_m > last.excess_m) {
            last.excess_m = here.excess_m;
            last.axis = here.axis;
        }
    }

    FlightLog log_;
    const ComparedPlan& plan_;
    const ComparisonOptions& options_;
    PlannedFlight planned_;
    std::vector<FlightPhase> phases_;
    LogCursor attitude_{log_.attitude}, joints_{log_.joints_rad};
    LogComparison result_;
};

}  // namespace

LogComparison compare(FlightLog log, const ComparedPlan& plan, const ComparisonOptions& options) {
    return Comparison(std::move(log), plan, options).compare();
}

}  // namespace downwash
