#include "downwash/report/legend.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "downwash/report/picture_text.hpp"

namespace downwash {
namespace {

constexpr double row_px = 22;
constexpr double sample_px = 34;
constexpr double gap_px = 8;          // between a sample and its name
constexpr double separation_px = 24;  // between columns

}  // namespace

void Legend::add(std::string_view name, LegendSample sample) {
    entries_.push_back({picture_text(name), std::move(sample)});
}

std::vector<double> Legend::columns_px(double width_px) const {
    for (std::size_t count = entries_.size(); count > 0; --count) {
        std::vector<double> columns(count, 0);
        for (std::size_t i = 0; i < entries_.size(); ++i) {
            double& column = columns[i % count];
            column = std::max(column, sample_px + gap_px + text_width_px(entries_[i].name, font_px));
        }
        const double all =
            std::accumulate(columns.begin(), columns.end(), separation_px * (static_cast<double>(count) - 1));
        if (all <= width_px || count == 1) {
            return columns;
        }
    }
    return {};
}

double Legend::height_px(double width_px) const {
    const std::size_t in_a_row = columns_px(width_px).size();
    const std::size_t rows = in_a_row == 0 ? 0 : (entries_.size() + in_a_row - 1) / in_a_row;
    return row_px * static_cast<double>(rows);
}

void Legend::place(GnuplotScript& script, double middle_px, double top_px, double width_px) const {
    script.add("unset key");
    const std::vector<double> columns = columns_px(width_px);
    std::vector<double> lefts;
    double end = 0;
    for (const double column : columns) {
        lefts.push_back(end);
        end += column + separation_px;
    }
    const double first_px = middle_px - (end - separation_px) / 2;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const LegendSample& sample = entries_[i].sample;
        const double left = first_px + lefts[i % columns.size()];
        const std::size_t row = i / columns.size();
        const double y = top_px - row_px * (static_cast<double>(row) + 0.5);
        const auto screen = [&](double dx, double dy) { return script.place(left + dx, y + dy); };
        if (!sample.fill.empty()) {
            script.add("set object rectangle from {} to {} front {}", screen(0, -6), screen(sample_px, 6), sample.fill);
        }
        if (!sample.stroke.empty()) {
            script.add("set arrow from {} to {} nohead front {}", screen(0, 0), screen(sample_px, 0), sample.stroke);
        }
        if (!sample.point.empty()) {
            script.add("set label '' at {} point {} front", screen(sample_px / 2, 0), sample.point);
        }
        script.add("set label {} at {} left front textcolor rgb '#333333'", in_quotes(entries_[i].name),
                   screen(sample_px + gap_px, 0));
    }
}

}  // namespace downwash
