#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "downwash/report/field_parts.hpp"
#include "downwash/report/figure_colors.hpp"
#include "downwash/report/gnuplot_script.hpp"
#include "downwash/report/label_placement.hpp"
#include "downwash/report/legend.hpp"
#include "downwash/report/obstacle_drawing.hpp"
#include "downwash/report/picture_text.hpp"
#include "downwash/report/plot.hpp"
#include "downwash/report/space_problem_figure.hpp"

namespace downwash {
namespace {

/// The axes of a view, in pixels from the lower left corner of the picture.
struct Axes {
    double left, right, bottom, top;
};

/// Where everything is. The views share one scale; the front view is to the right of the side view, above which is the
/// one from above. What is left over in the upper right corner holds the legend, if it has room.
struct Layout {
    Axes top{}, side{}, front{};
    double px_per_m = 1, height = 0;
    double legend_middle = 0, legend_top = 0, legend_width = 0;
};

constexpr double left_px = 92, right_px = 24, between_px = 46, below_px = 62, titles_px = 70, view_name_px = 24;

Layout layout_of(const SpaceFigure& figure, double width_px, const Legend& legend) {
    constexpr double max_height = 1.15, least_legend_px = 330;
    const Bounds &top = figure.top.extent, &front = figure.front.extent;
    const double x_m = top.x_high_m - top.x_low_m, y_m = top.z_high_m - top.z_low_m,
                 z_m = front.z_high_m - front.z_low_m;
    const double room_px = width_px - left_px - right_px - between_px;
    Layout layout;
    layout.px_per_m = std::min(room_px / (x_m + y_m), max_height * width_px / (y_m + z_m));
    const double x_px = x_m * layout.px_per_m, y_px = y_m * layout.px_per_m, z_px = z_m * layout.px_per_m;
    const double left = left_px + (room_px - x_px - y_px) / 2, middle = left + x_px + between_px;
    layout.side = {left, left + x_px, below_px, below_px + z_px};
    layout.front = {middle, middle + y_px, below_px, below_px + z_px};
    const double upper = layout.side.top + between_px + view_name_px;
    layout.top = {left, left + x_px, upper, upper + y_px};
    const bool is_beside = y_px >= least_legend_px && legend.height_px(y_px) <= y_px;
    const double full_px = width_px - left_px - right_px;
    layout.height = layout.top.top + view_name_px + titles_px + (is_beside ? 0 : legend.height_px(full_px) + 6);
    layout.legend_width = is_beside ? y_px : full_px;
    layout.legend_middle = is_beside ? middle + y_px / 2 : width_px / 2;
    layout.legend_top = is_beside ? layout.top.top : layout.height - titles_px + 4;
    return layout;
}

/// One view as elements of a plot with their data.
class ViewDrawing {
 public:
    ViewDrawing(const SpaceView& view, int number, double px_per_m, bool has_names, Legend& legend)
        : view_(view), number_(number), px_per_m_(px_per_m), has_names_(has_names), plot_(legend) {
        outlines_ = visible_outlines(thinned_outlines(merged_outlines(view.obstacles), px_per_m), view.extent);
    }

    /// Adds what stands in the legend, each once in the whole picture.
    void add_elements(std::set<std::string>& told) {
        const auto named = [&told](const std::string& name) { return told.insert(name).second ? name : ""; };
        for (std::size_t i = 0; i < outlines_.size(); ++i) {
            if (!outlines_[i].fill.empty()) {
                plot_.add_fill(data("fill", i),
                               fmt::format("fillstyle transparent solid 0.13 noborder fillcolor rgb {}",
                                           in_quotes(obstacle_color)),
                               named("obstacle"));
            }
        }
        for (std::size_t i = 0; i < outlines_.size(); ++i) {
            plot_.add_lines(data("edge", i), fmt::format("linewidth 0.8 linecolor rgb {}", in_quotes(obstacle_color)));
        }
        for (std::size_t i = 0; i < view_.lines.size(); ++i) {
            const FigureLines& lines = view_.lines[i];
            plot_.add_lines(data("line", i),
                            fmt::format("linewidth {}{} linecolor rgb {}", lines.width_px, dash_of(lines.dash),
                                        in_quotes(lines.color)),
                            named(lines.name));
        }
        for (std::size_t i = 0; i < view_.points.size(); ++i) {
            plot_.add_points(
                data("point", i),
                fmt::format("pointtype 7 pointsize 0.8 linecolor rgb {}", in_quotes(view_.points[i].color)),
                named(view_.points[i].name));
        }
    }

