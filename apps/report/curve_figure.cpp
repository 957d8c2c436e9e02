#include "downwash/report/curve_figure.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/report/gnuplot_script.hpp"
#include "downwash/report/legend.hpp"
#include "downwash/report/picture_text.hpp"

namespace downwash {
namespace {

constexpr std::array colors{color_of(0x0072b2), color_of(0xd55e00), color_of(0x009e73), color_of(0xcc79a7),
                            color_of(0x000000), color_of(0xe69f00), color_of(0x56b4e9), color_of(0x969696)};
constexpr std::array<std::string_view, 4> dashes{"", " dashtype (26,12)", " dashtype (9,7)", " dashtype (26,8,5,8)"};
constexpr char dotted[] = "linewidth 1.6 dashtype (2,5)";
constexpr std::array<int, 6> point_types{7, 5, 9, 13, 6, 4};

bool is_finite(const DiagramPoint& p) {
    return std::isfinite(p.x) && std::isfinite(p.y);
}

void require_drawable(const CurveFigure& figure, const std::string& key) {
    std::vector<KeyError> errors;
    std::size_t points = 0;
    for (const Curve& curve : figure.curves) {
        points += static_cast<std::size_t>(std::count_if(curve.points.begin(), curve.points.end(), is_finite));
    }
    for (const MeasuredPoints& measured : figure.measurements) {
        points += static_cast<std::size_t>(std::count_if(measured.points.begin(), measured.points.end(), is_finite));
        if (!measured.errors.empty() && measured.errors.size() != measured.points.size()) {
            errors.push_back({key + ".measurements", fmt::format("{} points have {} errors: expected one each, or none",
                                                                 measured.points.size(), measured.errors.size())});
        }
    }
    if (points == 0) {
        errors.push_back({key, "there is nothing to draw: expected a curve or measurements with finite points"});
    }
    for (const auto* range : {&figure.x_range, &figure.y_range}) {
        if (*range && !((*range)->low < (*range)->high && std::isfinite((*range)->high - (*range)->low))) {
            errors.push_back({key + ".range", fmt::format("{} to {} is empty: expected finite numbers, the lower first",
                                                          to_text((*range)->low), to_text((*range)->high))});
        }
    }
    throw_if_any(std::move(errors));
}

/// Whether two curves lie one over the other for the most part: their mean distance is at most a hundredth of the
/// range.
bool coincide(const Curve& a, const Curve& b) {
    constexpr double max_share = 0.01;
    if (a.points.size() != b.points.size()) {
        return false;
    }
    double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0;
    for (std::size_t i = 0; i < a.points.size(); ++i) {
        const double y = a.points[i].y, distance = std::abs(y - b.points[i].y);
        if (a.points[i].x != b.points[i].x) {
            return false;
        }
        if (std::isfinite(distance)) {
            low = std::min(low, y);
            high = std::max(high, y);
            sum += distance;
        }
    }
    return sum <= max_share * (high - low) * static_cast<double>(a.points.size());
}

/// The range of the y axis for the data, with a margin.
AxisRange needed_range(const CurveFigure& figure) {
    constexpr double room = 0.04;
    AxisRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    const auto widen = [&](double x, double y) {
        const bool is_shown = !figure.x_range || (x >= figure.x_range->low && x <= figure.x_range->high);
        if (is_shown && std::isfinite(y)) {
            range = {std::min(range.low, y), std::max(range.high, y)};
        }
    };
    for (const Curve& curve : figure.curves) {
        for (const DiagramPoint& p : curve.points) {
            widen(p.x, p.y);
        }
    }
    for (const MeasuredPoints& measured : figure.measurements) {
        for (std::size_t i = 0; i < measured.points.size(); ++i) {
            const DiagramPoint& p = measured.points[i];
            const double error = measured.errors.empty() ? 0 : measured.errors[i];
            widen(p.x, p.y - error);
            widen(p.x, p.y + error);
        }
    }
    if (figure.level) {
        range = {std::min(range.low, *figure.level), std::max(range.high, *figure.level)};
    }
    if (!(range.low <= range.high)) {  // nothing within the range of x
        return {0, 1};
    }
    const double size = range.high - range.low;
    const double more = size > 0 ? room * size : std::max(1e-6, room * std::abs(range.high));
    return {range.low - more, range.high + more};
}

/// One figure of a picture.
class Panel {
 public:
    Panel(const CurveFigure& figure, std::size_t number, double width_px) : figure_(figure), number_(number) {
        for (std::size_t i = 0; i < figure.curves.size(); ++i) {
            add_curve(figure.curves[i], i);
        }
        for (std::size_t i = 0; i < figure.measurements.size(); ++i) {
            add_measurements(figure.measurements[i], i);
        }
        if (has_dotted_) {
            legend_.add(figure.dotted_name, {fmt::format("{} linecolor rgb '#606060'", dotted), {}, {}});
        }
        legend_height_px_ = legend_.height_px(width_px);
    }

