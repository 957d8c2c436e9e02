#pragma once

// Private: not installed.

#include <string>
#include <string_view>
#include <vector>

#include "downwash/report/gnuplot_script.hpp"

namespace downwash {

/// The sample before a name: gnuplot options for a stroke, a filled box and a point; empty for none.
struct LegendSample {
    std::string stroke;  ///< as after `set arrow`, for example "linewidth 2"
    std::string fill;    ///< as after `set object rectangle`
    std::string point;   ///< as after `set label ... point`
};

/// The legend, in rows above the axes. gnuplot's own key overlaps the axes if it is large.
class Legend {
 public:
    void add(std::string_view name, LegendSample sample);

    /// Its height for an available width [px].
    [[nodiscard]] double height_px(double width_px) const;

    /// Adds it below `top_px`, centred at `middle_px`.
    void place(GnuplotScript& script, double middle_px, double top_px, double width_px) const;

 private:
    struct Entry {
        std::string name;
        LegendSample sample;
    };
    /// The widths of the columns that fit, names included.
    [[nodiscard]] std::vector<double> columns_px(double width_px) const;

    std::vector<Entry> entries_;
};

}  // namespace downwash
