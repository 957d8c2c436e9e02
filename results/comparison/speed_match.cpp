#include "downwash/comparison/speed_match.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "downwash/base/key_error.hpp"
#include "downwash/scene/space_pose.hpp"

namespace downwash {
namespace {

constexpr double usual_step_s = 0.04;
constexpr double max_products = 4e8;
constexpr std::size_t max_matches = 5;

/// Horizontal and vertical speed at even times [m/s].
struct Speeds {
    std::vector<float> horizontal, vertical;

    void add(const Vector3& velocity_m_s, bool has_sign) {
        horizontal.push_back(static_cast<float>(std::hypot(velocity_m_s[0], velocity_m_s[1])));
        vertical.push_back(static_cast<float>(has_sign ? velocity_m_s[2] : std::abs(velocity_m_s[2])));
    }
};

Speeds speeds_of(const PlannedFlight& planned, double step_s, bool has_sign) {
    Speeds speeds;
    const auto ticks = std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(step_s / planned.tick_s)));
    for (std::size_t i = 0; i + ticks < planned.rows.size(); i += ticks) {
        const PlannedRow &here = planned.rows[i], &next = planned.rows[i + ticks];
        speeds.add((1 / (next.t_s - here.t_s)) * (next.position_m - here.position_m), has_sign);
    }
    return speeds;
}

/// The mean velocity over each step from places, as of the plan; 0 where the log has none.
Speeds speeds_of(const FlightLog& log, double first_s, std::size_t count, double step_s, bool has_sign) {
    Speeds speeds;
    LogCursor cursor(log.position_m);
    std::optional<Vector3> before;
    for (std::size_t i = 0; i <= count; ++i) {
        std::optional<Vector3> here;
        if (const auto at = cursor.place(first_s + static_cast<double>(i) * step_s)) {
            here = Vector3{cursor.number(*at, 0), cursor.number(*at, 1), cursor.number(*at, 2)};
        }
        if (i > 0) {
            speeds.add(here && before ? (1 / step_s) * (*here - *before) : Vector3{}, has_sign);
        }
        before = here;
    }
    return speeds;
}

double energy_of(const Speeds& speeds, std::size_t i) {
    return static_cast<double>(speeds.horizontal[i]) * speeds.horizontal[i] +
           static_cast<double>(speeds.vertical[i]) * speeds.vertical[i];
}

float product(const float* a, const float* b, std::size_t count) {
    std::array<float, 8> sums{};
    std::size_t i = 0;
    for (; i + sums.size() <= count; i += sums.size()) {
        for (std::size_t k = 0; k < sums.size(); ++k) {
            sums[k] += a[i + k] * b[i + k];
        }
    }
    for (; i < count; ++i) {
        sums[0] += a[i] * b[i];
    }
    float sum = 0;
    for (const float each : sums) {
        sum += each;
    }
    return sum;
}

}  // namespace

SpeedMatches match_speeds(const FlightLog& log, const PlannedFlight& planned) {
    const bool has_sign = log.axes_source != AxesSource::guessed;
    const double plan_s = planned.rows.back().t_s;
    // Half of the plan may be before the log or behind it.
    const double first_s = log.position_m.t_s.front() - 0.5 * plan_s;
    const double span_s = log.position_m.t_s.back() - log.position_m.t_s.front() + plan_s;
    SpeedMatches matches;
    const double step_s = std::max(usual_step_s, std::sqrt(plan_s * span_s / max_products));
    matches.step_s = std::max(1.0, std::round(step_s / planned.tick_s)) * planned.tick_s;
    const Speeds plan = speeds_of(planned, matches.step_s, has_sign);
    const auto count = static_cast<std::size_t>(span_s / matches.step_s) + 1;
    const Speeds flown = speeds_of(log, first_s, count, matches.step_s, has_sign);

    const std::size_t length = plan.horizontal.size();
    double plan_energy = 0;
    for (std::size_t i = 0; i < length; ++i) {
        plan_energy += energy_of(plan, i);
    }
    constexpr double least_speed_m_s = 0.01;
    if (length == 0 || plan_energy < least_speed_m_s * least_speed_m_s * static_cast<double>(length)) {
        throw_input_error("the plan does not move, and nothing tells where it is in the log: --time-offset says it");
    }
    std::vector<double> energy_before(count + 1, 0);
    for (std::size_t i = 0; i < count; ++i) {
        energy_before[i + 1] = energy_before[i] + energy_of(flown, i);
    }
    std::vector<SpeedMatch> all;
    for (std::size_t lag = 0; lag + length <= count; ++lag) {
        const double sum = static_cast<double>(product(plan.horizontal.data(), flown.horizontal.data() + lag, length)) +
                           static_cast<double>(product(plan.vertical.data(), flown.vertical.data() + lag, length));
        const double energy = energy_before[lag + length] - energy_before[lag];
        all.push_back({first_s + static_cast<double>(lag) * matches.step_s, 2 * sum / (plan_energy + energy)});
    }
    if (all.empty()) {
        all.push_back({log.position_m.t_s.front(), 0});
    }
    // The best, then the best of what is a second or more from it.
    constexpr double apart_s = 1;
    std::vector<SpeedMatch> sorted = all;
    std::ranges::sort(sorted, [](const SpeedMatch& a, const SpeedMatch& b) { return a.correlation > b.correlation; });
    for (const SpeedMatch& match : sorted) {
        const bool is_apart = std::ranges::all_of(matches.best, [&match](const SpeedMatch& other) {
            return std::abs(other.offset_s - match.offset_s) >= apart_s;
        });
        if (is_apart) {
            matches.best.push_back(match);
        }
        if (matches.best.size() == max_matches) {
            break;
        }
    }
    const double best_s = matches.best.front().offset_s;
    const auto other = std::ranges::find_if(
        sorted, [&](const SpeedMatch& match) { return std::abs(match.offset_s - best_s) >= 0.5 * plan_s; });
    if (other != sorted.end()) {
        matches.best.push_back(*other);
    }
    return matches;
}

std::optional<double> yaw_by_attitude(const FlightLog& log, const PlannedFlight& planned, double offset_s,
                                      double rate) {
    LogCursor cursor(log.attitude);
    double cosines = 0, sines = 0;
    for (const PlannedRow& row : planned.rows) {
        if (const auto at = cursor.place(offset_s + rate * row.t_s)) {
            const Matrix3 rotation = rotation_of(
                {cursor.number(*at, 0), cursor.number(*at, 1), cursor.number(*at, 2), cursor.number(*at, 3)});
            const double apart_rad = row.reference_yaw_rad - std::atan2(rotation[1][0], rotation[0][0]);
            cosines += std::cos(apart_rad);
            sines += std::sin(apart_rad);
        }
    }
    return cosines == 0 && sines == 0 ? std::nullopt : std::optional(std::atan2(sines, cosines));
}

}  // namespace downwash
