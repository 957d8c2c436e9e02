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
    double arm_deg = 0;
    double pitch_deg = 0;          ///< of the whole vehicle
    std::vector<double> x_m, z_m;  ///< low and high, or empty
    std::vector<std::string> models;
    std::string data, surface, source;
    std::vector<double> z_over_r;
    std::optional<double> max_factor, rotor_spacing;
    bool is_flow = false;
    std::vector<std::string> given_options;
    std::string output;
    int width_px = 1200;
    bool is_quiet = false;
};

/// What a picture is about; options go with some of these.
enum PictureSubject : unsigned {
    one_rotor = 1,       ///< of a problem
    whole_vehicle = 2,   ///< of a problem
    where_to_hover = 4,  ///< of a problem
    curves = 8,
    flow = 16,
};

/// One kind of picture of a problem, by the name that --what gives it.
struct FieldKind {
    const char* name;
    const char* description;
    PictureSubject subject;
    FieldFigure (*make)(const PlotRequest& request, const Problem& problem, const Bounds& extent);
};

/// What it means in pictures of a problem that nothing is known at a place.
[[nodiscard]] std::string undefined_name(const Problem& problem);

/// The factor on the thrust of a rotor, or one of its sides: "factor", "ground" and "ceiling". @throws UsageError
[[nodiscard]] FieldFigure factor_figure(const PlotRequest& request, const Problem& problem, const Bounds& extent);

/// K of models over z/R, with measurements. @throws UsageError
[[nodiscard]] CurveFigure model_figure(const PlotRequest& request);

/// The potential flow of a rotor and its image. @throws UsageError
[[nodiscard]] FieldFigure potential_flow_figure(const PlotRequest& request);

}  // namespace downwash::cli
