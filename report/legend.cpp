#include "downwash/report/legend.hpp"

#include <fmt/core.h>

#include <algorithm>
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

double Legend::column_px() const {
    double widest_px = 0;
    for (const Entry& entry : entries_) {
        widest_px = std::max(widest_px, text_width_px(entry.name, font_px));
    }
    return sample_px + gap_px + widest_px + separation_px;
}

std::size_t Legend::columns(double width_px) const {
    const auto fitting = static_cast<std::size_t>(std::max(1., (width_px + separation_px) / column_px()));
    return std::min(fitting, std::max<std::size_t>(1, entries_.size()));
}

double Legend::height_px(double width_px) const {
    const std::size_t in_a_row = columns(width_px);
    return row_px * static_cast<double>((entries_.size() + in_a_row - 1) / in_a_row);
}

void Legend::place(GnuplotScript& script, double middle_px, double top_px, double width_px) const {
    script.add("unset key");
    const std::size_t in_a_row = columns(width_px);
    const double first_px = middle_px - (static_cast<double>(in_a_row) * column_px() - separation_px) / 2;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const LegendSample& sample = entries_[i].sample;
        const double left = first_px + static_cast<double>(i % in_a_row) * column_px();
        const double y = top_px - row_px * (static_cast<double>(i / in_a_row) + 0.5);
        const auto screen = [&](double dx, double dy) {
            return fmt::format("screen {:.6f},{:.6f}", script.screen_x(left + dx), script.screen_y(y + dy));
        };
        if (!sample.fill.empty()) {
            script.add(fmt::format("set object rectangle from {} to {} front {}", screen(0, -6), screen(sample_px, 6),
                                   sample.fill));
        }
        if (!sample.stroke.empty()) {
            script.add(fmt::format("set arrow from {} to {} nohead front {}", screen(0, 0), screen(sample_px, 0),
                                   sample.stroke));
        }
        if (!sample.point.empty()) {
            script.add(fmt::format("set label '' at {} point {} front", screen(sample_px / 2, 0), sample.point));
        }
        script.add(fmt::format("set label {} at {} left front textcolor rgb '#333333'", in_quotes(entries_[i].name),
                               screen(sample_px + gap_px, 0)));
    }
}

}  // namespace downwash
