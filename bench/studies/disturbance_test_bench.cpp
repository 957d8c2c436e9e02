#include "downwash/studies/disturbance_test_bench.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "downwash/effects/effect_models.hpp"
#include "downwash/studies/bench_flight.hpp"

namespace downwash::studies {
namespace {

const double plate_from_s = BenchExperiment{}.plate_from_s;
const double plate_to_s = BenchExperiment{}.plate_to_s;

struct Shown {
    const char* name;
    BenchAid aid;
};
constexpr std::array shown = {Shown{"PID", BenchAid::none}, Shown{"feed-forward", BenchAid::feed_forward},
                              Shown{"observer", BenchAid::observer}};

/// Pitch under each controller.
std::array<BenchFlight, 3> flights_of(const BenchExperiment& base) {
    std::array<BenchFlight, 3> flights;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        BenchExperiment experiment = base;
        experiment.aid = shown[i].aid;
        flights[i] = fly(experiment);
    }
    return flights;
}

/// How far the pitch still is from level when the plate has been there for ten seconds.
double steady_deg(const BenchFlight& flight) {
    return std::abs(flight.pitch_at(plate_from_s + 10));
}

std::vector<Finding> findings_of(const std::array<BenchFlight, 3>& flights) {
    const auto& [pid, forward, observer] = flights;
    const double pid_deg = pid.peak_deg(plate_from_s, plate_to_s);
    const double forward_deg = forward.peak_deg(plate_from_s, plate_to_s);
    const double observer_deg = observer.peak_deg(plate_from_s, plate_to_s);
    return {{"S8: PID", "pitch is disturbed and hard to correct (figures 3.18, 3.19 a)",
             fmt::format("up to {:.1f} deg, {:.1f} deg after 10 s", pid_deg, steady_deg(pid)), steady_deg(pid) > 1, ""},
            {"S8: feed-forward", "much smaller variations (figure 3.19 b)",
             fmt::format("up to {:.2f} deg", forward_deg), forward_deg < 0.2 * pid_deg, ""},
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

struct BenchSetting {
    std::string name;
    BenchExperiment base;
};

std::vector<BenchSetting> bench_settings() {
    BenchExperiment base;
    base.ground = effect_on_each_rotor(EffectModel::multirotor_body, base.vehicle);
    std::vector<BenchSetting> all{{"(2.17) on the rotor", base}};
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
    const std::vector<BenchSetting> all = bench_settings();
    Study study;
    study.name = "disturbance-test-bench";
    study.title = "A plate under one rotor of a quadrotor on a test bench (thesis 3.5)";
    study.setting = {
        "The quadrotor of the study partial-ground-effect turns about an axle through its centre and can do nothing "
        "else. A plate is put under its "
        "front rotor, two radii below, for 15 s. The cascade has no integral of the pitch; the bearings have friction "
        "of 0.002 N m s/rad. The thesis "
        "shows measured curves without numbers on their controllers. The feed-forward is told at once when the plate "
        "comes and goes.",
        "In the table everything is flown again with other ground models and gains."};
    Table table{"settings",
                "Greatest pitch while the plate is there, and pitch after ten seconds [deg]",
                {"setting", "PID", "feed-forward", "observer"},
                {}};
    std::vector<std::vector<Finding>> by_setting;
    for (const BenchSetting& setting : all) {
        const auto flights = flights_of(setting.base);
        by_setting.push_back(findings_of(flights));
        std::vector<std::string> row{setting.name};
        for (const BenchFlight& flight : flights) {
            row.push_back(fmt::format("{:.2f}, {:.2f}", flight.peak_deg(plate_from_s, plate_to_s), steady_deg(flight)));
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
