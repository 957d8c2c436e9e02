#include <fmt/core.h>

#include <cmath>
#include <vector>

#include "downwash/base/lane_math.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/plot_request.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/effects/potential_flow.hpp"
#include "downwash/report/flow_figure.hpp"

namespace downwash::cli {
namespace {

/// Points around a source, at which streamlines begin.
std::vector<PlanePoint> points_around(double z) {
    constexpr int count = 24;
    constexpr double radius = 0.05;
    constexpr double whole_turn_rad = 6.283185307179586;
    std::vector<PlanePoint> points;
    for (int i = 0; i < count; ++i) {
        // Half a step off the axis, along which the flow would run into the ground and end.
        const auto [sine, cosine] = lane::sin_cos(whole_turn_rad * (i + 0.5) / count);
        points.push_back({radius * cosine, z + radius * sine});
    }
    return points;
}

}  // namespace

FieldFigure potential_flow_figure(const PlotRequest& request) {
    constexpr double lowest = 0.1, highest = 10, beyond = 1.25, reach = 1;
    if (request.z_over_r.size() != 1 || !(request.z_over_r[0] >= lowest && request.z_over_r[0] <= highest)) {
        throw UsageError("--flow needs --z-over-r H, the height of the rotor in radii, from {} to {}", lowest, highest);
    }
    const double height = request.z_over_r[0];
    const PlanarVelocity velocity = [height](double x, double z) -> std::array<double, 2> {
        const Vector3 v = potential_flow_velocity({x, 0, z}, height);
        return {v[0], v[2]};
    };
    std::vector<PlanePoint> starts = points_around(height);
    const std::vector<PlanePoint> image = points_around(-height);
    starts.insert(starts.end(), image.begin(), image.end());
    const double top = height + beyond;
    FieldFigure figure =
        flow_figure(velocity, {-1.6 * top, 1.6 * top, -top, top}, starts,
                    signed_scale("axial velocity over the induced velocity in free air [1], upwards positive", reach));
    figure.title =
        fmt::format("Potential flow of a rotor at z/R = {} over the ground and of its image", to_text(height, 4));
    figure.subtitle = "thesis (2.10) to (2.12): a source at each hub; the ground between them is a plane of symmetry";
    figure.x_label = "x/R [1]";
    figure.z_label = "z/R [1]";
    figure.lines.push_back({"rotor", {{{-1, height}, {1, height}}}, {0, 0, 0}, 5});
    figure.lines.push_back({"image of the rotor", {{{-1, -height}, {1, -height}}}, {120, 120, 120}, 5});
    figure.lines.push_back({"ground", {{{-1.6 * top, 0}, {1.6 * top, 0}}}, {0, 110, 60}, 3});
    return figure;
}

}  // namespace downwash::cli
