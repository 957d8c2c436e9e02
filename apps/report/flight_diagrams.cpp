#include "downwash/report/flight_diagrams.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"

namespace downwash {
namespace {

/// The length of the step from a row to the next [m].
double way_after_m(const FlightColumns& flight, const std::vector<std::string_view>& axes, std::size_t row) {
    double square = 0;
    for (const std::string_view axis : axes) {
        const double step = flight[axis][row + 1] - flight[axis][row];
        square += step * step;
    }
    return std::sqrt(square);
}

/// One curve per rotor; rotors with equal values share one.
std::vector<Curve> rotor_curves(const FlightColumns& flight, std::size_t rotors, const std::string& column) {
    std::vector<Curve> curves;
    std::vector<std::size_t> shown;
    for (std::size_t i = 1; i <= rotors; ++i) {
        const auto& values = flight[fmt::format("rotor_{}_{}", i, column)];
        bool is_shown = false;
        for (std::size_t k = 0; k < shown.size() && !is_shown; ++k) {
            if (flight[fmt::format("rotor_{}_{}", shown[k], column)] == values) {
                curves[k].name += fmt::format(", {}", i);
                is_shown = true;
            }
        }
        if (!is_shown) {
            shown.push_back(i);
            curves.push_back({fmt::format("rotor {}", i), over_time(flight, values)});
        }
    }
    return curves;
}

}  // namespace

void require_flight(const NumberTable& flight) {
    if (flight.rows() < 2) {
        throw_input_error(flight.rows() == 0 ? "this run contains no flight"
                                             : "the flight has one row only, too little to draw");
    }
}

std::vector<std::size_t> snapshot_rows(const FlightColumns& flight, const std::vector<std::string_view>& axes,
                                       double vehicle_m, double min_count, double max_count) {
    double length_m = 0;
    for (std::size_t row = 0; row + 1 < flight.rows(); ++row) {
        length_m += way_after_m(flight, axes, row);
    }
    const double count = std::clamp(std::round(length_m / (1.3 * vehicle_m)), min_count, max_count);
    std::vector<std::size_t> rows;
    const auto last = static_cast<double>(flight.rows() - 1);
    for (double i = 0; i <= count; ++i) {
        rows.push_back(static_cast<std::size_t>(std::lround(last * i / count)));
    }
    return rows;
}

std::string interval_text(const FlightColumns& flight, const std::vector<std::size_t>& rows) {
    const std::vector<double>& times_s = flight["t_s"];
    return fmt::format("every {} s of {} s", to_text(times_s[rows[1]] - times_s[rows[0]], 3),
                       to_text(times_s.back(), 4));
}

std::vector<DiagramPoint> over_time(const FlightColumns& flight, const std::vector<double>& values, double factor) {
    std::vector<DiagramPoint> points;
    for (std::size_t i = 0; i < values.size(); ++i) {
        points.push_back({flight["t_s"][i], factor * values[i]});
    }
    return points;
}

std::vector<double> tracking_error_m(const FlightColumns& flight, const std::vector<std::string_view>& axes) {
    std::vector<double> errors_m(flight.rows());
    for (std::size_t row = 0; row < flight.rows(); ++row) {
        for (const std::string_view axis : axes) {
            const double error_m = flight[axis][row] - flight[fmt::format("ref_{}", axis)][row];
            errors_m[row] = std::hypot(errors_m[row], error_m);
        }
    }
    return errors_m;
}

CurveFigure time_diagram(std::string y_label, std::vector<Curve> curves) {
    CurveFigure figure;
    figure.x_label = "time [s]";
    figure.y_label = std::move(y_label);
    figure.curves = std::move(curves);
    return figure;
}

void add_common_diagrams(std::vector<CurveFigure>& figures, const FlightColumns& flight, std::size_t rotors,
                         double margin_m, const char* power_of) {
    figures.push_back(time_diagram("rotor command [N]", rotor_curves(flight, rotors, "cmd_n")));
    figures.push_back(time_diagram("aero factor", rotor_curves(flight, rotors, "aero_factor")));
    if (!std::isnan(flight["clearance_m"].front())) {
        figures.push_back(time_diagram("clearance [m]", {{"to obstacles", over_time(flight, flight["clearance_m"])}}));
        figures.back().level = margin_m;
    }
    figures.push_back(time_diagram("power [W]", {{power_of, over_time(flight, flight["power_w"])}}));
}

void finish(std::vector<CurveFigure>& figures, const FlightColumns& flight, std::string title, std::string subtitle) {
    for (CurveFigure& figure : figures) {
        figure.x_range = AxisRange{flight["t_s"].front(), flight["t_s"].back()};
    }
    figures.front().title = std::move(title);
    figures.front().subtitle = std::move(subtitle);
}

}  // namespace downwash