    /// From its bottom to its top [px].
    [[nodiscard]] double height_px(double axes_px) const { return below_axes_px + axes_px + above_axes_px(); }

    void add_to(GnuplotScript& script, double left_px, double right_px, double bottom_px, double axes_px) const {
        const double middle_px = (left_px + right_px) / 2;
        const double axes_top_px = bottom_px + below_axes_px + axes_px;
        // Labels of one panel must not be repeated at the next.
        script.add("unset label\nunset arrow\nunset object");
        script.set_titles(figure_.title, figure_.subtitle, middle_px, axes_top_px + above_axes_px());
        legend_.place(script, middle_px, axes_top_px + legend_height_px_ + 4, right_px - left_px);
        script.set_axes(left_px, right_px, bottom_px + below_axes_px, axes_top_px);
        add_range(script, "x", figure_.x_range);
        add_range(script, "y", figure_.y_range.value_or(needed_range(figure_)));
        script.add("set xlabel {} offset 0,0.3", in_quotes(figure_.x_label));
        // As an axis label it would leave the picture if the numbers at the axis are long.
        constexpr double y_label_px = 14;
        script.add("set label {} at screen {:.6f},{:.6f} center rotate by 90", in_quotes(figure_.y_label),
                   script.screen_x(y_label_px), script.screen_y(bottom_px + below_axes_px + axes_px / 2));
        script.add(data_);
        std::string level;
        if (figure_.level) {
            level = fmt::format("{} with lines linewidth 0.8 linecolor rgb '#606060' notitle, ", *figure_.level);
        }
        script.add("plot " + level + elements_);
    }

 private:
    static constexpr double below_axes_px = 62;

    [[nodiscard]] double above_axes_px() const {
        const double titles_px = figure_.title.empty() ? 10 : (figure_.subtitle.empty() ? 40 : 62);
        return titles_px + legend_height_px_ + 6;
    }

    static void add_range(GnuplotScript& script, std::string_view axis, const std::optional<AxisRange>& range) {
        script.add(range ? fmt::format("set {}range [{}:{}]", axis, range->low, range->high)
                         : fmt::format("set {}range [*:*]", axis));
    }

    /// Adds one block of data and its drawing style.
    void add(const std::string& rows, const std::string& how) {
        const std::string name = fmt::format("$data{}_{}", number_, count_++);
        data_ += name + " << END_OF_DATA\n" + rows + "END_OF_DATA\n";
        elements_ += fmt::format("{}{} {} notitle", elements_.empty() ? "" : ", ", name, how);
    }

