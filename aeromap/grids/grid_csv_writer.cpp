#include <array>
#include <charconv>

#include "downwash/base/text.hpp"
#include "downwash/grids/factor_grid_file.hpp"
#include "downwash/grids/provenance_line.hpp"

namespace downwash {
namespace {

void append_number(std::string& text, double value) {
    std::array<char, 32> digits;
    text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

}  // namespace

std::string grid_csv_text(const FactorGrid& grid) {
    const Vector3& origin_m = grid.frame().origin_m();
    std::string text = "# frame_origin_m: " + to_text(origin_m[0]) + " " + to_text(origin_m[1]) + " " +
                       to_text(origin_m[2]) + "\n# frame_heading_rad: " + to_text(grid.frame().heading_rad()) + "\n";
    for (const auto& [key, value] : grid.provenance()) {
        text += "# ";
        text += provenance_line(key, value);
        text += '\n';
    }
    const bool has_offsets = !grid.lateral_offsets_m().empty();
    text += has_offsets ? "lateral_m,x_m" : "x_m";
    text += grid.is_planar() ? ",z_m" : ",y_m,z_m";
    for (const GridField& field : grid.fields()) {
        text += "," + field.name;
    }
    text += '\n';
    std::size_t node = 0;
    for (std::size_t layer = 0; layer < grid.layers(); ++layer) {
        for (std::size_t k = 0; k < grid.z().count; ++k) {
            for (std::size_t j = 0; j < grid.y().count; ++j) {
                for (std::size_t i = 0; i < grid.x().count; ++i, ++node) {
                    if (has_offsets) {
                        append_number(text, grid.lateral_offsets_m()[layer]);
                        text += ',';
                    }
                    append_number(text, grid.x().at(i));
                    if (!grid.is_planar()) {
                        text += ',';
                        append_number(text, grid.y().at(j));
                    }
                    text += ',';
                    append_number(text, grid.z().at(k));
                    for (const GridField& field : grid.fields()) {
                        text += ',';
                        append_number(text, field.values[node]);
                    }
                    text += '\n';
                }
            }
        }
    }
    return text;
}

}  // namespace downwash
