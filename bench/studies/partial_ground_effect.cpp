#include "downwash/studies/partial_ground_effect.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <thread>
#include <tuple>
#include <utility>

#include "downwash/base/parallel.hpp"
#include "downwash/effects/effect_models.hpp"
#include "downwash/studies/planar_flight.hpp"

namespace downwash::studies {
namespace {

constexpr double over_m = 7, beside_m = 2.8;  // where cases 1 and 2 lead to
constexpr double settled_s = 20;              // at the end of a flight
constexpr double observer_gain_1_s = 10;

/// A way to fly all experiments.
struct Setting {
    std::string name;
    PlanarExperiment base;
};

/// The flights of a setting, in the order of experiments().
struct Story {
    std::vector<PlanarFlight> flights;
};

enum Flown : std::size_t {
    free_over,
    pid_over_3,
    pid_over_2,
    free_beside,
    pid_beside_3,
    pid_beside_2,
    fast_over_2,
    fast_beside_2,
    noisy_beside_2,
    observer_over_3,
    observer_over_2,
    observer_beside_3,
    observer_beside_2,
    forward_over_3,
    forward_over_2,
    forward_beside_3,
    forward_beside_2,
    offset_5,
    offset_15,
    flown_count,
};

std::vector<PlanarExperiment> experiments(const PlanarExperiment& base) {
    std::vector<PlanarExperiment> all(flown_count, base);
    const auto at = [&](Flown which, double target_m, double z_over_r) -> PlanarExperiment& {
        all[which].target_m = target_m;
        all[which].z_over_r = z_over_r;
        return all[which];
    };
    at(free_over, over_m, 3).has_plate = false;
    at(pid_over_3, over_m, 3);
    at(pid_over_2, over_m, 2);
    at(free_beside, beside_m, 3).has_plate = false;
    at(pid_beside_3, beside_m, 3);
    at(pid_beside_2, beside_m, 2);
    at(fast_over_2, over_m, 2).speed_m_s = 1;
    at(fast_beside_2, beside_m, 2).speed_m_s = 1;
    PlanarExperiment& noisy = at(noisy_beside_2, beside_m, 2);
    noisy.speed_m_s = 1;
    noisy.gyro_noise_rad_s = 0.015;
    for (const auto& [which, target_m, z_over_r] : {std::tuple{observer_over_3, over_m, 3.0},
                                                    {observer_over_2, over_m, 2.0},
                                                    {observer_beside_3, beside_m, 3.0},
                                                    {observer_beside_2, beside_m, 2.0}}) {
        at(which, target_m, z_over_r).control.observer_gain_1_s = observer_gain_1_s;
    }
    for (const auto& [which, target_m, z_over_r, offset_m] : {std::tuple{forward_over_3, over_m, 3.0, 0.0},
                                                              {forward_over_2, over_m, 2.0, 0.0},
                                                              {forward_beside_3, beside_m, 3.0, 0.0},
                                                              {forward_beside_2, beside_m, 2.0, 0.0},
                                                              {offset_5, beside_m, 2.0, -0.05},
                                                              {offset_15, beside_m, 2.0, -0.15}}) {
        at(which, target_m, z_over_r).control.map_offset_m = offset_m;
    }
    return all;
}

/// What a flight comes to, in words and numbers.
struct End {
    double final_x_m, swing_m, pitch_deg;
    bool is_lost;
    [[nodiscard]] bool is_at(double x_m) const {
        return !is_lost && std::abs(final_x_m - x_m) < 0.05 && swing_m < 0.05;
    }
    [[nodiscard]] bool is_swinging() const { return is_lost || (swing_m > 0.02 && pitch_deg > 0.5); }
    [[nodiscard]] std::string text() const {
        if (is_lost) {
            return "lost";
        }
        return swing_m > 0.02 ? fmt::format("{:.2f} to {:.2f} m, up to {:.1f} deg", final_x_m - swing_m / 2,
                                            final_x_m + swing_m / 2, pitch_deg)
                              : fmt::format("rests at {:.2f} m", final_x_m);
    }
};

End end_of(const PlanarFlight& flight) {
    const auto range = flight.over_last(settled_s);
    return {0.5 * (range.least_x_m + range.greatest_x_m), range.greatest_x_m - range.least_x_m,
            range.greatest_pitch_deg, flight.is_lost};
}

/// When a flight first comes within 5 cm of x [s]; infinite if never.
double arrival_s(const PlanarFlight& flight, double x_m) {
    for (std::size_t i = 0; i < flight.x_m.size(); ++i) {
        if (std::abs(flight.x_m[i] - x_m) < 0.05) {
            return flight.time_s[i];
        }
    }
    return std::numeric_limits<double>::infinity();
}

double peak_pitch_deg(const PlanarFlight& flight) {
    double peak = 0;
    for (const double pitch_deg : flight.pitch_deg) {
        peak = std::max(peak, std::abs(pitch_deg));
    }
    return peak;
}

Finding finding(std::string name, std::string thesis, std::string measured, bool is_reproduced, std::string note = "") {
    return {std::move(name), std::move(thesis), std::move(measured), is_reproduced, std::move(note)};
}

/// Claims S1 to S7 in one setting.
std::vector<Finding> findings_of(const Story& story) {
    const auto end = [&](Flown which) { return end_of(story.flights[which]); };
    const double free_s = arrival_s(story.flights[free_over], over_m);
    const double slowed_s = arrival_s(story.flights[pid_over_3], over_m);
    const End observed = end(observer_beside_2);
    const double observer_error_m = std::abs(observed.final_x_m - beside_m);
    const End pid = end(pid_beside_2);
    std::vector<Finding> all;
    all.push_back(finding("S1: PID, 0.2 m/s over the plate, z/R 2", "pushed away, never crosses",
                          end(pid_over_2).text(), !end(pid_over_2).is_at(over_m)));
    all.push_back(finding("S1: the same at z/R 3", "only slowed",
                          std::isfinite(slowed_s)
                              ? fmt::format("arrives after {:.1f} s, without a plate {:.1f} s", slowed_s, free_s)
                              : end(pid_over_3).text(),
                          std::isfinite(slowed_s) && slowed_s >= free_s));
    all.push_back(finding("S2: PID, hover with one rotor over the plate, z/R 2", "sustained oscillation", pid.text(),
                          pid.is_swinging()));
    all.push_back(finding(
        "S3: PID, 1 m/s over the plate, z/R 2", "passes by inertia",
        fmt::format("{}; pitch up to {:.1f} deg", end(fast_over_2).text(), peak_pitch_deg(story.flights[fast_over_2])),
        end(fast_over_2).is_at(over_m)));
    all.push_back(finding("S3: PID, 1 m/s to one rotor over the plate", "oscillates", end(fast_beside_2).text(),
                          end(fast_beside_2).is_swinging()));
    all.push_back(finding("S4: the same with gyro noise of 0.015 rad/s", "larger oscillation",
                          end(noisy_beside_2).text(),
                          end(noisy_beside_2).pitch_deg > end(fast_beside_2).pitch_deg &&
                              end(noisy_beside_2).swing_m > end(fast_beside_2).swing_m));
    all.push_back(finding("S5: observer, over the plate, z/R 2", "reaches x = 7 m", end(observer_over_2).text(),
                          end(observer_over_2).is_at(over_m)));
    all.push_back(finding("S5: observer, one rotor over the plate", "oscillation gone", observed.text(),
                          !observed.is_swinging()));
    all.push_back(finding("S5: steady error of that hover", "large", fmt::format("{:.3f} m", observer_error_m),
                          !observed.is_swinging() && observer_error_m > 0.05));
    all.push_back(finding("S6: feed-forward, exact map, z/R 2", "best: reaches both references",
                          end(forward_over_2).text() + "; " + end(forward_beside_2).text(),
                          end(forward_over_2).is_at(over_m) && end(forward_beside_2).is_at(beside_m)));
    all.push_back(finding("S7: feed-forward, map 5 cm off, one rotor over the plate", "overshoot, but guided",
                          end(offset_5).text(), !end(offset_5).is_lost && end(offset_5).pitch_deg < pid.pitch_deg));
    all.push_back(finding("S7: map 15 cm off", "unstable, worse than PID", end(offset_15).text(),
                          end(offset_15).is_lost || end(offset_15).pitch_deg > pid.pitch_deg));
    return all;
}

PlanarExperiment base_with(const SurfaceEffect& ground, const PlanarControl& control = {},
                           RotorLayout layout = RotorLayout::plus) {
    PlanarExperiment base;
    base.vehicle.layout = layout;
    base.control = control;
    base.ground = effect_on_each_rotor(ground, base.vehicle);
    return base;
}

/// The first is the one that the findings are about.
std::vector<Setting> settings() {
    const SurfaceEffect whole(EffectModel::multirotor_body);
    std::vector<Setting> all{{"(2.17) on each rotor", base_with(whole)}};
    for (const EffectModel model : {EffectModel::multirotor_images, EffectModel::cheeseman_bennett, EffectModel::hayden,
                                    EffectModel::li, EffectModel::he}) {
        all.push_back({std::string(info(model).name), base_with(model)});
    }
    PlanarExperiment body = base_with(whole);
    body.ground = whole;
    all.push_back({"multirotor-body: fountain on the body", body});
    all.push_back({"(2.17), layout x", base_with(whole, {}, RotorLayout::cross)});
    for (const double scale : {0.5, 0.7, 1.4, 2.0}) {
        PlanarControl control;
        control.position_kp *= scale;
        control.velocity_kp *= scale;
        control.pitch_kp *= scale;
        control.rate_kp *= scale;
        all.push_back({fmt::format("(2.17), all gains times {}", scale), base_with(whole, control)});
    }
    for (const double scale : {0.5, 2.0}) {
        PlanarControl control;
        control.pitch_kp *= scale;
        control.rate_kp *= scale;
        all.push_back({fmt::format("(2.17), attitude gains times {}", scale), base_with(whole, control)});
    }
    return all;
}

std::vector<Story> stories_of(const std::vector<Setting>& all) {
    std::vector<Story> stories(all.size());
    std::vector<std::pair<PlanarExperiment, PlanarFlight*>> jobs;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::vector<PlanarExperiment> own = experiments(all[i].base);
        stories[i].flights.resize(own.size());
        for (std::size_t k = 0; k < own.size(); ++k) {
            jobs.emplace_back(own[k], &stories[i].flights[k]);
        }
    }
    const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    run_parallel(jobs.size(), threads, [&](std::size_t i) { *jobs[i].second = fly(jobs[i].first); });
    return stories;
}

/// x and pitch over time.
Figure figure_of(const std::string& name, const std::string& caption, const Story& story,
                 const std::vector<std::pair<const char*, Flown>>& shown, double target_m) {
    constexpr std::size_t every = 10;
    CurveFigure x;
    CurveFigure pitch;
    x.x_label = pitch.x_label = "time [s]";
    x.y_label = "x [m]";
    x.level = target_m;
    pitch.y_label = "pitch [deg]";
    pitch.level = 0;
    for (const auto& [label, which] : shown) {
        const PlanarFlight& flight = story.flights[which];
        Curve x_curve{label, {}};
        Curve pitch_curve{label, {}};
        for (std::size_t i = 0; i < flight.time_s.size(); i += every) {
            x_curve.points.push_back({flight.time_s[i], flight.x_m[i]});
            pitch_curve.points.push_back({flight.time_s[i], flight.pitch_deg[i]});
        }
        x.curves.push_back(std::move(x_curve));
        pitch.curves.push_back(std::move(pitch_curve));
    }
    x.title = caption;
    return {name, caption, {std::move(x), std::move(pitch)}};
}

std::vector<Figure> figures_of(const Story& story) {
    using Shown = std::vector<std::pair<const char*, Flown>>;
    const auto figure = [&](const char* name, const std::string& caption, const Shown& shown, double target_m) {
        return figure_of(name, caption, story, shown, target_m);
    };
    return {
        figure("figure_3_4", "Thesis figure 3.4: PID over the plate at 0.2 m/s (from 3 to 5 m)",
               {{"no plate", free_over}, {"z/R 3", pid_over_3}, {"z/R 2", pid_over_2}}, over_m),
        figure("figure_3_5", "Thesis figure 3.5: PID, hover with one rotor over the plate",
               {{"no plate", free_beside}, {"z/R 3", pid_beside_3}, {"z/R 2", pid_beside_2}}, beside_m),
        figure("figure_3_6_over", "Thesis figure 3.6: PID over the plate at 1 m/s, z/R 2", {{"1 m/s", fast_over_2}},
               over_m),
        figure("figure_3_7", "Thesis figures 3.6 and 3.7: PID, hover at the end of 1 m/s, with and without gyro noise",
               {{"noise 0.015 rad/s", noisy_beside_2}, {"no noise", fast_beside_2}}, beside_m),
        figure("figure_3_9", "Thesis figure 3.9: observer over the plate",
               {{"no plate, PID", free_over}, {"z/R 3", observer_over_3}, {"z/R 2", observer_over_2}}, over_m),
        figure("figure_3_10", "Thesis figure 3.10: observer, hover with one rotor over the plate",
               {{"no plate, PID", free_beside}, {"z/R 3", observer_beside_3}, {"z/R 2", observer_beside_2}}, beside_m),
        figure("figure_3_12", "Thesis figure 3.12: feed-forward over the plate",
               {{"no plate, PID", free_over}, {"z/R 3", forward_over_3}, {"z/R 2", forward_over_2}}, over_m),
        figure("figure_3_13", "Thesis figure 3.13: feed-forward, hover with one rotor over the plate",
               {{"no plate, PID", free_beside}, {"z/R 3", forward_beside_3}, {"z/R 2", forward_beside_2}}, beside_m),
        figure("figure_3_14", "Thesis figure 3.14: feed-forward through a map that lies off, z/R 2",
               {{"15 cm off", offset_15}, {"5 cm off", offset_5}}, beside_m),
        figure("figure_3_15", "Thesis figure 3.15: the controllers over the plate, z/R 2",
               {{"PID", pid_over_2}, {"observer", observer_over_2}, {"feed-forward", forward_over_2}}, over_m),
        figure("figure_3_16", "Thesis figure 3.16: the controllers with one rotor over the plate, z/R 2",
               {{"PID", pid_beside_2}, {"observer", observer_beside_2}, {"feed-forward", forward_beside_2}}, beside_m),
    };
}

Table table_of_settings(const std::vector<Setting>& all, const std::vector<Story>& stories) {
    Table table{"settings",
                "Every ground model, layout and gain: which claims are reproduced",
                {"setting", "S1, z/R 2", "S1, z/R 3", "S2", "S3, over", "S3, beside", "S4", "S5, over", "S5, beside",
                 "S5, error", "S6", "S7, 5 cm", "S7, 15 cm"},
                {}};
    for (std::size_t i = 0; i < all.size(); ++i) {
        std::vector<std::string> row{all[i].name};
        for (const Finding& f : findings_of(stories[i])) {
            row.push_back((f.is_reproduced ? "yes: " : "no: ") + f.measured);
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

/// S9: the moment that rights a tilted vehicle over wide ground.
Finding righting_moment(const PlanarExperiment& base, Table& table) {
    table = {
        "righting_moment",
        "S9: pitch torque over wide ground [N m] (negative: back to level), and beside the controller's at that pitch",
        {"z/R", "5 deg", "10 deg", "share of the controller's at 10 deg"},
        {}};
    PlanarExperiment single = base;
    single.ground = effect_on_each_rotor(EffectModel::cheeseman_bennett, base.vehicle);
    single.z_over_r = 2;
    const double stiffness_nm =
        base.control.pitch_kp * base.control.rate_kp * base.vehicle.pitch_inertia_kg_m2;  // per radian
    constexpr double degree = std::numbers::pi / 180;
    double share_at_2 = 0;
    for (const double z_over_r : {1.0, 1.5, 2.0, 3.0, 4.0}) {
        PlanarExperiment at = base;
        at.z_over_r = z_over_r;
        const double at_5 = torque_over_wide_plate(at, 5 * degree);
        const double at_10 = torque_over_wide_plate(at, 10 * degree);
        const double share = -at_10 / (stiffness_nm * 10 * degree);
        share_at_2 = z_over_r == 2 ? share : share_at_2;
        table.rows.push_back({fmt::format("{}", z_over_r), fmt::format("{:.4f}", at_5), fmt::format("{:.4f}", at_10),
                              fmt::format("{:.0f} %", 100 * share)});
    }
    return finding("S9: righting moment at 10 deg over wide ground, z/R 2", "negligible unless very close",
                   fmt::format("{:.0f} % of the controller's", 100 * share_at_2), share_at_2 < 0.1,
                   fmt::format("with cheeseman-bennett {:.0f} %",
                               -100 * torque_over_wide_plate(single, 10 * degree) / (stiffness_nm * 10 * degree)));
}

}  // namespace

Study partial_ground_effect() {
    const std::vector<Setting> all = settings();
    const std::vector<Story> stories = stories_of(all);
    Study study;
    study.name = "partial-ground-effect";
    study.title = "A quadrotor over the edge of a plate under three controllers (thesis chapter 3)";
    study.setting = {
        "The thesis gives neither masses nor sizes nor gains. Here a planar quadrotor of 1.5 kg, 0.02 kg m2 and rotors "
        "of 0.12 m "
        "radius 0.25 m out flies a cascade without integrators: position 0.8 1/s, velocity 1.5 1/s, pitch 4 1/s, pitch "
        "rate 8 1/s, "
        "at 100 Hz. The reference is a step whose commanded speed is clipped. Every rotor takes (2.17) of the whole "
        "vehicle, as "
        "far as its disc is over the plate: with the single rotor's (2.9) the disturbance is small. The observer has L "
        "= 10 1/s.",
        "The table of settings flies everything again with other ground models, another layout and other gains. A "
        "claim counts as reproduced by the "
        "same rules everywhere; nothing was tuned."};
    study.findings = findings_of(stories.front());
    for (std::size_t i = 0; i < study.findings.size(); ++i) {
        std::size_t count = 0;
        for (const Story& story : stories) {
            count += findings_of(story)[i].is_reproduced ? 1U : 0U;
        }
        study.findings[i].note = fmt::format("{} of {} settings reproduce it", count, stories.size());
    }
    Table moments;
    study.findings.push_back(righting_moment(all.front().base, moments));
    study.figures = figures_of(stories.front());
    study.tables = {table_of_settings(all, stories), std::move(moments)};
    return study;
}

}  // namespace downwash::studies
