#pragma once

// Private: not installed.

#include <fmt/core.h>

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "downwash/report/picture.hpp"

namespace downwash {

/// Size of the text in pictures [px].
inline constexpr double font_px = 15;

/// A script that draws one picture. Foreign text in it has passed through in_quotes().
class GnuplotScript {
 public:
    /// @throws InputError when the width is out of its range
    GnuplotScript(const PictureSettings& settings, double height_px);

    /// One line of the script.
    void add(std::string_view line) {
        text_ += line;
        text_ += '\n';
    }
    /// Adds a command with values in place of {}.
    template <class... Values>
    void add(fmt::format_string<Values...> line, Values&&... values) {
        add(std::string_view(fmt::format(line, std::forward<Values>(values)...)));
    }

    /// Adds the values for a `'-' binary format='%float'` of the last line.
    void add_values(std::span<const float> values);

    /// A distance in pixels from the left or from the bottom, as a fraction of the picture.
    [[nodiscard]] double screen_x(double px) const { return px / settings_.width_px; }
    [[nodiscard]] double screen_y(double px) const { return px / height_px_; }
    /// A place in pixels from the lower left corner, as after `at`.
    [[nodiscard]] std::string place(double x_px, double y_px) const {
        return fmt::format("screen {:.6f},{:.6f}", screen_x(x_px), screen_y(y_px));
    }

    /// Sets the position of the axes, in pixels from the lower left corner of the picture.
    void set_axes(double left_px, double right_px, double bottom_px, double top_px);

    /// Adds a centred text, in `size` times the usual font or smaller if it does not fit.
    void add_line_of_text(std::string_view text, double middle_px, double bottom_px, double size,
                          std::string_view color);

    /// Adds a title at `top_px` and, in grey, a subtitle below it.
    void set_titles(std::string_view title, std::string_view subtitle, double middle_px, double top_px);

    /// Draws. @throws PictureError
    [[nodiscard]] std::string draw() const;

 private:
    PictureSettings settings_;
    int height_px_;
    std::string text_;
};

/// "'#rrggbb'"
[[nodiscard]] std::string in_quotes(const Color& color);

}  // namespace downwash
