#include "downwash/report/gnuplot_script.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "downwash/base/key_error.hpp"
#include "downwash/report/figure_colors.hpp"
#include "downwash/report/gnuplot.hpp"
#include "downwash/report/picture_text.hpp"

namespace downwash {
namespace {

constexpr double px_per_inch = 96;

/// gnuplot's terminals of cairo count text in points, of which 72 are an inch.
double text_unit(PictureFormat format) {
    return format == PictureFormat::svg ? 1 : 72 / px_per_inch;
}

std::string terminal(const PictureSettings& settings, int height_px) {
    switch (settings.format) {
        case PictureFormat::png:
            return fmt::format("pngcairo size {},{}", settings.width_px, height_px);
        case PictureFormat::pdf:
            // Lines of a quarter of a point are its unit.
            return fmt::format("pdfcairo size {}in,{}in linewidth 3", settings.width_px / px_per_inch,
                               height_px / px_per_inch);
        case PictureFormat::svg:
            break;
    }
    return fmt::format("svg size {},{}", settings.width_px, height_px);
}

/// Blanks the date of a PDF, since equal figures give equal bytes. The length stays: a PDF counts positions in the
/// file.
void forget_date(std::string& pdf) {
    const std::size_t date = pdf.rfind("/CreationDate (");
    if (date != std::string::npos) {
        const std::size_t end = std::min(pdf.find('\n', date), pdf.size());
        std::fill(pdf.begin() + static_cast<std::ptrdiff_t>(date), pdf.begin() + static_cast<std::ptrdiff_t>(end), ' ');
    }
}

/// Escapes what must not occur in the text of XML; gnuplot leaves it as it is.
void escape_section_ends(std::string& svg) {
    constexpr std::string_view section_end = "]]>", escaped = "]]&gt;";
    for (std::size_t at = svg.find(section_end); at != std::string::npos; at = svg.find(section_end, at)) {
        svg.replace(at, section_end.size(), escaped);
        at += escaped.size();
    }
}

}  // namespace

GnuplotScript::GnuplotScript(const PictureSettings& settings, double height_px)
    : settings_(settings), height_px_(static_cast<int>(std::lround(height_px))) {
    if (settings.width_px < min_picture_width_px || settings.width_px > max_picture_width_px) {
        throw_input_error(fmt::format("{} is out of range: expected {} to {} pixels", settings.width_px,
                                      min_picture_width_px, max_picture_width_px),
                          "width_px");
    }
    const double font_size = text_unit(settings.format) * font_px;
    add("set encoding utf8");
    add("set terminal {} noenhanced font '{},{}' background '#ffffff'", terminal(settings, height_px_), figure_font,
        font_size);
    add("set border linewidth 1 linecolor rgb '#333333'");
    add("set tics nomirror out scale 0.5 textcolor rgb '#333333'");
}

void GnuplotScript::add_values(std::span<const float> values) {
    // gnuplot reads numbers in the machine's own byte order.
    text_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    text_ += '\n';
}

void GnuplotScript::set_axes(double left_px, double right_px, double bottom_px, double top_px) {
    add("set lmargin at screen {}", screen_x(left_px));
    add("set rmargin at screen {}", screen_x(right_px));
    add("set bmargin at screen {}", screen_y(bottom_px));
    add("set tmargin at screen {}", screen_y(top_px));
}

void GnuplotScript::add_line_of_text(std::string_view text, double middle_px, double bottom_px, double size,
                                     std::string_view color) {
    constexpr double rim_px = 8;
    const double room_px = 2 * (std::min(middle_px, settings_.width_px - middle_px) - rim_px);
    const double needed_px = text_width_px(text, size * font_px);
    const double fitting = needed_px > room_px ? size * room_px / needed_px : size;
    add("set label {} at screen {:.6f},{:.6f} center font ',{:.4g}' textcolor rgb {}", in_quotes(text),
        screen_x(middle_px), screen_y(bottom_px), text_unit(settings_.format) * fitting * font_px, color);
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
    const std::string_view end = settings_.format == PictureFormat::png   ? "IEND"
                                 : settings_.format == PictureFormat::pdf ? "%%EOF"
                                                                          : "</svg>";
    constexpr std::size_t longest_end = 16;
    if (picture.find(end, picture.size() - std::min(picture.size(), longest_end)) == std::string::npos) {
        throw PictureError("gnuplot's picture is incomplete; is there space left for temporary files?");
    }
    if (settings_.format == PictureFormat::pdf) {
        forget_date(picture);
    } else if (settings_.format == PictureFormat::svg) {
        escape_section_ends(picture);
    }
    return picture;
}

std::string in_quotes(const Color& color) {
    return fmt::format("'#{:02x}{:02x}{:02x}'", color.red, color.green, color.blue);
}

}  // namespace downwash
