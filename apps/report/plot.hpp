#pragma once

// Private: not installed.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/report/gnuplot_script.hpp"
#include "downwash/report/legend.hpp"
#include "downwash/report/picture.hpp"

namespace downwash {

/// One line of text per point. @param is_closed whether the first point is repeated at the end
[[nodiscard]] std::string points_text(const Ring& ring, bool is_closed);

/// The points of several rings, each ring followed by an empty line.
[[nodiscard]] std::string lines_text(const std::vector<Ring>& rings, bool is_closed);

/// Defines the data block `name`, such as "$edge3".
void add_data(GnuplotScript& script, const std::string& name, const std::string& text);

/// The elements of a plot command, bottom first. An element with a name has an entry in the legend.
class Plot {
 public:
    explicit Plot(Legend& legend) : legend_(legend) {}

    void add(const std::string& element, const std::string& name = {}, LegendSample sample = {}) {
        elements_ += (elements_.empty() ? "" : ", ") + element + " notitle";
        if (!name.empty()) {
            legend_.add(name, std::move(sample));
        }
    }
    void add_lines(const std::string& data, const std::string& style, const std::string& name = {}) {
        add(data + " using 1:2 with lines " + style, name, {style, {}, {}});
    }
    void add_fill(const std::string& data, const std::string& style, const std::string& name = {}) {
        add(data + " using 1:2 with filledcurves closed " + style, name, {{}, style, {}});
    }
    void add_points(const std::string& data, const std::string& style, const std::string& name = {}) {
        add(data + " using 1:2 with points " + style, name, {{}, {}, style});
    }
    [[nodiscard]] const std::string& elements() const { return elements_; }

 private:
    Legend& legend_;
    std::string elements_;
};

}  // namespace downwash
