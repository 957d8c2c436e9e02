#pragma once

// Private: not installed.

#include <string>
#include <utility>

#include "downwash/report/legend.hpp"

namespace downwash {

/// What is drawn, bottom first, as elements of a plot command; what has a name stands in the legend too.
class Plot {
 public:
    explicit Plot(Legend& legend) : legend_(legend) {}

    void add(const std::string& element) { elements_ += (elements_.empty() ? "" : ", ") + element + " notitle"; }

    void add_lines(const std::string& data, const std::string& style, const std::string& name = {}) {
        add(data + " using 1:2 with lines " + style);
        add_name(name, {style, {}, {}});
    }
    void add_fill(const std::string& data, const std::string& style, const std::string& name = {}) {
        add(data + " using 1:2 with filledcurves closed " + style);
        add_name(name, {{}, style, {}});
    }
    void add_points(const std::string& data, const std::string& style, const std::string& name = {}) {
        add(data + " using 1:2 with points " + style);
        add_name(name, {{}, {}, style});
    }

    [[nodiscard]] const std::string& elements() const { return elements_; }

 private:
    void add_name(const std::string& name, LegendSample sample) {
        if (!name.empty()) {
            legend_.add(name, std::move(sample));
        }
    }

    Legend& legend_;
    std::string elements_;
};

}  // namespace downwash