    void draw(GnuplotScript& script, const Axes& axes, bool has_across, bool has_up) const {
        script.set_axes(axes.left, axes.right, axes.bottom, axes.top);
        const Bounds& extent = view_.extent;
        script.add("set xrange [{:.9g}:{:.9g}]", extent.x_low_m, extent.x_high_m);
        script.add("set yrange [{:.9g}:{:.9g}]", extent.z_low_m, extent.z_high_m);
        // Tics of both axes are equally far apart, as is the scale.
        const double step_m = tic_step_m();
        script.add("set xtics {0:.9g} format {1}", step_m, has_across ? "'%g'" : "''");
        script.add("set ytics {0:.9g} format {1}", step_m, has_up ? "'%g'" : "''");
        script.add(has_across ? fmt::format("set xlabel {} offset 0,0.3", in_quotes(view_.across)) : "unset xlabel");
        script.add(has_up ? fmt::format("set ylabel {}", in_quotes(view_.up)) : "unset ylabel");
        script.add("set label {} at {} left front textcolor rgb '#333333'", in_quotes(view_.name),
                   script.place(axes.left, axes.top + 13));
        add_names(script);
        add_arrows(script);
        for (std::size_t i = 0; i < outlines_.size(); ++i) {
            for (const auto& [kind, rings, is_closed] :
                 {std::tuple("fill", &outlines_[i].fill, true), std::tuple("edge", &outlines_[i].edges, false)}) {
                add_data(script, data(kind, i), lines_text(*rings, is_closed));
            }
        }
        for (std::size_t i = 0; i < view_.lines.size(); ++i) {
            add_data(script, data("line", i), lines_text(view_.lines[i].pieces, false));
        }
        for (std::size_t i = 0; i < view_.points.size(); ++i) {
            add_data(script, data("point", i), points_text(view_.points[i].points, false));
        }
        script.add("plot " + plot_.elements());
        script.add("unset label");
        script.add("unset arrow");
        script.add("unset object");
    }

 private:
    [[nodiscard]] std::string data(const char* kind, std::size_t i) const {
        return fmt::format("${}{}_{}", kind, number_, i);
    }

    /// A round distance that is some 70 pixels.
    [[nodiscard]] double tic_step_m() const {
        const double wanted_m = 70 / px_per_m_;
        const double power = std::pow(10., std::floor(std::log10(wanted_m)));
        for (const double times : {1., 2., 5.}) {
            if (times * power >= 0.8 * wanted_m) {
                return times * power;
            }
        }
        return 10 * power;
    }

    void add_arrows(GnuplotScript& script) const {
        for (const FigureLines& lines : view_.lines) {
            for (const Ring& piece : lines.pieces) {
                if (lines.has_arrows && piece.size() > 1) {
                    script.add(
                        "set arrow from {:.9g},{:.9g} to {:.9g},{:.9g} front size screen 0.009,20 fixed filled "
                        "linecolor rgb {} linewidth {}",
                        piece.front().x_m, piece.front().z_m, piece.back().x_m, piece.back().z_m,
                        in_quotes(lines.color), lines.width_px);
                }
            }
        }
    }

