#pragma once

// Private: not installed. What pictures of runs in a plane and in space share.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/report/curve_figure.hpp"
#include "downwash/results/number_table.hpp"

namespace downwash {

/// @throws InputError unless a flight has at least two rows
void require_flight(const NumberTable& flight);

/// The columns of a flight by name. @pre the names are there
struct FlightColumns {
    const NumberTable& table;

    [[nodiscard]] const std::vector<double>& operator[](std::string_view name) const { return *table.find(name); }
    [[nodiscard]] std::size_t rows() const { return table.rows(); }
};

/// Rows at equal intervals of about one vehicle length, the last one included.
/// @param axes columns with the coordinates of the vehicle   @param min_count,max_count of intervals
[[nodiscard]] std::vector<std::size_t> snapshot_rows(const FlightColumns& flight,
                                                     const std::vector<std::string_view>& axes, double vehicle_m,
                                                     double min_count, double max_count);

/// "every 1.2 s of 14 s".
[[nodiscard]] std::string interval_text(const FlightColumns& flight, const std::vector<std::size_t>& rows);

[[nodiscard]] std::vector<DiagramPoint> over_time(const FlightColumns& flight, const std::vector<double>& values,
                                                  double factor = 1);

/// The distance from the reference. @param axes columns whose reference is `ref_` before their name
[[nodiscard]] std::vector<double> tracking_error_m(const FlightColumns& flight,
                                                   const std::vector<std::string_view>& axes);

/// A diagram over time.
[[nodiscard]] CurveFigure time_diagram(std::string y_label, std::vector<Curve> curves);

/// Rotor commands, aero factors, clearance where there are obstacles, power.
/// @param margin_m level line of the clearance
void add_common_diagrams(std::vector<CurveFigure>& figures, const FlightColumns& flight, std::size_t rotors,
                         double margin_m, const char* power_of);

/// All diagrams cover the flight, and the first has the titles.
void finish(std::vector<CurveFigure>& figures, const FlightColumns& flight, std::string title, std::string subtitle);

}  // namespace downwash
