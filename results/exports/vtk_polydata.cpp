#include <algorithm>
#include <cmath>
#include <cstdint>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/exports/formats.hpp"
#include "downwash/scene/solid_surface.hpp"

// VTK's XML format for polydata, its numbers as text: points, lines or triangles between them, named arrays.

namespace downwash {
namespace {

std::string array(std::string_view type, std::string_view name, int components, const std::string& numbers) {
    return "<DataArray type=\"" + std::string(type) + "\"" +
           (name.empty() ? "" : " Name=\"" + std::string(name) + "\"") + " NumberOfComponents=\"" +
           std::to_string(components) + "\" format=\"ascii\">\n" + numbers + "\n</DataArray>\n";
}

void append_point(std::string& numbers, const Vector3& point) {
    for (const double coordinate : point) {
        numbers += to_text(coordinate) + ' ';
    }
    numbers.back() = '\n';
}

std::string cells(std::string_view kind, const std::string& connectivity, const std::string& offsets) {
    return "<" + std::string(kind) + ">\n" + array("Int64", "connectivity", 1, connectivity) +
           array("Int64", "offsets", 1, offsets) + "</" + std::string(kind) + ">\n";
}

struct PieceCounts {
    std::size_t points = 0, lines = 0, polygons = 0;
};

std::string polydata(const std::string& field_data, const PieceCounts& counts, const std::string& piece) {
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
           "byte_order=\"LittleEndian\">\n<PolyData>\n" +
           field_data + "<Piece NumberOfPoints=\"" + std::to_string(counts.points) +
           "\" NumberOfVerts=\"0\" NumberOfLines=\"" + std::to_string(counts.lines) +
           "\" NumberOfStrips=\"0\" NumberOfPolys=\"" + std::to_string(counts.polygons) + "\">\n" + piece +
           "</Piece>\n</PolyData>\n</VTKFile>\n";
}

/// Names as an array of texts: VTK writes their letters as numbers, each text closed by a 0.
std::string names_array(const std::vector<Obstacle>& obstacles) {
    std::string codes;
    for (const Obstacle& obstacle : obstacles) {
        for (const char letter : obstacle.name) {
            codes += std::to_string(static_cast<unsigned char>(letter)) + ' ';
        }
        codes += "0\n";
    }
    return "<FieldData>\n<Array type=\"String\" Name=\"obstacles\" NumberOfTuples=\"" +
           std::to_string(obstacles.size()) + "\" format=\"ascii\">\n" + codes + "</Array>\n</FieldData>\n";
}

}  // namespace

std::string vtk_flight(const RunInWorld& run, const ExportSettings&) {
    const NumberTable& flight = run.flight;
    if (flight.rows() == 0) {
        throw_input_error("this run contains no flight");
    }
    std::string points, lines;
    std::size_t count = 0;
    for (const bool is_end_effector : {false, true}) {
        for (std::size_t row = 0; row < flight.rows(); ++row) {
            append_point(points, is_end_effector ? run.end_effector_m(row) : run.pose(row).position_m);
            lines += std::to_string(count++) + ' ';
        }
    }
    std::string columns;
    for (std::size_t i = 0; i < flight.columns.size(); ++i) {
        const std::vector<double>& column = flight.columns[i];
        if (std::any_of(column.begin(), column.end(), [](double number) { return std::isnan(number); })) {
            continue;  // the clearance where there are no obstacles
        }
        std::string numbers;
        for (int line = 0; line < 2; ++line) {
            for (const double number : column) {
                numbers += to_text(number) + ' ';
            }
        }
        columns += array("Float64", flight.names[i], 1, numbers);
    }
    return polydata("", {count, 2, 0},
                    "<PointData>\n" + columns + "</PointData>\n<CellData>\n" +
                        array("Int32", "is_end_effector", 1, "0 1") + "</CellData>\n<Points>\n" +
                        array("Float64", "", 3, points) + "</Points>\n" +
                        cells("Lines", lines, std::to_string(flight.rows()) + ' ' + std::to_string(count)));
}

std::string vtk_scene(const RunInWorld& run, const ExportSettings&) {
    std::string points, corners, offsets, obstacles;
    PieceCounts counts;
    const std::vector<Obstacle>& all = run.obstacles;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const TriangleMesh surface = surface_of(all[i]);
        for (const Vector3& vertex_m : surface.vertices_m) {
            append_point(points, vertex_m);
        }
        for (const auto& triangle : surface.triangles) {
            for (const std::uint32_t corner : triangle) {
                corners += std::to_string(counts.points + corner) + ' ';
            }
            offsets += std::to_string(3 * ++counts.polygons) + ' ';
            obstacles += std::to_string(i) + ' ';
        }
        counts.points += surface.vertices_m.size();
    }
    return polydata(names_array(all), counts,
                    "<CellData>\n" + array("Int32", "obstacle", 1, obstacles) + "</CellData>\n<Points>\n" +
                        array("Float64", "", 3, points) + "</Points>\n" + cells("Polys", corners, offsets));
}

}  // namespace downwash
