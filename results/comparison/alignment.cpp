#include "downwash/comparison/alignment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/comparison/speed_match.hpp"
#include "downwash/scene/space_pose.hpp"

namespace downwash {
namespace {

constexpr std::size_t fitted_points = 1500;
constexpr double least_spread_m = 0.1;  ///< of places that tell a yaw
constexpr double least_covered = 0.2;   ///< of a plan, for anything to be said
constexpr double golden = 0.6180339887498949;

/// Places of the plan, and those that the log has at the same time.
struct Pairs {
    std::vector<Vector3> planned, logged;
    std::size_t wanted = 0;
};

Pairs pairs_of(const FlightLog& log, const PlannedFlight& planned, double offset_s, double rate) {
    Pairs pairs;
    LogCursor cursor(log.position_m);
    const std::size_t step = std::max<std::size_t>(1, planned.rows.size() / fitted_points);
    for (std::size_t i = 0; i < planned.rows.size(); i += step) {
        ++pairs.wanted;
        if (const auto at = cursor.place(offset_s + rate * planned.rows[i].t_s)) {
            pairs.planned.push_back(planned.rows[i].position_m);
            pairs.logged.push_back({cursor.number(*at, 0), cursor.number(*at, 1), cursor.number(*at, 2)});
        }
    }
    return pairs;
}

/// How well a time fits: what is left, and more for what of the plan is not covered.
struct Trial {
    double score = std::numeric_limits<double>::infinity();
    YawFit fit;
    double covered = 0;
};

Trial trial_of(const FlightLog& log, const PlannedFlight& planned, const AlignmentOptions& options, double offset_s,
               double rate) {
    const Pairs pairs = pairs_of(log, planned, offset_s, rate);
    Trial trial;
    trial.covered =
        static_cast<double>(pairs.planned.size()) / static_cast<double>(std::max<std::size_t>(pairs.wanted, 1));
    if (trial.covered < least_covered) {
        return trial;
    }
    if (options.is_in_world) {
        double sum = 0;
        for (std::size_t i = 0; i < pairs.planned.size(); ++i) {
            const Vector3 apart_m = pairs.planned[i] - pairs.logged[i];
            sum += dot(apart_m, apart_m);
        }
        trial.fit.residual_m = std::sqrt(sum / static_cast<double>(pairs.planned.size()));
    } else {
        trial.fit = fit_yaw(pairs.logged, pairs.planned);
    }
    trial.score = trial.fit.residual_m / trial.covered;
    return trial;
}

/// The least of a function between two numbers, if it has one valley there.
template <class Function>
double least_between(double low, double high, double tolerance, const Function& function) {
    double left = high - golden * (high - low), right = low + golden * (high - low);
    double at_left = function(left), at_right = function(right);
    while (high - low > tolerance) {
        if (at_left <= at_right) {
            high = std::exchange(right, left);
            at_right = at_left;
            left = high - golden * (high - low);
            at_left = function(left);
        } else {
            low = std::exchange(left, right);
            at_left = at_right;
            right = low + golden * (high - low);
            at_right = function(right);
        }
    }
    return 0.5 * (low + high);
}

/// Says that the plan may have been flown more than once in the log.
void remark_on_others(const std::vector<std::pair<double, double>>& tried, double duration_s, double best,
                      LogAlignment& found) {
    constexpr double as_good = 3, least_m = 0.05;
    for (const auto& [offset_s, score] : tried) {
        if (std::abs(offset_s - found.offset_s) >= 0.5 * duration_s && score < as_good * best + least_m) {
            found.remarks.push_back("the log has another flight much like the plan: --time-offset " +
                                    to_fixed_text(offset_s, 2) + " compares that one");
            return;
        }
    }
}

/// Time and frame with the log's axes as they are.
LogAlignment aligned(const FlightLog& log, const PlannedFlight& planned, const AlignmentOptions& options) {
    LogAlignment found;
    const double duration_s = planned.rows.back().t_s;
    const auto score = [&](double offset_s, double rate) {
        return trial_of(log, planned, options, offset_s, rate).score;
    };
    if (options.offset_s) {
        found.offset_s = *options.offset_s;
    } else {
        const SpeedMatches matches = match_speeds(log, planned);
        double best = std::numeric_limits<double>::infinity();
        std::vector<std::pair<double, double>> tried;  // offsets and scores
        for (const SpeedMatch& match : matches.best) {
            const double offset_s =
                least_between(match.offset_s - 2 * matches.step_s, match.offset_s + 2 * matches.step_s, 1e-4,
                              [&](double each_s) { return score(each_s, 1); });
            const double left = score(offset_s, 1);
            tried.emplace_back(offset_s, left);
            if (left < best) {
                best = left;
                found.offset_s = offset_s;
                found.correlation = match.correlation;
            }
        }
        found.is_time_fitted = true;
        remark_on_others(tried, duration_s, best, found);
        // A clock that drifts: about the middle of the plan, rate and offset do not disturb each other.
        constexpr double least_duration_s = 10, max_drift = 0.01, least_gain = 0.9, seen_s = 0.02;
        if (duration_s >= least_duration_s) {
            const double middle_s = 0.5 * duration_s;
            double at_middle_s = found.offset_s + middle_s, rate = 1;
            for (int i = 0; i < 3; ++i) {
                rate = least_between(1 - max_drift, 1 + max_drift, 1e-6,
                                     [&](double each) { return score(at_middle_s - each * middle_s, each); });
                at_middle_s = least_between(at_middle_s - 0.2, at_middle_s + 0.2, 1e-4,
                                            [&](double each_s) { return score(each_s - rate * middle_s, rate); });
            }
            const double offset_s = at_middle_s - rate * middle_s;
            if (score(offset_s, rate) < least_gain * best && std::abs(rate - 1) * duration_s > seen_s) {
                found.rate = rate;
                found.offset_s = offset_s;
                found.is_rate_fitted = true;
            }
        }
    }
    const Trial trial = trial_of(log, planned, options, found.offset_s, found.rate);
    found.covered = trial.covered;
    found.residual_m = trial.score < std::numeric_limits<double>::infinity() ? trial.fit.residual_m
                                                                             : std::numeric_limits<double>::infinity();
    found.yaw_rad = trial.fit.yaw_rad;
    found.shift_m = trial.fit.shift_m;
    found.is_frame_fitted = !options.is_in_world;
    if (found.is_frame_fitted && trial.covered >= least_covered && trial.fit.spread_m < least_spread_m) {
        const Pairs pairs = pairs_of(log, planned, found.offset_s, found.rate);
        const double yaw_rad = yaw_by_attitude(log, planned, found.offset_s, found.rate).value_or(0);
        const YawFit fit = fit_yaw(pairs.logged, pairs.planned, yaw_rad);
        found.yaw_rad = yaw_rad;
        found.shift_m = fit.shift_m;
        found.residual_m = fit.residual_m;
        found.remarks.push_back(
            "the plan stays within " + to_fixed_text(least_spread_m, 1) +
            " m of a vertical line, which tells no yaw between the frames: it is " +
            (log.attitude.empty() ? "taken for 0" : "that between the attitude in the log and the plan's yaw"));
    }
    return found;
}

}  // namespace

Vector3 LogAlignment::turned(const Vector3& of_log) const noexcept {
    const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
    return {c * of_log[0] - s * of_log[1], s * of_log[0] + c * of_log[1], of_log[2]};
}

YawFit fit_yaw(std::span<const Vector3> from, std::span<const Vector3> onto, std::optional<double> yaw_rad) {
    const auto middle_of = [](std::span<const Vector3> points) {
        Vector3 sum{};
        for (const Vector3& point : points) {
            sum = sum + point;
        }
        return (1 / static_cast<double>(points.size())) * sum;
    };
    const Vector3 from_middle = middle_of(from), onto_middle = middle_of(onto);
    double along = 0, across = 0, spread = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        const Vector3 a = from[i] - from_middle, b = onto[i] - onto_middle;
        along += a[0] * b[0] + a[1] * b[1];
        across += a[0] * b[1] - a[1] * b[0];
        spread += b[0] * b[0] + b[1] * b[1];
    }
    YawFit fit;
    fit.yaw_rad = yaw_rad.value_or(std::atan2(across, along));
    const double c = std::cos(fit.yaw_rad), s = std::sin(fit.yaw_rad);
    const auto turned = [c, s](const Vector3& v) { return Vector3{c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]}; };
    fit.shift_m = onto_middle - turned(from_middle);
    double sum = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        const Vector3 left = turned(from[i]) + fit.shift_m - onto[i];
        sum += dot(left, left);
    }
    const auto count = static_cast<double>(from.size());
    fit.residual_m = std::sqrt(sum / count);
    fit.spread_m = std::sqrt(spread / count);
    return fit;
}

