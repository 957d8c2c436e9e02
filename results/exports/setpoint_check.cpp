#include "downwash/exports/setpoint_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/exports/formats.hpp"
#include "downwash/exports/setpoint_file.hpp"
#include "downwash/exports/setpoint_remedies.hpp"

namespace downwash {
namespace {

constexpr double whole_turn_rad = 2 * std::numbers::pi;
/// Over so long accelerations are integrated: an error of 0.02 m/s2 makes 1 cm.
constexpr double window_s = 1;
/// The same for what is held against the plan without integration, to find a remedy.
constexpr double rate_tolerance = 2 * max_setpoint_distance_m / (window_s * window_s);

/// One coordinate of a set-point with its derivatives.
struct Motion {
    double at = 0, rate = 0, acceleration = 0;
};

/// Coordinates of which a distance is taken together: a place, or an angle.
struct Quantity {
    std::string name, rate_name, acceleration_name;
    std::size_t size = 1;
    std::function<std::array<Motion, 3>(const Setpoint&)> of;
    bool is_angle = true;
    bool is_round = false;  ///< whole turns do not count
    bool has_rate = true, has_acceleration = true;
};

Quantity place() {
    return {.name = "position",
            .rate_name = "velocity",
            .acceleration_name = "acceleration",
            .size = 3,
            .of =
                [](const Setpoint& p) {
                    std::array<Motion, 3> motions;
                    for (std::size_t i = 0; i < motions.size(); ++i) {
                        motions[i] = {p.position_m[i], p.velocity_m_s[i], p.acceleration_m_s2[i]};
                    }
                    return motions;
                },
            .is_angle = false};
}

Quantity yaw(bool has_rate, bool has_acceleration) {
    return {
        .name = "yaw",
        .rate_name = "yaw rate",
        .acceleration_name = "yaw acceleration",
        .of =
            [](const Setpoint& p) {
                return std::array{Motion{p.yaw_rad, p.yaw_rate_rad_s, p.yaw_acceleration_rad_s2}, Motion{}, Motion{}};
            },
        .is_round = true,
        .has_rate = has_rate,
        .has_acceleration = has_acceleration};
}

Quantity joint(const std::string& name, std::size_t index) {
    return {.name = name,
            .rate_name = name + " rate",
            .acceleration_name = name + " acceleration",
            .of = [index](const Setpoint& p) {
                const JointSetpoint& of = p.joints[index];
                return std::array{Motion{of.angle_rad, of.rate_rad_s, of.acceleration_rad_s2}, Motion{}, Motion{}};
            }};
}

/// The greatest of some distances, and where the first stands that is too large.
struct Greatest {
    double value = 0;
    std::optional<std::size_t> first_too_large = {};

    void add(std::size_t point, double distance, double limit) {
        value = std::max(value, distance);
        if (!first_too_large && !(distance <= limit)) {
            first_too_large = point;
        }
    }
};

/// The set-points of a file beside those of the plan at the same times, in the same frame.
struct Pairs {
    const SetpointFile& file;
    std::vector<Setpoint> plan;
};

/// Integrals of one coordinate.
struct Integral {
    double at = 0;                       ///< the rate, from the first set-point on
    double excess_rate = 0, excess = 0;  ///< what the acceleration exceeds the plan's by, once and twice, in its window

    /// @param h length of a step [s]   @param a,b motions in the file at its ends
    /// @param excess_a,excess_b what their accelerations exceed those of the plan by
    void add(double h, const Motion& a, const Motion& b, double excess_a, double excess_b, bool knows_acceleration) {
        // The trapezoidal rule, and its correction by the derivatives at the ends (Euler and Maclaurin).
        at += h * (a.rate + b.rate) / 2;
        at += knows_acceleration ? h * h * (a.acceleration - b.acceleration) / 12 : 0;
        // Exact where the acceleration is straight.
        excess += h * excess_rate + h * h * (2 * excess_a + excess_b) / 6;
        excess_rate += h * (excess_a + excess_b) / 2;
    }
};

class QuantityCheck {
 public:
    QuantityCheck(const Quantity& quantity, const Pairs& pairs) : quantity_(quantity), pairs_(pairs) { compare(); }

