#pragma once

#include <optional>
#include <string>
#include <vector>

#include "downwash/problems/problem.hpp"
#include "downwash/report/curve_figure.hpp"
#include "downwash/report/field_figure.hpp"

namespace downwash::cli {

/// What `aeromap plot` is asked for.
struct PlotRequest {
    std::string problem;
    std::string what = "factor";
    int rotor = 1;
    std::optional<double> lateral_m;
    std::optional<double> arm_deg;
    double pitch_deg = 0;          ///< pitch of the whole vehicle
    std::vector<double> x_m, z_m;  ///< low and high, or empty
    std::vector<std::string> models;
    std::string data, surface, source;
    std::vector<double> z_over_r;
    std::vector<double> tilt_deg;  ///< tilts of rotors over ground; empty: level
    std::optional<double> max_factor, rotor_spacing;
    bool is_flow = false;
    std::string output;
    std::optional<int> width_px;
    bool no_labels = false, is_quiet = false;
};

/// A picture of a problem. @throws UsageError when the request does not fit the problem
using MakeField = FieldFigure(const PlotRequest& request, const Problem& problem, const Bounds& extent);

/// The thrust ratio K of a rotor: "factor", or of one side only: "ground" and "ceiling".
MakeField factor_figure;
/// The thrust of the whole vehicle at a pitch, over the place of its centre of mass.
MakeField force_figure;
/// The parasitic pitch torque on the vehicle [Nm]; the subtitle gives the divisor of its factor.
MakeField torque_figure;
/// Where the vehicle can hover with its arm at an angle, with the boundary of stability.
MakeField hold_figure;

/// What it means in pictures of a problem that a field is not defined at a place.
[[nodiscard]] std::string undefined_name(const Problem& problem);

/// K of models over z/R, with measurements. @throws UsageError
[[nodiscard]] CurveFigure model_figure(const PlotRequest& request);

/// The potential flow of a rotor and its image. @throws UsageError
[[nodiscard]] FieldFigure potential_flow_figure(const PlotRequest& request);

}  // namespace downwash::cli
