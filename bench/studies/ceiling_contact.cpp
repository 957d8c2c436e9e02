#include "downwash/studies/ceiling_contact.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <thread>

#include "downwash/base/parallel.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "downwash/studies/ceiling_flight.hpp"
#include "downwash/studies/ceiling_inspection.hpp"
#include "downwash/studies/lyapunov_decay.hpp"

namespace downwash::studies {
namespace {

struct LawName {
    AltitudeLaw law;
    const char* name;
};
constexpr LawName laws[] = {{AltitudeLaw::lyapunov, "Lyapunov"},
                            {AltitudeLaw::lyapunov_unaware, "Lyapunov, K_c = 1"},
                            {AltitudeLaw::pid, "PID"}};

std::string delay_text(const CeilingFlight& flight) {
    const auto delay = flight.delay_s();
    return delay ? fmt::format("{:.2f}", *delay) : "never";
}

/// The numbers of a flight as a row of a table.
std::vector<std::string> row_of(std::string name, const CeilingExperiment& experiment, const CeilingFlight& flight) {
    return {std::move(name), delay_text(flight), fmt::format("{:.3f}", flight.overshoot_m(experiment.leave_to_m)),
            fmt::format("{:.2f}", flight.command_in_contact()), fmt::format("{:.2f}", 1e3 * flight.max_depth_m)};
}

const std::vector<std::string> columns{"flight", "delay on leaving [s]", "overshoot [m]", "command in contact / weight",
                                       "greatest depth in the ceiling [mm]"};

/// A flight to be made, and its name.
template <class Experiment>
struct CaseOf {
    std::string name;
    Experiment experiment;
};
using Case = CaseOf<CeilingExperiment>;
using InspectionCase = CaseOf<CeilingInspection>;

template <class OneCase>
auto flown(const std::vector<OneCase>& cases) {
    std::vector<decltype(fly(cases.front().experiment))> flights(cases.size());
    const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    run_parallel(cases.size(), threads, [&](std::size_t i) { flights[i] = fly(cases[i].experiment); });
    return flights;
}

Table table_of(std::string name, std::string caption, const std::vector<Case>& cases,
               const std::vector<CeilingFlight>& flights) {
    Table table{std::move(name), std::move(caption), columns, {}};
    for (std::size_t i = 0; i < cases.size(); ++i) {
        table.rows.push_back(row_of(cases[i].name, cases[i].experiment, flights[i]));
    }
    return table;
}

constexpr std::array gain_scales = {0.5, 0.7, 1.0, 1.4, 2.0};

/// Each law with each scale, in this order; then the PID otherwise.
std::vector<Case> cases_of_gains() {
    std::vector<Case> cases;
    for (const LawName& law : laws) {
        for (const double scale : gain_scales) {
            cases.push_back({fmt::format("{}, gains times {}", law.name, scale), {}});
            cases.back().experiment.law = law.law;
            cases.back().experiment.gain_scale = scale;
        }
    }
    for (const double climb_ki : {0.0, 0.3, 3.0}) {
        cases.push_back({fmt::format("PID, integral gain {}", climb_ki), {}});
        cases.back().experiment.law = AltitudeLaw::pid;
        cases.back().experiment.pid.climb_ki = climb_ki;
    }
    for (const double contact_s : {3.0, 30.0}) {
        cases.push_back({fmt::format("PID after {:.0f} s in contact", contact_s), {}});
        cases.back().experiment.law = AltitudeLaw::pid;
        cases.back().experiment.contact_s = contact_s;
    }
    return cases;
}

std::vector<Case> cases_of_sensors() {
    std::vector<Case> cases;
    for (const LawName& law : laws) {
        cases.push_back({std::string(law.name) + ", 20 Hz, 1 cm noise", {}});
        cases.back().experiment.law = law.law;
        cases.back().experiment.sample_s = 0.05;
        cases.back().experiment.height_noise_m = 0.01;
    }
    for (const double bias_m : {-0.01, 0.01, 0.02}) {
        cases.push_back({fmt::format("Lyapunov, K_c {:.0f} cm {}", 100 * std::abs(bias_m),
                                     bias_m > 0 ? "too near" : "too far away"),
                         {}});
        cases.back().experiment.height_bias_m = bias_m;
    }
    return cases;
}

/// Over the gains of a law: "0.05 to 0.22 s", with those that never leave.
std::string range_of_delays(const std::vector<CeilingFlight>& flights, std::size_t law) {
    double least_s = std::numeric_limits<double>::infinity();
    double greatest_s = 0;
    bool all_leave = true;
    for (std::size_t i = 0; i < gain_scales.size(); ++i) {
        const auto delay = flights[law * gain_scales.size() + i].delay_s();
        all_leave = all_leave && delay;
        least_s = std::min(least_s, delay.value_or(least_s));
        greatest_s = std::max(greatest_s, delay.value_or(0));
    }
    return fmt::format("{:.2f} to {} over gains from half to twice", least_s,
                       all_leave ? fmt::format("{:.2f} s", greatest_s) : "never");
}

/// C7: what the Lyapunov law leaves of gravity if it takes K_c at a height that is 1 cm off.
Table table_of_height_errors(const CeilingVehicle& vehicle) {
    constexpr double off_m = 0.01;
    Table table{"height_errors",
                "C7: acceleration that 1 cm of height error in K_c leaves [m/s2], positive: upwards (the thesis gives "
                "none; its sensor has 1 cm)",
                {"rotors below the ceiling [m]", "believed 1 cm too far away", "believed 1 cm too near"},
                {}};
    for (const double distance_m : {0.04, 0.06, 0.1, 0.2, 0.4}) {
        const double k = ceiling_factor_at(vehicle, distance_m);
        const auto left = [&](double believed_m) {
            return fmt::format("{:+.2f}", standard_gravity_m_s2 * (k / ceiling_factor_at(vehicle, believed_m) - 1));
        };
        table.rows.push_back({fmt::format("{}", distance_m), left(distance_m + off_m), left(distance_m - off_m)});
    }
    return table;
}

Curve curve_of(std::string name, const std::vector<double>& x, const std::vector<double>& y, std::size_t step = 4) {
    Curve curve{std::move(name), {}};
    for (std::size_t i = 0; i < x.size(); i += step) {
        curve.points.push_back({x[i], y[i]});
    }
    return curve;
}

CurveFigure diagram(std::string title, std::string y_label, std::vector<Curve> curves) {
    CurveFigure figure;
    figure.title = std::move(title);
    figure.x_label = "time [s]";
    figure.y_label = std::move(y_label);
    figure.curves = std::move(curves);
    return figure;
}

/// The mission as it is; without K_c; both as a total station sees them; and with other gains of roll and pitch.
std::vector<InspectionCase> cases_of_inspection() {
    std::vector<InspectionCase> cases;
    const auto add = [&](std::string name) -> CeilingInspection& {
        return cases.emplace_back(InspectionCase{std::move(name), {}}).experiment;
    };
    add("Lyapunov");
    add("Lyapunov, K_c = 1").knows_ceiling = false;
    for (const bool knows_ceiling : {true, false}) {
        CeilingInspection& seen = add(cases[knows_ceiling ? 0 : 1].name + ", 20 Hz, 1 cm noise");
        seen.knows_ceiling = knows_ceiling;
        seen.sample_s = 0.05;
        seen.position_noise_m = 0.01;
    }
    for (const double gain_1_s : {8.0, 12.0, 16.0, 25.0}) {
        add(fmt::format("Lyapunov, gains of roll and pitch {} 1/s", gain_1_s)).attitude_gain_1_s = gain_1_s;
    }
    return cases;
}

std::string contacts_text(const CeilingInspection& mission, const CeilingInspectionFlight& flight) {
    return fmt::format("{} of {}", flight.contacts_held, mission.points_m.size());
}

Table table_of(const std::vector<InspectionCase>& cases, const std::vector<CeilingInspectionFlight>& flights) {
    Table table{"inspection",
                "A mission of several contacts",
                {"flight", "contacts held", "longest delay on leaving [s]", "fall below the height of travel [m]",
                 "farthest aside at rest [m]", "greatest tilt [deg]"},
                {}};
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const CeilingInspectionFlight& flight = flights[i];
        table.rows.push_back({cases[i].name, contacts_text(cases[i].experiment, flight),
                              flight.always_leaves ? fmt::format("{:.2f}", flight.delay_s) : "never",
                              fmt::format("{:.3f}", flight.below_travel_m), fmt::format("{:.3f}", flight.max_aside_m),
                              fmt::format("{:.1f}", flight.max_tilt_deg)});
    }
    return table;
}

Finding finding_of(const CeilingInspection& mission, const CeilingInspectionFlight& flight,
                   const CeilingInspectionFlight& unaware) {
    const bool all_held = flight.contacts_held == static_cast<int>(mission.points_m.size());
    return {"C8: contacts one after the other, without a critical loss of height", "in safety (figures 4.16 and 4.17)",
            fmt::format("{} contacts held; leaves within {:.2f} s and falls {:.3f} m below the height of travel",
                        contacts_text(mission, flight), flight.delay_s, flight.below_travel_m),
            all_held && flight.always_leaves && flight.below_travel_m < 0.1,
            unaware.always_leaves ? "without K_c it leaves every point, too"
                                  : "without K_c it does not come down before the next leg begins"};
}

std::vector<Figure> figures_of(const CeilingInspectionFlight& flight) {
    const auto line = [&](std::string name, const std::vector<double>& values) {
        return curve_of(std::move(name), flight.time_s, values, 12);
    };
    Figure position{"figure_4_16",
                    "Thesis figure 4.16: position in a mission of four contacts under the Lyapunov laws.",
                    {diagram("An inspection by contact: position", "height [m]",
                             {line("frame", flight.height_m), line("reference", flight.reference_height_m)}),
                     diagram("", "x [m]", {line("vehicle", flight.x_m), line("reference", flight.reference_x_m)}),
                     diagram("", "y [m]", {line("vehicle", flight.y_m), line("reference", flight.reference_y_m)}),
                     diagram("", "K_c", {line("at the rotors", flight.ceiling_factor)})}};
    position.diagrams[0].level = 0;
    Figure attitude{
        "figure_4_17",
        "Thesis figure 4.17: attitude in the same mission.",
        {diagram("An inspection by contact: attitude", "roll [deg]",
                 {line("vehicle", flight.roll_deg), line("reference", flight.demanded_roll_deg)}),
         diagram("", "pitch [deg]", {line("vehicle", flight.pitch_deg), line("reference", flight.demanded_pitch_deg)}),
         diagram("", "yaw [deg]", {line("vehicle", flight.yaw_deg)})}};
    return {std::move(position), std::move(attitude)};
}

std::vector<Figure> figures_of(const CeilingFlight& lyapunov, const CeilingFlight& pid) {
    Figure one{
        "figure_4_14",
        "Thesis figure 4.14: the Lyapunov law at the ceiling: height of the frame, command over weight, factor K_c.",
        {diagram("Touching a ceiling under the Lyapunov law", "height [m]",
                 {curve_of("frame", lyapunov.time_s, lyapunov.height_m),
                  curve_of("reference", lyapunov.time_s, lyapunov.reference_m)}),
         diagram("", "command / weight", {curve_of("command", lyapunov.time_s, lyapunov.command_over_weight)}),
         diagram("", "K_c", {curve_of("at the rotors", lyapunov.time_s, lyapunov.ceiling_factor)})}};
    one.diagrams[0].level = 0;
    Figure other{
        "figure_4_15",
        "Thesis figure 4.15: climb rate and height under the Lyapunov law and under the PID.",
        {diagram("Leaving a ceiling: Lyapunov law and PID", "climb rate [m/s]",
                 {curve_of("Lyapunov", lyapunov.time_s, lyapunov.climb_m_s), curve_of("PID", pid.time_s, pid.climb_m_s),
                  curve_of("reference", pid.time_s, pid.reference_climb_m_s)}),
         diagram("", "height [m]",
                 {curve_of("Lyapunov", lyapunov.time_s, lyapunov.height_m), curve_of("PID", pid.time_s, pid.height_m),
                  curve_of("reference", pid.time_s, pid.reference_m)})}};
    other.diagrams[1].level = 0;
    return {std::move(one), std::move(other)};
}

}  // namespace

