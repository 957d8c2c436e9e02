#include "downwash/studies/disturbance_test_bench.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "downwash/dynamics/pitch_bench.hpp"
#include "downwash/dynamics/quadrotor.hpp"
#include "downwash/effects/effect_curve.hpp"
#include "downwash/studies/planar_flight.hpp"

namespace downwash::studies {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double tick_s = 0.01;
constexpr double plate_from_s = 5, plate_to_s = 20, end_s = 30;
constexpr int rotor_over_plate = 1;  // in front: see make_quadrotor()
constexpr double observer_gain_1_s = 10;

enum class Help : std::uint8_t { none, feed_forward, observer };

struct BenchExperiment {
    PlanarVehicle vehicle;
    PlanarControl control;
    double rate_ki = 0;  ///< integral of the pitch rate error [1/s2]
    SurfaceEffect ground;
    double z_over_r = 2;  ///< of the level vehicle
    double friction_nm_s_rad = 0.002;
    Help help = Help::none;
};

struct BenchFlight {
    std::vector<double> time_s, pitch_deg;

    [[nodiscard]] double at(double s) const { return pitch_deg[static_cast<std::size_t>(std::lround(s / tick_s))]; }
    [[nodiscard]] double peak(double from_s, double to_s) const {
        double peak_deg = 0;
        for (std::size_t i = 0; i < time_s.size(); ++i) {
            if (time_s[i] >= from_s && time_s[i] < to_s) {
                peak_deg = std::max(peak_deg, std::abs(pitch_deg[i]));
            }
        }
        return peak_deg;
    }
};

/// K of the rotors: only one may have a plate below.
struct PlateUnderOne {
    const EffectCurve* curve;
    double plate_m, radius_m;
    bool is_there;
    double operator()(int rotor, double /*x_m*/, double /*y_m*/, double z_m) const {
        return is_there && rotor == rotor_over_plate ? (*curve)(std::max(0.0, z_m - plate_m) / radius_m) : 1.0;
    }
};

BenchFlight fly(const BenchExperiment& e) {
    QuadrotorParameters quadrotor;
    quadrotor.mass_kg = e.vehicle.mass_kg;
    quadrotor.inertia_kg_m2 = {e.vehicle.pitch_inertia_kg_m2, e.vehicle.pitch_inertia_kg_m2, 0.035};
    quadrotor.arm_m = e.vehicle.arm_m;
    quadrotor.drag_torque_m = 0.016;
    quadrotor.layout = QuadrotorLayout::plus;
    const SpaceModel<0> model = make_space_model<0>(make_quadrotor(quadrotor));
    const SpaceAllocation allocation = make_space_allocation(model);
    const EffectCurve curve(e.ground, 2);
    dynamics::PitchBench bench{};
    bench.friction_nm_s_rad = e.friction_nm_s_rad;
    const double weight_n = e.vehicle.mass_kg * 9.80665;

    dynamics::PitchBenchState<double> state{};
    std::fill(state.thrust_n, state.thrust_n + 4, weight_n / 4);
    BenchFlight flight;
    double integral_rad = 0;
    double disturbance_nm = 0;       // as the observer has it
    double expected_momentum = 0;    // of the observer [N m s]
    const auto ticks = static_cast<std::int64_t>(std::lround(end_s / tick_s));
    for (std::int64_t tick = 0; tick <= ticks; ++tick) {
        const double time_s = static_cast<double>(tick) * tick_s;
        flight.time_s.push_back(time_s);
        flight.pitch_deg.push_back(state.pitch_rad / degree);
        const PlateUnderOne plate{&curve, -e.z_over_r * e.vehicle.radius_m, e.vehicle.radius_m,
                                  time_s >= plate_from_s && time_s < plate_to_s};
        // Momentum form of thesis (3.9): the estimate follows what the momentum has beyond the torques given.
        const double momentum = e.vehicle.pitch_inertia_kg_m2 * state.pitch_rate_rad_s;
        if (e.help == Help::observer) {
            disturbance_nm = observer_gain_1_s * (momentum - expected_momentum);
        }
        const double rate_error = -e.control.pitch_kp * state.pitch_rad - state.pitch_rate_rad_s;
        const double wanted_nm =
            e.vehicle.pitch_inertia_kg_m2 * (e.control.rate_kp * rate_error + e.rate_ki * integral_rad) - disturbance_nm;
        integral_rad += rate_error * tick_s;
        expected_momentum += (wanted_nm + disturbance_nm) * tick_s;
        const double demand[4] = {weight_n, 0, wanted_nm, 0};
        double thrust_n[max_rotors];
        dynamics::allocate(allocation, demand, thrust_n);
        for (int i = 0; i < 4; ++i) {
            if (e.help == Help::feed_forward) {
                const double rise_m = i == rotor_over_plate ? -e.vehicle.arm_m * std::sin(state.pitch_rad) : 0;
                thrust_n[i] /= plate(i, 0, 0, rise_m);
            }
            thrust_n[i] = std::clamp(thrust_n[i], 0.0, weight_n / 2);
        }
        state = dynamics::pitch_bench_step(model, bench, state, thrust_n, tick_s, plate);
    }
    return flight;
}

struct Shown {
    const char* name;
    Help help;
};
constexpr std::array shown = {Shown{"PID", Help::none}, Shown{"feed-forward", Help::feed_forward},
                              Shown{"observer", Help::observer}};

/// Pitch under each controller.
std::array<BenchFlight, 3> flights_of(const BenchExperiment& base) {
    std::array<BenchFlight, 3> flights;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        BenchExperiment experiment = base;
        experiment.help = shown[i].help;
        flights[i] = fly(experiment);
    }
    return flights;
}