    [[nodiscard]] SetpointDistance distance() const {
        const auto if_there = [](bool is_there, const Greatest& of) {
            return is_there ? std::optional(of.value) : std::nullopt;
        };
        return {quantity_.name, quantity_.is_angle, at_.value, if_there(quantity_.has_rate, rate_),
                if_there(quantity_.has_acceleration, acceleration_)};
    }

    void add_findings(LineErrors& findings) const {
        add_finding(findings, at_, quantity_.name, &Motion::at);
        if (quantity_.has_rate) {
            add_finding(findings, rate_, quantity_.rate_name + ", integrated from the start,", &Motion::rate);
        }
        if (quantity_.has_acceleration) {
            add_finding(findings, acceleration_, quantity_.acceleration_name + ", integrated twice over a second,",
                        &Motion::acceleration);
        }
    }

 private:
    [[nodiscard]] double limit() const {
        return quantity_.is_angle ? max_setpoint_distance_rad : max_setpoint_distance_m;
    }
    [[nodiscard]] double difference(double a, double b) const {
        return quantity_.is_round ? std::remainder(a - b, whole_turn_rad) : a - b;
    }

    void compare() {
        const std::vector<Setpoint>& points = pairs_.file.points;
        std::array<Integral, 3> integrals{};
        std::array<Motion, 3> before = quantity_.of(points[0]), plan_before = quantity_.of(pairs_.plan[0]);
        for (std::size_t k = 0; k < quantity_.size; ++k) {
            integrals[k].at = plan_before[k].at;
        }
        double window_end_s = window_s;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const std::array<Motion, 3> now = quantity_.of(points[i]), plan_now = quantity_.of(pairs_.plan[i]);
            const double h = i > 0 ? points[i].t_s - points[i - 1].t_s : 0;
            Vector3 off{}, rate_off{}, acceleration_off{};
            for (std::size_t k = 0; k < quantity_.size; ++k) {
                integrals[k].add(h, before[k], now[k], before[k].acceleration - plan_before[k].acceleration,
                                 now[k].acceleration - plan_now[k].acceleration, quantity_.has_acceleration);
                off[k] = difference(now[k].at, plan_now[k].at);
                rate_off[k] = difference(integrals[k].at, plan_now[k].at);
                acceleration_off[k] = integrals[k].excess;
            }
            at_.add(i, length(off), limit());
            rate_.add(i, length(rate_off), limit());
            acceleration_.add(i, length(acceleration_off), limit());
            if (points[i].t_s >= window_end_s) {
                window_end_s = points[i].t_s + window_s;
                for (Integral& integral : integrals) {
                    integral.excess = integral.excess_rate = 0;
                }
            }
            before = now;
            plan_before = plan_now;
        }
    }

    static double length(const Vector3& v) { return std::hypot(v[0], v[1], v[2]); }

    void add_finding(LineErrors& findings, const Greatest& greatest, const std::string& name,
                     double Motion::*number) const {
        if (!greatest.first_too_large) {
            return;
        }
        const std::size_t first = *greatest.first_too_large;
        const std::string distance = quantity_.is_angle ? to_text(greatest.value * degrees_per_radian, 3) + " degrees"
                                                        : to_text(greatest.value, 3) + " m";
        pairs_.file.add(findings, first,
                        name + " does not fit the plan from " + to_fixed_text(pairs_.file.points[first].t_s, 3) +
                            " s on: " + distance + " off at most" + remedy(number));
    }

    /// One number of all set-points, of each coordinate.
    [[nodiscard]] std::vector<Vector3> vectors(const std::vector<Setpoint>& points, double Motion::*number) const {
        std::vector<Vector3> all;
        all.reserve(points.size());
        for (const Setpoint& point : points) {
            const std::array<Motion, 3> motions = quantity_.of(point);
            all.push_back({motions[0].*number, motions[1].*number, motions[2].*number});
        }
        return all;
    }
    /// The same of the only coordinate.
    [[nodiscard]] std::vector<double> numbers(const std::vector<Setpoint>& points, double Motion::*number) const {
        std::vector<double> all;
        all.reserve(points.size());
        for (const Setpoint& point : points) {
            all.push_back(quantity_.of(point)[0].*number);
        }
        return all;
    }