LogAlignment align(const FlightLog& log, const PlannedFlight& planned, const AlignmentOptions& options) {
    LogAlignment best = aligned(log, planned, options);
    if (log.axes_source == AxesSource::guessed) {
        FlightLog other;
        other.position_m = log.position_m;
        other.velocity_m_s = log.velocity_m_s;
        other.attitude = log.attitude;
        turn_over(other);
        LogAlignment turned = aligned(other, planned, options);
        turned.is_turned_over = true;
        const double ratio =
            std::max(best.residual_m, turned.residual_m) / std::max(std::min(best.residual_m, turned.residual_m), 1e-9);
        if (turned.residual_m < best.residual_m) {
            best = std::move(turned);
        }
        constexpr double is_clear = 1.5;
        best.remarks.push_back(
            "no option and no name says whether the log's z points up or down: " +
            std::string((log.recorded_axes == LogAxes::down) != best.is_turned_over ? "down" : "up") +
            (ratio > is_clear ? " fits the plan" : " fits the plan hardly better than the other; --axes says it"));
    }
    constexpr double likely = 0.5;
    if (best.is_time_fitted && best.correlation < likely) {
        best.remarks.emplace_back(
            "the speeds in the log hardly resemble those of the plan: is it the log of this flight?");
    }
    if (!(best.covered >= least_covered)) {
        throw_input_error("the log has a position during " + to_fixed_text(100 * best.covered, 0) +
                          " % of the plan: expected " + to_fixed_text(100 * least_covered, 0) +
                          " % or more; is it the log of this flight? --time-offset says where in it the plan begins");
    }
    return best;
}

}  // namespace downwash
