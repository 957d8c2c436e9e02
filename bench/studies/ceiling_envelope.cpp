#include "downwash/studies/ceiling_envelope.hpp"

#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "downwash/effects/effect_curve.hpp"

namespace downwash::studies {
namespace {

constexpr double one_degree = std::numbers::pi / 180;
constexpr double greatest_factor = 2;
constexpr double far_m = 10;

/// What the thesis reads off at one pitch and distance.
struct Statement {
    double pitch_deg, distance_m;
    int percent;
};

constexpr Statement statements[] = {{10, 0.1, 22}, {3, 0.1, 5}, {10, 0.25, 2}};

/// The thesis does not say how far out its rotors are. Both readings, with the radius of its fit.
struct Reading {
    const char* name;
    RotorPair pair;
};

constexpr Reading readings[] = {{"rotors 0.25 m from the centre", {0.25, 0.1194}},
                                {"rotors 0.24 m from the centre (480 mm between opposite axes)", {0.24, 0.1194}}};

std::string percent(double share) {
    return std::isfinite(share) ? fmt::format("{:.1f} %", 100 * share) : "a rotor touches";
}

CurveFigure difference_figure(const SurfaceEffect& ceiling, const RotorPair& pair) {
    CurveFigure figure;
    figure.title = "Difference between front and rear rotor";
    figure.subtitle = "ceiling model (2.18), R = 0.1194 m, hubs 0.25 m from the centre";
    figure.x_label = "distance to the ceiling [m]";
    figure.y_label = "K front / K rear - 1 [%]";
    figure.x_range = AxisRange{0, 0.6};
    figure.y_range = AxisRange{0, 40};
    const double cap_m = EffectCurve(ceiling, greatest_factor).cap_distance() * pair.radius_m;
    for (const double pitch_deg : {1.0, 3.0, 5.0, 10.0, 15.0}) {
        Curve curve{fmt::format("{:.0f} deg", pitch_deg), {}};
        const double capped_m =
            cap_m + pair.arm_m * std::sin(pitch_deg * one_degree);  // the front rotor's K is no formula's any more
        for (int i = 1; i <= 300; ++i) {
            const double distance_m = 0.002 * i;
            const double share = difference_between_rotors(ceiling, pair, pitch_deg * one_degree, distance_m);
            curve.points.push_back({distance_m, distance_m > capped_m && share < 0.5 ? 100 * share : std::nan("")});
        }
        figure.curves.push_back(std::move(curve));
    }
    MeasuredPoints said{"thesis 4.6", {}, {}};
    for (const Statement& s : statements) {
        said.points.push_back({s.distance_m, static_cast<double>(s.percent)});
    }
    figure.measurements.push_back(std::move(said));
    return figure;
}

CurveFigure envelope_figure(const SurfaceEffect& ceiling, const RotorPair& pair) {
    CurveFigure figure;
    figure.title = "Flight envelope under a ceiling";
    figure.subtitle = "least distance for a difference of at most";
    figure.x_label = "pitch [deg]";
    figure.y_label = "distance to the ceiling [m]";
    figure.y_range = AxisRange{0, 0.5};
    figure.level = 0.25;
    for (const double most : {0.02, 0.05, 0.10, 0.22}) {
        Curve curve{fmt::format("{:.0f} %", 100 * most), {}};
        for (int i = 1; i <= 80; ++i) {
            const double pitch_deg = 0.25 * i;
            curve.points.push_back({pitch_deg, least_distance_m(ceiling, pair, pitch_deg * one_degree, most)});
        }
        figure.curves.push_back(std::move(curve));
    }
    Curve touch{"the front disc touches", {}};
    for (int i = 0; i <= 80; ++i) {
        const double pitch_deg = 0.25 * i;
        touch.points.push_back({pitch_deg, (pair.arm_m + pair.radius_m) * std::sin(pitch_deg * one_degree)});
    }
    figure.curves.push_back(std::move(touch));
    return figure;
}

Table table_of_models(const RotorPair& pair) {
    Table table{"ceiling_models",
                "Every ceiling model: difference between the rotors, and least distance for at most 5 % at 10 deg",
                {"model", "10 deg at 0.10 m", "3 deg at 0.10 m", "10 deg at 0.25 m", "least distance [m]"},
                {}};
    for (const EffectModelInfo& model : effect_models()) {
        if (model.surface == "ceiling") {
            const SurfaceEffect effect(model.model);
            std::vector<std::string> row{std::string(model.name)};
            for (const Statement& s : statements) {
                row.push_back(percent(difference_between_rotors(effect, pair, s.pitch_deg * one_degree, s.distance_m)));
            }
            row.push_back(fmt::format("{:.3f}", least_distance_m(effect, pair, 10 * one_degree, 0.05)));
            table.rows.push_back(std::move(row));
        }
    }
    return table;
}

}  // namespace

double difference_between_rotors(const SurfaceEffect& ceiling, const RotorPair& pair, double pitch_rad,
                                 double distance_m) {
    const double rise_m = pair.arm_m * std::sin(pitch_rad);
    if (distance_m - std::abs(rise_m) <= 0) {
        return std::numeric_limits<double>::infinity();
    }
    const EffectCurve k(ceiling, greatest_factor);
    return k((distance_m - rise_m) / pair.radius_m) / k((distance_m + rise_m) / pair.radius_m) - 1;
}

double least_distance_m(const SurfaceEffect& ceiling, const RotorPair& pair, double pitch_rad, double most) {
    // Towards a touch the difference grows, but for the cap, which makes K flat right there: from far to near.
    double low_m = std::abs(pair.arm_m * std::sin(pitch_rad));
    double high_m = far_m;
    for (double at_m = far_m; at_m > low_m; at_m *= 0.99) {
        if (difference_between_rotors(ceiling, pair, pitch_rad, at_m) > most) {
            low_m = at_m;
            break;
        }
        high_m = at_m;
    }
    while (high_m - low_m > 1e-6) {
        const double middle_m = 0.5 * (low_m + high_m);
        (difference_between_rotors(ceiling, pair, pitch_rad, middle_m) > most ? low_m : high_m) = middle_m;
    }
    return high_m;
}

Study ceiling_envelope() {
    const SurfaceEffect ceiling(EffectModel::sanchez_cuevas);
    Study study;
    study.name = "ceiling-envelope";
    study.title = "Which pitch a vehicle under a ceiling may have (thesis 4.6, figure 4.9)";
    study.setting = {
        "A pitched vehicle has one rotor nearer to the ceiling than the other, and the nearer one is pulled more. The "
        "thesis "
        "(4.6) reads off how much for three cases and allows forward flight down to 0.25 m, below that only "
        "hover until contact. Here the factor is (2.18), the fit to one rotor; the printed (4.8) does not give these "
        "numbers. The thesis does not say "
        "which distance of the rotors it uses.",
    };
    for (const Reading& reading : readings) {
        for (const Statement& s : statements) {
            const double share =
                difference_between_rotors(ceiling, reading.pair, s.pitch_deg * one_degree, s.distance_m);
            Finding finding;
            finding.name = fmt::format("C1: {:.0f} deg at {:.2f} m, {}", s.pitch_deg, s.distance_m, reading.name);
            finding.thesis = fmt::format("{} %", s.percent);
            finding.measured = percent(share);
            finding.is_reproduced = std::lround(100 * share) == s.percent;
            study.findings.push_back(std::move(finding));
        }
    }
    const RotorPair pair = readings[0].pair;
    const double at_rule = difference_between_rotors(ceiling, pair, 10 * one_degree, 0.25);
    const double least_m = least_distance_m(ceiling, pair, 10 * one_degree, 0.05);
    study.findings.push_back({"C2: forward flight at 10 deg down to 0.25 m keeps the difference below 5 %",
                              "allowed (4.6)",
                              fmt::format("{} at 0.25 m; 5 % is reached at {:.3f} m", percent(at_rule), least_m),
                              at_rule < 0.05, "the rule leaves a margin"});
    study.figures = {
        {"figure_4_9",
         "Thesis figure 4.9: difference between the rotors over the distance, and the least distance for a "
         "difference over the pitch. The level line is the rule of 0.25 m.",
         {difference_figure(ceiling, pair), envelope_figure(ceiling, pair)}}};
    study.tables = {table_of_models(pair)};
    return study;
}

}  // namespace downwash::studies