    void add_curve(const Curve& curve, std::size_t i) {
        const auto is_known = [&curve](const DiagramPoint& p) {
            return !curve.known_range || (p.x >= curve.known_range->low && p.x <= curve.known_range->high);
        };
        const auto& points = curve.points;
        // The interval across an end of the range is dotted.
        std::string known_rows, other_rows;
        for (std::size_t k = 0; k < points.size(); ++k) {
            const std::string row =
                is_finite(points[k]) ? fmt::format("{:.9g} {:.9g}\n", points[k].x, points[k].y) : "\n";
            const bool is_beside_other =
                (k > 0 && !is_known(points[k - 1])) || (k + 1 < points.size() && !is_known(points[k + 1]));
            known_rows += is_known(points[k]) ? row : "\n";
            other_rows += !is_known(points[k]) || is_beside_other ? row : "\n";
        }
        const std::string color = in_quotes(colors[i % colors.size()]);
        // A curve over others is broken, so that they show through its gaps.
        const auto& curves = figure_.curves;
        const auto below = std::count_if(curves.begin(), curves.begin() + static_cast<std::ptrdiff_t>(i),
                                         [&curve](const Curve& earlier) { return coincide(earlier, curve); });
        const std::size_t dash = i / colors.size() + static_cast<std::size_t>(below);
        const std::string style = fmt::format("linewidth 2{} linecolor rgb {}", dashes[dash % dashes.size()], color);
        if (std::any_of(points.begin(), points.end(), is_known)) {
            add(known_rows, "using 1:2 with lines " + style);
        }
        legend_.add(curve.name, {style, {}, {}});
        if (!std::all_of(points.begin(), points.end(), is_known)) {
            add(other_rows, fmt::format("using 1:2 with lines {} linecolor rgb {}", dotted, color));
            has_dotted_ = true;
        }
    }

    void add_measurements(const MeasuredPoints& measured, std::size_t i) {
        const bool has_errors = !measured.errors.empty();
        std::string rows;
        for (std::size_t k = 0; k < measured.points.size(); ++k) {
            const DiagramPoint& p = measured.points[k];
            const double error = has_errors && std::isfinite(measured.errors[k]) ? measured.errors[k] : 0;
            rows += is_finite(p) ? fmt::format("{:.9g} {:.9g} {:.9g}\n", p.x, p.y, error) : "\n";
        }
        // Colours continue after those of the curves, so that points do not seem to belong to a curve.
        const std::string style =
            fmt::format("pointtype {} pointsize 1 linecolor rgb {}", point_types[i % point_types.size()],
                        in_quotes(colors[(figure_.curves.size() + i) % colors.size()]));
        add(rows, (has_errors ? "using 1:2:3 with yerrorbars linewidth 1.2 " : "using 1:2 with points ") + style);
        legend_.add(measured.name, {{}, {}, style});
    }

    const CurveFigure& figure_;
    std::size_t number_;
    Legend legend_;
    double legend_height_px_ = 0;
    int count_ = 0;
    bool has_dotted_ = false;
    std::string data_, elements_;
};

}  // namespace

std::string draw(std::span<const CurveFigure> figures, const PictureSettings& settings) {
    constexpr double left_px = 100, right_px = 24;
    if (figures.empty()) {
        throw_input_error("there is no figure to draw: expected at least one", "figures");
    }
    const double width_px = settings.width_px - left_px - right_px;
    std::vector<Panel> panels;
    double height_px = 0;
    // A figure alone or above its residuals is high; one of many is low.
    const auto axes_px = [&](std::size_t i) { return width_px * (i == 0 && figures.size() <= 2 ? 0.5 : 0.22); };
    for (std::size_t i = 0; i < figures.size(); ++i) {
        require_drawable(figures[i], fmt::format("figures[{}]", i));
        panels.emplace_back(figures[i], i, width_px);
        height_px += panels.back().height_px(axes_px(i));
    }
    GnuplotScript script(settings, height_px);
    script.add("set grid linewidth 0.5 linecolor rgb '#dddddd'");
    script.add("set multiplot");
    double bottom_px = std::round(height_px);
    for (std::size_t i = 0; i < panels.size(); ++i) {
        bottom_px -= panels[i].height_px(axes_px(i));
        panels[i].add_to(script, left_px, settings.width_px - right_px, bottom_px, axes_px(i));
    }
    script.add("unset multiplot");
    return script.draw();
}

}  // namespace downwash
