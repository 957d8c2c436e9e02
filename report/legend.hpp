#pragma once

// Private: not installed.

#include <string>
#include <string_view>
#include <vector>

#include "downwash/report/gnuplot_script.hpp"

namespace downwash {

/// What stands before a name: the options of gnuplot that draw a stroke, a filled box and a point; empty for none.
struct LegendSample {
    std::string stroke;  ///< as after `set arrow`, for example "linewidth 2"
    std::string fill;    ///< as after `set object rectangle`
    std::string point;   ///< as after `set label ... point`
};

/// The names of what is drawn, in rows above the axes. gnuplot's own key overlaps the axes when it grows.
class Legend {
 public:
    void add(std::string_view name, LegendSample sample);

    /// How high it gets where it may be so wide [px].
    [[nodiscard]] double height_px(double width_px) const;

    /// Puts it below `top_px`, about `middle_px`.
    void place(GnuplotScript& script, double middle_px, double top_px, double width_px) const;

 private:
    struct Entry {
        std::string name;
        LegendSample sample;
    };
    /// Widths of as many columns as fit, names included.
    [[nodiscard]] std::vector<double> columns_px(double width_px) const;

    std::vector<Entry> entries_;
};

}  // namespace downwash
