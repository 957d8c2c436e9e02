#include <catch2/catch.hpp>

#include "space_loop.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr double degree = 0.017453292519943295;

/// A quaternion product, scalar first.
struct Quaternion {
    double w, x, y, z;
    friend Quaternion operator*(const Quaternion& a, const Quaternion& b) {
        return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z, a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x};
    }
    [[nodiscard]] Quaternion inversed() const { return {w, -x, -y, -z}; }
    [[nodiscard]] dynamics::LaneVector<double> z_axis() const {
        return {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)};
    }
};

/// The error of AttitudeControl::update() in PX4-Autopilot, src/modules/mc_att_control/AttitudeControl, in its words:
/// Nonlinear Quadrocopter Attitude Control (Brescianini, Hehn and D'Andrea 2013).
dynamics::LaneVector<double> px4_error(const Quaternion& q, const Quaternion& qd_full, double yaw_weight) {
    const auto e_z = q.z_axis();
    const auto e_z_d = qd_full.z_axis();
    const double d = dot(e_z, e_z_d);
    const auto c = cross(e_z, e_z_d);
    const double w = std::sqrt((1 + d) / 2);
    Quaternion qd_red{w, c.x / (2 * w), c.y / (2 * w), c.z / (2 * w)};
    qd_red = qd_red * q;
    Quaternion q_mix = qd_red.inversed() * qd_full;
    if (q_mix.w < 0) {
        q_mix = {-q_mix.w, -q_mix.x, -q_mix.y, -q_mix.z};
    }
    const double mix_w = std::clamp(q_mix.w, -1.0, 1.0);
    const double mix_z = std::clamp(q_mix.z, -1.0, 1.0);
    const Quaternion qd =
        qd_red * Quaternion{std::cos(yaw_weight * std::acos(mix_w)), 0, 0, std::sin(yaw_weight * std::asin(mix_z))};
    const Quaternion qe = q.inversed() * qd;
    const double sign = qe.w < 0 ? -2 : 2;
    return {sign * qe.x, sign * qe.y, sign * qe.z};
}

/// A wanted attitude: ControlMath::bodyzToAttitude(), here with z up.
Quaternion attitude_to(const dynamics::LaneVector<double>& z, double yaw_rad) {
    const dynamics::LaneVector<double> y_c{-std::sin(yaw_rad), std::cos(yaw_rad), 0};
    auto x = cross(y_c, z);
    x = (1 / std::sqrt(dot(x, x))) * x;
    const auto y = cross(z, x);
    const double w = 0.5 * std::sqrt(std::max(0.0, 1 + x.x + y.y + z.z));
    return {w, (y.z - z.y) / (4 * w), (z.x - x.z) / (4 * w), (x.y - y.x) / (4 * w)};
}

template <int n>
void check_flight() {
    const SpaceLawModel<n> nominal = law_model_of<n>(hexarotor(n));
    const auto start = hovering<n>(nominal.plant);
    for (const Px4Cascade& law : {Px4Cascade{}, cascade_gains_for(0.02, {})}) {
        BasicSpacePoint<double, n> home{};
        const auto hover = fly(
            law, nominal, nominal.plant, start, [&](int) { return home; }, 1000);
        CHECK(off_m<n>(hover.state, home) < 1e-2);
        CHECK(hover.max_saturation < 1);
        BasicSpacePoint<double, n> there{};
        const double at[] = {1.5, -1, 0.7, 1.5, 0.3, -0.2, 0.2};
        std::copy(at, at + 4 + n, there.position);
        const auto end = fly(
                             law, nominal, nominal.plant, start, [&](int) { return there; }, 2500)
                             .state;
        CHECK(off_m<n>(end, there) < 2e-2);
        CHECK(std::remainder(yaw_of<n>(end) - 1.5, 360 * degree) == Approx(0).margin(0.02));
        for (int i = 0; i < n; ++i) {
            CHECK(end.q[7 + i] == Approx(there.position[4 + i]).margin(0.02));
        }
        // A circle of 1 m at 0.8 rad/s while it turns once in 20 s.
        double worst = 0;
        const auto circle = [&](int tick) {
            const double t = tick * space_tick_s;
            const double w = 0.8;
            BasicSpacePoint<double, n> point{};
            point.position[0] = std::cos(w * t) - 1;
            point.position[1] = std::sin(w * t);
            point.velocity[0] = -w * std::sin(w * t);
            point.velocity[1] = w * std::cos(w * t);
            point.acceleration[0] = -w * w * std::cos(w * t);
            point.acceleration[1] = -w * w * std::sin(w * t);
            point.position[3] = 0.31 * t;
            point.velocity[3] = 0.31;
            return point;
        };
        for (int ticks = 1000; ticks <= 2000; ticks += 250) {
            const auto flown = fly(law, nominal, nominal.plant, start, circle, ticks).state;
            worst = std::max(worst, off_m<n>(flown, circle(ticks)));
            CHECK(std::remainder(yaw_of<n>(flown) - circle(ticks).position[3], 360 * degree) == Approx(0).margin(0.1));
        }
        CAPTURE(n, worst);
        CHECK(worst < 0.15);
    }
}

}  // namespace

TEST_CASE("The attitude error of the cascade is that of PX4's formulas") {
    Random random(3);
    double worst = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        double q[4];
        double size = 0;
        for (double& number : q) {
            number = random.uniform(-1, 1);
            size += number * number;
        }
        for (double& number : q) {
            number /= std::sqrt(size);
        }
        const double tilt = random.uniform(0, 0.8);
        const double to = random.uniform(-3, 3);
        const double yaw = random.uniform(-3, 3);
        const dynamics::LaneVector<double> wanted{std::sin(tilt) * std::cos(to), std::sin(tilt) * std::sin(to),
                                                  std::cos(tilt)};
        const auto attitude = dynamics::rotation_of(q);
        if (1 + dot(attitude.third, wanted) < 1e-3) {
            continue;  // opposite: PX4 then takes the whole attitude
        }
        const controllers::ThrustDirections<double> thrust{{0, 0, 1}, wanted};
        const auto error = controllers::yaw_error(attitude, thrust, controllers::heading_at(yaw));
        const auto found = controllers::weighted_attitude_error(attitude, thrust, error.angle_rad, 0.4);
        const auto expected = px4_error({q[0], q[1], q[2], q[3]}, attitude_to(wanted, yaw), 0.4);
        worst = std::max(
            {worst, std::abs(found.x - expected.x), std::abs(found.y - expected.y), std::abs(found.z - expected.z)});
    }
    CHECK(worst < 1e-6);
}

TEST_CASE("PX4's cascade hovers, takes a step and follows a circle, with an arm of 0 to 3 joints") {
    check_flight<0>();
    check_flight<1>();
    check_flight<2>();
    check_flight<3>();
}
