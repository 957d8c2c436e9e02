#include "downwash/report/gnuplot_script.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "downwash/base/fault.hpp"
#include "downwash/report/gnuplot.hpp"
#include "downwash/report/picture_text.hpp"

namespace downwash {

GnuplotScript::GnuplotScript(const PictureSettings& settings, double height_px)
    : settings_(settings), height_px_(static_cast<int>(std::lround(height_px))) {
    if (settings.width_px < least_picture_width_px || settings.width_px > most_picture_width_px) {
        throw InputError({{"width_px", fmt::format("{} is out of range: expected {} to {} pixels", settings.width_px,
                                                   least_picture_width_px, most_picture_width_px)}});
    }
    const bool is_png = settings.format == PictureFormat::png;
    add("set encoding utf8");
    add(fmt::format("set terminal {} size {},{} noenhanced font 'DejaVu Sans,{}' background '#ffffff'",
                    is_png ? "pngcairo" : "svg", settings.width_px, height_px_, is_png ? font_px * 0.75 : font_px));
    add("set border linewidth 1 linecolor rgb '#333333'");
    add("set tics nomirror out scale 0.5 textcolor rgb '#333333'");
}

void GnuplotScript::add_values(std::span<const float> values) {
    // gnuplot reads numbers in the machine's own byte order.
    text_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    text_ += '\n';
}

void GnuplotScript::set_axes(double left_px, double right_px, double bottom_px, double top_px) {
    add(fmt::format("set lmargin at screen {}", screen_x(left_px)));
    add(fmt::format("set rmargin at screen {}", screen_x(right_px)));
    add(fmt::format("set bmargin at screen {}", screen_y(bottom_px)));
    add(fmt::format("set tmargin at screen {}", screen_y(top_px)));
}

void GnuplotScript::add_line_of_text(std::string_view text, double middle_px, double bottom_px, double size,
                                     std::string_view color) {
    constexpr double rim_px = 8;
    const double room_px = 2 * (std::min(middle_px, settings_.width_px - middle_px) - rim_px);
    const double needed_px = text_width_px(text, size * font_px);
    const double fitting = needed_px > room_px ? size * room_px / needed_px : size;
    // pngcairo counts in points, of which 72 are 96 pixels.
    const double unit = settings_.format == PictureFormat::png ? 0.75 : 1;
    add(fmt::format("set label {} at screen {:.6f},{:.6f} center font ',{:.4g}' textcolor rgb {}", in_quotes(text),
                    screen_x(middle_px), screen_y(bottom_px), unit * fitting * font_px, color));
}

void GnuplotScript::set_titles(std::string_view title, std::string_view subtitle, double middle_px, double top_px) {
    constexpr double title_size = 1.2, subtitle_size = 1;
    if (!title.empty()) {
        add_line_of_text(title, middle_px, top_px - 16, title_size, "'#000000'");
    }
    if (!subtitle.empty()) {
        add_line_of_text(subtitle, middle_px, top_px - 42, subtitle_size, "'#555555'");
    }
}

std::string GnuplotScript::draw() const {
    std::string picture = run_gnuplot(text_);
    // A full disk would cut it short without a word.
    const std::string_view end = settings_.format == PictureFormat::png ? "IEND" : "</svg>";
    constexpr std::size_t longest_end = 16;
    if (picture.find(end, picture.size() - std::min(picture.size(), longest_end)) == std::string::npos) {
        throw PictureError("gnuplot's picture is incomplete; is there space left for temporary files?");
    }
    return picture;
}

std::string in_quotes(const Color& color) {
    return fmt::format("'#{:02x}{:02x}{:02x}'", color.red, color.green, color.blue);
}

}  // namespace downwash
