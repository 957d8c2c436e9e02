#include "downwash/report/plot.hpp"

#include <fmt/core.h>

namespace downwash {

std::string points_text(const Ring& ring, bool is_closed) {
    std::string text;
    for (const PlanePoint& point : ring) {
        text += fmt::format("{:.9g} {:.9g}\n", point.x_m, point.z_m);
    }
    if (is_closed && !ring.empty()) {
        text += fmt::format("{:.9g} {:.9g}\n", ring[0].x_m, ring[0].z_m);
    }
    return text;
}

std::string lines_text(const std::vector<Ring>& rings, bool is_closed) {
    std::string text;
    for (const Ring& ring : rings) {
        text += points_text(ring, is_closed) + "\n";
    }
    return text;
}

void add_data(GnuplotScript& script, const std::string& name, const std::string& text) {
    script.add(name + " << END_OF_DATA\n" + text + "END_OF_DATA");
}

}  // namespace downwash