    /// Names of obstacles, then of points: over no line, no point and no other name.
    void add_names(GnuplotScript& script) const {
        constexpr std::size_t max_characters = 40, most_names = 60;
        constexpr double label_px = 18;
        std::vector<NamedShape> shapes;
        std::vector<std::string> names;
        std::vector<const char*> colors;
        LabelGround ground;
        const double rim_m = 3 / px_per_m_;
        const Bounds& extent = view_.extent;
        const auto add = [&](std::string name, std::vector<Ring> edges, const char* color) {
            const bool is_named = !name.empty() && names.size() < most_names;
            shapes.push_back({is_named ? (text_width_px(name, font_px) + 6) / px_per_m_ : 0, {}, std::move(edges)});
            names.push_back(std::move(name));
            colors.push_back(color);
        };
        for (const FigurePoints& points : view_.points) {
            for (std::size_t i = 0; i < points.points.size(); ++i) {
                const double half_m = 9 / px_per_m_;
                const PlanePoint& at = points.points[i];
                add(points.labels.empty() ? "" : points.labels[i],
                    {{{at.x_m - half_m, at.z_m - half_m},
                      {at.x_m + half_m, at.z_m - half_m},
                      {at.x_m + half_m, at.z_m + half_m},
                      {at.x_m - half_m, at.z_m + half_m},
                      {at.x_m - half_m, at.z_m - half_m}}},
                    points.color == goal_color ? "'#a3397a'" : "'#333333'");
            }
        }
        for (const VisibleOutline& visible : outlines_) {
            add(has_names_ ? picture_text(visible.outline.name, max_characters) : std::string(), visible.edges,
                "'#333333'");
        }
        ground.area = {extent.x_low_m + rim_m, extent.x_high_m - rim_m, extent.z_low_m + rim_m,
                       extent.z_high_m - rim_m};
        ground.px_per_m = px_per_m_;
        ground.height_m = label_px / px_per_m_;
        for (const FigureLines& lines : view_.lines) {
            if (lines.dash == LineDash::dotted) {
                continue;  // fine enough to be read through
            }
            ground.taken.insert(ground.taken.end(), lines.pieces.begin(), lines.pieces.end());
        }
        ground.background = [](const PlanePoint&) { return 0; };
        for (const PlacedLabel& label : place_labels(shapes, ground)) {
            if (label.leader) {
                const auto& [from, to] = *label.leader;
                script.add("set arrow from {:.9g},{:.9g} to {:.9g},{:.9g} nohead front linecolor rgb {} linewidth 0.8",
                           from.x_m, from.z_m, to.x_m, to.z_m, in_quotes(outline_color));
            }
            script.add("set label {} at {:.9g},{:.9g} center front textcolor rgb {}", in_quotes(names[label.shape]),
                       (label.box.x_low_m + label.box.x_high_m) / 2, (label.box.z_low_m + label.box.z_high_m) / 2,
                       colors[label.shape]);
        }
    }

    const SpaceView& view_;
    int number_;
    double px_per_m_;
    bool has_names_;
    Plot plot_;
    std::vector<VisibleOutline> outlines_;
};

}  // namespace

std::string draw(const SpaceFigure& figure, const PictureSettings& settings) {
    // The legend decides on the layout, which decides on the scale and with it on what is drawn, but not on the legend.
    Legend legend;
    Layout layout = layout_of(figure, settings.width_px, legend);
    std::set<std::string> told;
    std::vector<ViewDrawing> views;
    int number = 0;
    for (const SpaceView* view : {&figure.top, &figure.side, &figure.front}) {
        views.emplace_back(*view, number++, layout.px_per_m, figure.has_names, legend);
        views.back().add_elements(told);
    }
    layout = layout_of(figure, settings.width_px, legend);

    GnuplotScript script(settings, layout.height);
    script.add("set multiplot");
    script.set_titles(figure.title, figure.subtitle, settings.width_px / 2., std::round(layout.height));
    legend.place(script, layout.legend_middle, layout.legend_top, layout.legend_width);
    views[0].draw(script, layout.top, false, true);
    views[1].draw(script, layout.side, true, true);
    views[2].draw(script, layout.front, true, false);
    script.add("unset multiplot");
    return script.draw();
}

}  // namespace downwash