Study ceiling_contact() {
    const std::vector<Case> gains = cases_of_gains();
    const std::vector<Case> sensors = cases_of_sensors();
    const std::vector<CeilingFlight> flights = flown(gains);
    // Each law with its gains as they are: the third scale is 1.
    const CeilingFlight& lyapunov = flights[2];
    const CeilingFlight& unaware = flights[gain_scales.size() + 2];
    const CeilingFlight& pid = flights[2 * gain_scales.size() + 2];
    const double leave_to_m = CeilingExperiment{}.leave_to_m;
    const CeilingVehicle vehicle;
    const double in_contact = ceiling_factor_at(vehicle, vehicle.guard_m);
    const LyapunovDecay decay = lyapunov_decay();

    Study study;
    study.name = "ceiling-contact";
    study.title = "Touching a ceiling and leaving it (thesis 4.6 and 4.7)";
    study.setting = {
        "A quadrotor of 1.5 kg in six degrees of freedom climbs at 0.3 m/s until its frame, 4 cm above the rotors, "
        "touches a "
        "wide ceiling, presses against it for 10 s with a reference 2 cm higher, and follows the reference down again "
        "at 0.3 m/s. Every rotor has (2.18) of its own "
        "height. The contact is compliant and has friction. Both laws see the height exactly, at 100 Hz; the table of "
        "sensors tells what 20 Hz and 1 cm change. "
        "Roll and pitch are the Lyapunov laws' in both. Figures 4.16 and 4.17 are a mission: four contacts of 6 s, "
        "under the laws of "
        "altitude, position and attitude together.",
        "The thesis gives neither mass nor gains. The PID (height 2 1/s, climb rate 4 1/s, integral 1 1/s2) and the "
        "Lyapunov law (k = k' = 2 1/s) are about as "
        "quick in free air. The table of gains flies both from half to twice of that."};
    study.findings.push_back(
        {"C3: dV/dt = -k e^2 - k' e'^2", "by construction (4.6)",
         fmt::format("to {:.0e} with the command of the same moment", decay.worst_rate_error),
         decay.worst_rate_error < 1e-6,
         fmt::format("held for 10 ms, V is off by at most {:.1f} % of its start", 100 * decay.sampled_excess)});
    const double never = std::numeric_limits<double>::infinity();
    const double lyapunov_s = lyapunov.delay_s().value_or(never);
    const double pid_s = pid.delay_s().value_or(never);
    study.findings.push_back({"C4: delay on leaving, Lyapunov", "0.25 s", delay_text(lyapunov) + " s",
                              std::abs(lyapunov_s - 0.25) < 0.1, range_of_delays(flights, 0)});
    study.findings.push_back({"C4: delay on leaving, PID", "4 s", delay_text(pid) + " s", std::abs(pid_s - 4) < 1,
                              range_of_delays(flights, 2)});
    study.findings.push_back(
        {"C4: Lyapunov leaves more than 4 times as fast", "more than 4 times",
         std::isfinite(pid_s) ? fmt::format("{:.1f} times", pid_s / lyapunov_s) : "the PID never leaves",
         pid_s > 4 * lyapunov_s});
    study.findings.push_back({"C4: what makes the difference is K_c", "the PID does not know it",
                              "without K_c the Lyapunov law leaves after: " + delay_text(unaware),
                              unaware.delay_s().value_or(never) > 4 * lyapunov_s, range_of_delays(flights, 1)});
    const double lyapunov_over_m = lyapunov.overshoot_m(leave_to_m);
    const double pid_over_m = pid.overshoot_m(leave_to_m);
    study.findings.push_back({"C4: the PID overshoots downwards, Lyapunov does not", "figure 4.15",
                              fmt::format("{:.3f} m against {:.3f} m", pid_over_m, lyapunov_over_m),
                              pid_over_m > 0.02 && lyapunov_over_m < 0.02,
                              "the reference stops at once, and neither law knows it before"});
    study.findings.push_back({"C5: the mean command falls in contact", "falls (figure 4.14)",
                              fmt::format("to {:.0f} % of the weight; (2.18) says 1/K = {:.0f} %",
                                          100 * lyapunov.command_in_contact(), 100 / in_contact),
                              lyapunov.command_in_contact() < 0.9});
    study.findings.push_back({"C6: the command has to fall this far to leave contact", "up to 40 %",
                              fmt::format("{:.0f} %", 100 * (1 - 1 / in_contact)), 1 - 1 / in_contact > 0.35,
                              "40 % would take K = 1.67"});
    const std::vector<InspectionCase> inspections = cases_of_inspection();
    const std::vector<CeilingInspectionFlight> missions = flown(inspections);
    study.findings.push_back(finding_of(inspections[0].experiment, missions[0], missions[1]));
    study.figures = figures_of(lyapunov, pid);
    std::ranges::move(figures_of(missions[0]), std::back_inserter(study.figures));
    study.tables = {
        table_of("gains", "Leaving the ceiling, over gains of the height loop", gains, flights),
        table_of("sensors", "The same with the thesis' total station: heights at 20 Hz with 1 cm noise, and K_c off",
                 sensors, flown(sensors)),
        table_of_height_errors(vehicle), table_of(inspections, missions)};
    return study;
}

}  // namespace downwash::studies
