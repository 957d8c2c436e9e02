#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include "downwash/base/base64.hpp"
#include "downwash/base/byte_order.hpp"
#include "downwash/base/text.hpp"
#include "downwash/grids/factor_grid_file.hpp"
#include "downwash/grids/provenance_line.hpp"

// VTK's XML format for ImageData: a head in XML that names the arrays, and their numbers behind it in base64.

namespace downwash {
namespace {

/// The count of bytes, then the numbers.
std::string array_data(const double* values, std::size_t count) {
    std::string bytes;
    bytes.reserve((count + 1) * sizeof(double));
    append_little_endian(bytes, std::uint64_t{count * sizeof(double)});
    for (std::size_t i = 0; i < count; ++i) {
        append_little_endian(bytes, values[i]);
    }
    return base64_text(bytes);
}

std::string numbers_text(std::span<const double> numbers) {
    return joined(numbers, " ", [](double number) { return to_text(number); });
}

std::string extent_of(const FactorGrid& grid) {
    return "0 " + std::to_string(grid.x().count - 1) + " 0 " + std::to_string(grid.y().count - 1) + " 0 " +
           std::to_string(grid.z().count - 1);
}

std::string field_data(std::string_view name, std::span<const double> numbers) {
    return "      <DataArray type=\"Float64\" Name=\"" + std::string(name) + "\" NumberOfTuples=\"" +
           std::to_string(numbers.size()) + "\" format=\"ascii\">" + numbers_text(numbers) + "</DataArray>\n";
}

/// VTK writes the letters of texts as numbers, each text closed by a 0.
std::string provenance(const FactorGrid& grid) {
    if (grid.provenance().empty()) {
        return {};
    }
    std::string codes;
    for (const auto& [key, value] : grid.provenance()) {
        for (const char letter : provenance_line(key, value)) {
            codes += std::to_string(static_cast<unsigned char>(letter));
            codes += ' ';
        }
        codes += "0\n";
    }
    return "      <Array type=\"String\" Name=\"provenance\" NumberOfTuples=\"" +
           std::to_string(grid.provenance().size()) + "\" format=\"ascii\">\n" + codes + "      </Array>\n";
}

}  // namespace

std::string vti_text(const FactorGrid& grid) {
    const PlaneOfMotion& frame = grid.frame();
    const Vector3 first_m = frame.to_world(grid.x().low_m, grid.y().low_m, grid.z().low_m);
    // A flat image still has a thickness.
    const double y_step_m = grid.is_planar() ? grid.x().step_m() : grid.y().step_m();
    const double c = frame.cos_heading();
    const double s = frame.sin_heading();

    std::string head =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "  <ImageData WholeExtent=\"" +
        extent_of(grid) + "\" Origin=\"" + numbers_text(first_m) + "\" Spacing=\"" +
        numbers_text(Vector3{grid.x().step_m(), y_step_m, grid.z().step_m()}) + "\" Direction=\"" +
        numbers_text(std::array<double, 9>{c, -s, 0, s, c, 0, 0, 0, 1}) + "\">\n    <FieldData>\n";
    head += field_data("frame_origin_m", frame.origin_m());
    head += field_data("frame_heading_rad", std::array{frame.heading_rad()});
    head += field_data("frame_low_m", Vector3{grid.x().low_m, grid.y().low_m, grid.z().low_m});
    head += field_data("frame_high_m", Vector3{grid.x().high_m, grid.y().high_m, grid.z().high_m});
    head += grid.lateral_offsets_m().empty() ? "" : field_data("lateral_offsets_m", grid.lateral_offsets_m());
    head += provenance(grid) + "    </FieldData>\n";
    head += "    <Piece Extent=\"" + extent_of(grid) + "\">\n      <PointData Scalars=\"" +
            (grid.lateral_offsets_m().empty() ? "factor" : "factor_1") + "\">\n";

    const std::size_t layer_nodes = grid.nodes() / grid.layers();
    const std::size_t array_letters = base64_letters((layer_nodes + 1) * sizeof(double));
    std::size_t offset = 0;
    for (const GridField& field : grid.fields()) {
        for (std::size_t layer = 0; layer < grid.layers(); ++layer, offset += array_letters) {
            const std::string number = grid.lateral_offsets_m().empty() ? "" : "_" + std::to_string(layer + 1);
            head += "        <DataArray type=\"Float64\" Name=\"" + field.name + number +
                    "\" format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
        }
    }
    head += "      </PointData>\n    </Piece>\n  </ImageData>\n  <AppendedData encoding=\"base64\">\n_";
    const std::string_view tail = "\n  </AppendedData>\n</VTKFile>\n";
    std::string text = std::move(head);
    text.reserve(text.size() + offset + tail.size());  // large: only once in memory
    for (const GridField& field : grid.fields()) {
        for (std::size_t layer = 0; layer < grid.layers(); ++layer) {
            text += array_data(field.values.data() + layer * layer_nodes, layer_nodes);
        }
    }
    text += tail;
    return text;
}

}  // namespace downwash