/// How far the pitch still is from level when the plate has been there for ten seconds.
double steady_deg(const BenchFlight& flight) {
    return std::abs(flight.at(plate_from_s + 10));
}

std::vector<Finding> findings_of(const std::array<BenchFlight, 3>& flights) {
    const auto& [pid, forward, observer] = flights;
    const double pid_deg = pid.peak(plate_from_s, plate_to_s);
    const double forward_deg = forward.peak(plate_from_s, plate_to_s);
    const double observer_deg = observer.peak(plate_from_s, plate_to_s);
    return {{"S8: PID", "pitch is disturbed and hard to correct (figures 3.18, 3.19 a)",
             fmt::format("up to {:.1f} deg, {:.1f} deg after 10 s", pid_deg, steady_deg(pid)), steady_deg(pid) > 1, ""},
            {"S8: feed-forward", "much smaller variations (figure 3.19 b)", fmt::format("up to {:.2f} deg", forward_deg),
             forward_deg < 0.2 * pid_deg, ""},
            {"S8: observer", "pitch begins to rise, then recovers (figure 3.20)",
             fmt::format("up to {:.2f} deg, {:.2f} deg after 10 s", observer_deg, steady_deg(observer)),
             observer_deg > forward_deg && steady_deg(observer) < 0.2 * observer_deg, ""}};
}

Figure figure_of(const std::array<BenchFlight, 3>& flights) {
    CurveFigure figure;
    figure.title = "A plate under one rotor from 5 to 20 s, z/R 2";
    figure.x_label = "time [s]";
    figure.y_label = "pitch [deg]";
    figure.level = 0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        Curve curve{shown[i].name, {}};
        for (std::size_t k = 0; k < flights[i].time_s.size(); k += 2) {
            curve.points.push_back({flights[i].time_s[k], flights[i].pitch_deg[k]});
        }
        figure.curves.push_back(std::move(curve));
    }
    return {"figure_3_18_to_3_20",
            "Thesis figures 3.18 to 3.20: pitch on the test bench. Positive is nose down, the plate is in front.",
            {std::move(figure)}};
}

struct Setting {
    std::string name;
    BenchExperiment base;
};

std::vector<Setting> settings() {
    BenchExperiment base;
    base.ground = effect_on_each_rotor(EffectModel::multirotor_body, base.vehicle);
    std::vector<Setting> all{{"(2.17) on the rotor", base}};
    for (const EffectModel model : {EffectModel::multirotor_images, EffectModel::cheeseman_bennett, EffectModel::hayden,
                                    EffectModel::li, EffectModel::he}) {
        all.push_back({std::string(info(model).name), base});
        all.back().base.ground = effect_on_each_rotor(model, base.vehicle);
    }
    for (const double scale : {0.5, 0.7, 1.4, 2.0}) {
        all.push_back({fmt::format("(2.17), all gains times {}", scale), base});
        all.back().base.control.pitch_kp *= scale;
        all.back().base.control.rate_kp *= scale;
    }
    all.push_back({"(2.17), with an integral of the pitch rate", base});
    all.back().base.rate_ki = 8;
    all.push_back({"(2.17), z/R 1", base});
    all.back().base.z_over_r = 1;
    return all;
}

}  // namespace

Study disturbance_test_bench() {
    const std::vector<Setting> all = settings();
    Study study;
    study.name = "disturbance-test-bench";
    study.title = "A plate under one rotor of a quadrotor on a test bench (thesis 3.5)";
    study.setting = {
        "The quadrotor of the study partial-ground-effect turns about an axle through its centre and can do nothing else. A plate is put under its "
        "front rotor, two radii below, for 15 s. The cascade has no integral of the pitch; the bearings have friction of 0.002 N m s/rad. The thesis "
        "shows measured curves without numbers on their controllers.",
        "In the table everything is flown again with other ground models and gains."};
    Table table{"settings",
                "Greatest pitch while the plate is there, and pitch after ten seconds [deg]",
                {"setting", "PID", "feed-forward", "observer"},
                {}};
    std::vector<std::vector<Finding>> by_setting;
    for (const Setting& setting : all) {
        const auto flights = flights_of(setting.base);
        by_setting.push_back(findings_of(flights));
        std::vector<std::string> row{setting.name};
        for (const BenchFlight& flight : flights) {
            row.push_back(fmt::format("{:.2f}, {:.2f}", flight.peak(plate_from_s, plate_to_s), steady_deg(flight)));
        }
        table.rows.push_back(std::move(row));
    }
    study.findings = by_setting.front();
    for (std::size_t i = 0; i < study.findings.size(); ++i) {
        const auto count = std::count_if(by_setting.begin(), by_setting.end(),
                                         [i](const auto& findings) { return findings[i].is_reproduced; });
        study.findings[i].note = fmt::format("{} of {} settings reproduce it", count, by_setting.size());
    }
    study.figures = {figure_of(flights_of(all.front().base))};
    study.tables = {std::move(table)};
    return study;
}

}  // namespace downwash::studies