    /// How one of the numbers would fit.
    [[nodiscard]] std::string remedy(double Motion::*number) const {
        const bool is_at = number == &Motion::at;
        const std::vector<Setpoint>&found = pairs_.file.points, &expected = pairs_.plan;
        if (quantity_.size > 1) {
            return axes_remedy(vectors(found, number), vectors(expected, number), is_at ? limit() : rate_tolerance,
                               is_at);
        }
        return is_at ? angle_remedy(numbers(found, number), numbers(expected, number), limit())
                     : rate_remedy(numbers(found, number), numbers(expected, number), rate_tolerance);
    }

    const Quantity& quantity_;
    const Pairs& pairs_;
    Greatest at_, rate_, acceleration_;
};

std::vector<Quantity> quantities_of(const SetpointFile& file, const std::vector<JointInWorld>& joints) {
    std::vector<Quantity> quantities{place(), yaw(file.has_yaw_rate, file.has_yaw_acceleration)};
    for (std::size_t i = 0; i < joints.size() && file.has_arm; ++i) {
        quantities.push_back(joint(joints[i].name, i));
    }
    return quantities;
}

void check_yaw_range(const SetpointFile& file, LineErrors& findings) {
    constexpr double rounding_rad = 1e-6;  // of single precision
    const auto is_beyond = [](const Setpoint& point) {
        return !(std::abs(point.yaw_rad) <= std::numbers::pi + rounding_rad);
    };
    const auto beyond = std::ranges::find_if(file.points, is_beyond);
    if (file.frame == SetpointFrame::north_east_down && beyond != file.points.end()) {
        file.add(findings, static_cast<std::size_t>(beyond - file.points.begin()),
                 "yaw is " + to_text(beyond->yaw_rad, 6) + " rad: expected -pi to pi");
    }
}

void check_end(const SetpointFile& file, const WayInWorld& plan, LineErrors& findings) {
    const double end_s = file.points.back().t_s;
    if (end_s < plan.duration_s() - plan.tick_s) {
        file.add(findings, file.points.size() - 1,
                 "the set-points end at " + to_fixed_text(end_s, 3) + " s, but the plan at " +
                     to_fixed_text(plan.duration_s(), 3) + " s");
    }
}

SetpointCheck checked(const RunInWorld& run, std::string_view text, const std::string& name, double bearing_deg) {
    const WayInWorld& plan = plan_to_be_flown(run);
    const SetpointFile file = read_setpoint_file(text, name, run.joints, run.turns);
    const SetpointAxes axes(file.frame, bearing_deg);
    Pairs pairs{file, {}};
    pairs.plan.reserve(file.points.size());
    for (const Setpoint& point : file.points) {
        pairs.plan.push_back(axes.of(plan.at(point.t_s)));
    }
    SetpointCheck check{.format = file.format,
                        .count = file.points.size(),
                        .duration_s = file.points.back().t_s,
                        .has_arm = file.has_arm || run.joints.empty()};
    LineErrors findings(name);
    for (const Quantity& quantity : quantities_of(file, run.joints)) {
        const QuantityCheck one(quantity, pairs);
        check.distances.push_back(one.distance());
        one.add_findings(findings);
    }
    check_yaw_range(file, findings);
    check_end(file, plan, findings);
    for (const KeyError& finding : findings.errors()) {
        check.findings.push_back(finding.message);
    }
    return check;
}

}  // namespace

SetpointCheck check_setpoints(const RunRecord& run, std::string_view text, const std::string& file,
                              double bearing_deg) {
    return checked(in_world(run), text, file, bearing_deg);
}

SetpointCheck check_setpoints(const SpaceRunRecord& run, std::string_view text, const std::string& file,
                              double bearing_deg) {
    return checked(in_world(run), text, file, bearing_deg);
}

}  // namespace downwash
