#include "downwash/report/field_figure.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "downwash/base/text.hpp"
#include "downwash/report/field_parts.hpp"
#include "downwash/report/gnuplot_script.hpp"
#include "downwash/report/legend.hpp"
#include "downwash/report/obstacle_drawing.hpp"
#include "downwash/report/picture_text.hpp"
#include "downwash/report/plot.hpp"
#include "downwash/report/region_boundary.hpp"

namespace downwash {
namespace {

constexpr char hatch_color[] = "'#9a9a9a'";

/// Samples with a number of points per pixel of the axes, up to a maximum in all.
FieldSamples sampled_for(const FieldFigure& figure, const FieldLayout& layout, double points_per_px,
                         std::size_t max_points, bool at_corners, int threads) {
    const double height_px = layout.top - layout.bottom;
    const double points = layout.width() * height_px * points_per_px * points_per_px;
    const double scale = points_per_px * std::min(1., std::sqrt(static_cast<double>(max_points) / points));
    const auto count = [scale](double px) { return static_cast<std::size_t>(std::max(2L, std::lround(scale * px))); };
    return sampled(figure, count(layout.width()), count(height_px), at_corners, threads);
}

bool is_undefined(float place) {
    return std::isnan(place);
}

/// Lines between the classes, as the data $contours.
void add_contours(GnuplotScript& script, const FieldFigure& figure, const FieldSamples& samples) {
    script.add("set contour base");
    script.add("unset surface");
    script.add("set cntrparam levels incremental 1,1,{}", figure.scale.colors.size() - 1);
    script.add("set table $contours");
    script.add("splot " + samples.source(true));
    script.add_values(samples.places);
    script.add("unset table");
    script.add("unset contour");
}

void add_color_bar(GnuplotScript& script, const FieldFigure& figure, const FieldLayout& layout) {
    const ColorScale& scale = figure.scale;
    const std::size_t classes = scale.colors.size();
    std::string palette;
    for (std::size_t i = 0; i < classes; ++i) {
        palette += fmt::format("{}{} {}", i == 0 ? "" : ", ", i, in_quotes(scale.colors[i]));
    }
    script.add("set palette defined ({}) maxcolors {}", palette, classes);
    script.add("set cbrange [0:{}]", classes);

    std::vector<std::string> texts;
    for (const double limit : scale.limits) {
        texts.push_back(to_text(std::abs(limit) < 1e-12 ? 0 : limit, 4));
    }
    const bool has_names = !scale.names.empty();
    double widest_px = 0;
    for (const std::string& text : has_names ? scale.names : texts) {
        widest_px = std::max(widest_px, text_width_px(text, font_px) + 8);
    }
    const auto every =
        static_cast<std::size_t>(std::max(1., std::ceil(widest_px * static_cast<double>(classes) / layout.width())));
    std::string tics;
    const auto add_tic = [&](std::string_view text, double place) {
        tics += fmt::format("{}{} {}", tics.empty() ? "" : ", ", in_quotes(text), place);
    };
    if (has_names) {
        for (std::size_t i = 0; i < classes; ++i) {
            add_tic(scale.names[i], static_cast<double>(i) + 0.5);
        }
    } else {
        for (std::size_t i = 0; i <= classes; i += every) {
            add_tic(texts[i], static_cast<double>(i));
        }
    }
    script.add("set cbtics ({}) scale 0.3 offset 0,0.4", tics);
    script.add("set colorbox horizontal user origin {},{} size {},{} border", script.screen_x(layout.left),
               script.screen_y(layout.bar_bottom), script.screen_x(layout.width()), script.screen_y(14));
    script.add_line_of_text(scale.label, (layout.left + layout.right) / 2, 13, 1, "'#000000'");
}

void add_arrows(GnuplotScript& script, const FigureLines& lines, const Bounds& extent) {
    const auto is_shown = [&](const PlanePoint& p) {
        return p.x_m > extent.x_low_m && p.x_m < extent.x_high_m && p.z_m > extent.z_low_m && p.z_m < extent.z_high_m;
    };
    for (const Ring& piece : lines.pieces) {
        if (piece.size() < 2) {
            continue;
        }
        const PlanePoint& from = piece[piece.size() / 2 - 1];
        const PlanePoint& to = piece[piece.size() / 2];
        if (is_shown(from) && is_shown(to)) {
            script.add(
                "set arrow from {:.9g},{:.9g} to {:.9g},{:.9g} front size screen 0.009,20 fixed filled "
                "linecolor rgb {} linewidth {}",
                from.x_m, from.z_m, to.x_m, to.z_m, in_quotes(lines.color), lines.width_px);
        }
    }
}

void add_marks(Plot& plot, const FieldFigure& figure) {
    for (std::size_t i = 0; i < figure.lines.size(); ++i) {
        const FigureLines& lines = figure.lines[i];
        plot.add_lines(
            fmt::format("$line{}", i),
            fmt::format("linewidth {}{} linecolor rgb {}", lines.width_px, dash_of(lines.dash), in_quotes(lines.color)),
            lines.name);
    }
    for (std::size_t i = 0; i < figure.points.size(); ++i) {
        plot.add_points(fmt::format("$point{}", i),
                        fmt::format("pointtype 7 pointsize 0.9 linecolor rgb {}", in_quotes(figure.points[i].color)),
                        figure.points[i].name);
    }
}

void add_mark_data(GnuplotScript& script, const FieldFigure& figure) {
    for (std::size_t i = 0; i < figure.lines.size(); ++i) {
        add_data(script, fmt::format("$line{}", i), lines_text(figure.lines[i].pieces, false));
        if (figure.lines[i].has_arrows) {
            add_arrows(script, figure.lines[i], figure.extent);
        }
    }
    for (std::size_t i = 0; i < figure.points.size(); ++i) {
        add_data(script, fmt::format("$point{}", i), points_text(figure.points[i].points, false));
    }
}

/// The line around the area where the field is not defined, as the data $boundary.
void add_boundary(GnuplotScript& script, const FieldFigure& figure, const FieldLayout& layout) {
    constexpr double px_per_cell = 2;
    const auto cells = [](double px) { return static_cast<std::size_t>(std::max(1L, std::lround(px / px_per_cell))); };
    const auto is_undefined_at = [&](double x_m, double z_m) { return std::isnan(figure.value(x_m, z_m)); };
    add_data(script, "$boundary",
             lines_text(region_boundary(is_undefined_at, figure.extent, cells(layout.width()),
                                        cells(layout.top - layout.bottom)),
                        false));
}

void add_axes(GnuplotScript& script, const FieldFigure& figure, const FieldLayout& layout) {
    const Bounds& extent = figure.extent;
    script.set_axes(layout.left, layout.right, layout.bottom, layout.top);
    script.add("set xrange [{}:{}]", extent.x_low_m, extent.x_high_m);
    script.add("set yrange [{}:{}]", extent.z_low_m, extent.z_high_m);
    // Without this, gnuplot omits pieces of lines that cross the frame from outside to outside.
    script.add("set clip two");
    script.add("set xlabel {} offset 0,0.3", in_quotes(figure.x_label));
    script.add("set ylabel {} offset 0.8,0", in_quotes(figure.z_label));
}

}  // namespace

AxisRange value_range(const std::function<double(double, double)>& value, const Bounds& extent, int steps,
                      double included) {
    AxisRange range{included, included};
    for (int i = 0; i <= steps; ++i) {
        for (int k = 0; k <= steps; ++k) {
            const double at = value(extent.x_low_m + (extent.x_high_m - extent.x_low_m) * i / steps,
                                    extent.z_low_m + (extent.z_high_m - extent.z_low_m) * k / steps);
            range = {std::fmin(range.low, at), std::fmax(range.high, at)};
        }
    }
    return range;
}

std::string draw(const FieldFigure& figure, const PictureSettings& settings) {
    require_drawable(figure.extent);
    const double max_px_per_m = settings.width_px / (figure.extent.x_high_m - figure.extent.x_low_m);
    const std::vector<VisibleOutline> outlines =
        visible_outlines(thinned_outlines(merged_outlines(figure.obstacles), max_px_per_m), figure.extent);

    // The legend determines the layout, and the layout how finely the field is sampled. The legend also says whether
    // the field is defined everywhere, which a coarse sampling finds out first.
    const FieldSamples glance = sampled(figure, 300, 300, false, settings.threads);
    const bool has_undefined = std::any_of(glance.places.begin(), glance.places.end(), is_undefined);
    const bool has_field = !std::all_of(glance.places.begin(), glance.places.end(), is_undefined);
    Legend legend;
    Plot plot(legend), overlay(legend);
    if (has_undefined) {
        plot.add_fill("$all",
                      fmt::format("fillstyle pattern 5 border linecolor rgb {0} fillcolor rgb {0}", hatch_color),
                      figure.undefined_name);
    }
    add_obstacles(overlay, outlines);
    add_marks(overlay, figure);

    const FieldLayout layout = layout_of(figure, settings.width_px, legend);
    GnuplotScript script(settings, layout.height);
    const double middle_px = settings.width_px / 2.;
    script.set_titles(figure.title, figure.subtitle, middle_px, layout.height);
    legend.place(script, middle_px, layout.legend_top, layout.room);
    add_axes(script, figure, layout);
    add_color_bar(script, figure, layout);
    add_obstacle_data(script, outlines);
    if (figure.has_names) {
        add_obstacle_names(script, figure, outlines, layout);
    }
    add_mark_data(script, figure);
    const Bounds& extent = figure.extent;
    add_data(script, "$all",
             points_text({{extent.x_low_m, extent.z_low_m},
                          {extent.x_high_m, extent.z_low_m},
                          {extent.x_high_m, extent.z_high_m},
                          {extent.x_low_m, extent.z_high_m}},
                         true));
    FieldSamples image;
    if (has_field) {
        constexpr std::size_t max_image_points = 1'500'000, max_contour_points = 300'000;
        const double points_per_px = settings.format == PictureFormat::png ? 1 : 2;
        image = sampled_for(figure, layout, points_per_px, max_image_points, false, settings.threads);
        plot.add(image.source() + " with image");
        if (figure.has_contour_lines) {
            add_contours(script, figure, sampled_for(figure, layout, 0.5, max_contour_points, true, settings.threads));
            plot.add_lines("$contours", "linewidth 0.5 linecolor rgb '#404040'");
        }
        if (has_undefined) {
            add_boundary(script, figure, layout);
            plot.add_lines("$boundary", "linewidth 1.2 linecolor rgb '#707070'");
        }
    }
    script.add("plot " + plot.elements() + (overlay.elements().empty() ? "" : ", ") + overlay.elements());
    if (has_field) {
        script.add_values(image.places);
    }
    return script.draw();
}

}  // namespace downwash
