#include <catch2/catch.hpp>

#include "../support/error_of.hpp"
#include "downwash/base/files.hpp"
#include "downwash/grids/factor_grid_file.hpp"
#include "grids.hpp"

// The files in vti/ were written by VTK 9.1, the library under ParaView.

using namespace downwash;

namespace {

FactorGrid foreign(const std::string& name, const GridReading& reading = {}) {
    return read_factor_grid(std::filesystem::path(DOWNWASH_TEST_VTI) / (name + ".vti"), reading);
}

std::string foreign_text(const std::string& name) {
    return read_file(std::filesystem::path(DOWNWASH_TEST_VTI) / (name + ".vti"), 1000000);
}

std::string error_of(const std::string& text) {
    return test::error_of([&] { return parse_factor_grid(text, "g.vti"); });
}

/// A text with its first occurrence of `from` replaced.
std::string with(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("a grid survives VTK ImageData to the bit, and its text to the byte") {
    CHECK(test::comes_back(vti_text, [](const std::string& text) { return parse_factor_grid(text, "g.vti"); }));
    // Read and written by VTK it is the same too.
    CHECK(test::is_same(foreign("ours_through_vtk"), test::layered()));
    CHECK(test::is_same(foreign("ours_through_vtk_zlib"), test::layered()));
}

TEST_CASE("what VTK writes is read, whatever the encoding") {
    const std::vector<double> expected{1, 1.125, 1.25, 1.5, 1.625, 1.75};
    for (const char* name : {"ascii", "binary_float32", "binary_zlib", "appended_raw", "appended_base64_header32",
                             "appended_raw_big_endian", "appended_base64_big_endian", "appended_raw_zlib"}) {
        INFO(name);
        const FactorGrid grid = foreign(name);
        CHECK(grid.is_planar());
        CHECK(*grid.field("factor") == expected);
        CHECK(grid.factor({10.25, -2, 0.75}) == Approx(1.375));
        CHECK(grid.contains({10, 0, 0.5}));
        CHECK(grid.contains({10.5, 0, 1}));
        CHECK_FALSE(grid.contains({10.6, 0, 1}));
    }
    for (const char* name : {"uint8", "int64"}) {
        INFO(name);
        CHECK(*foreign(name).field("factor") == std::vector<double>{1, 2, 3, 4, 5, 6});
    }
    for (const char* name : {"appended_base64_zlib_blocks", "appended_zlib_big_endian_blocks"}) {
        INFO(name);
        const FactorGrid grid = foreign(name);
        REQUIRE(grid.nodes() == std::size_t{21} * 17);
        for (std::size_t node = 0; node < grid.nodes(); ++node) {
            const auto i = static_cast<double>(node % 21);
            const std::size_t k = node / 21;
            REQUIRE((*grid.field("factor"))[node] == 1 + 0.125 * i + 0.5 * static_cast<double>(k));
        }
    }
}

TEST_CASE("nodes stand where VTK puts them") {
    const FactorGrid volume = foreign("volume");
    CHECK_FALSE(volume.is_planar());
    CHECK(volume.factor({10.25, -1, 1}) == Approx(1 + 0.125 + 2 + 0.5));
    CHECK_FALSE(volume.contains({10.25, -2.5, 1}));
    // Nodes 4 to 6 of 0.25 m from x = 10 m, and -1 to 0 of 0.5 m from z = 0.5 m.
    const FactorGrid shifted = foreign("extent_not_from_zero");
    CHECK(shifted.factor({11.25, -2, 0}) == Approx(1.125));
    CHECK_FALSE(shifted.contains({10.9, -2, 0}));
    // x of the grid along (0.8, 0.6): its second node is 0.25 m from the first.
    CHECK(foreign("turned").factor({10 + 0.2, -2 + 0.15, 0.5}) == Approx(1.125));
}

TEST_CASE("a grid that another program cut out or named otherwise is read where and as that program says") {
    FactorGridParts parts = test::two_by_two();
    parts.frame = PlaneOfMotion({5, 0, 0}, 0);
    const std::string text = with(vti_text(FactorGrid(parts)), "Origin=\"5 0 0\"", "Origin=\"7 0 0\"");
    const FactorGrid moved = parse_factor_grid(text, "g.vti");
    CHECK(moved.factor({7.5, 0, 0}) == 1.5);
    CHECK_FALSE(moved.contains({5.5, 0, 0}));
    GridReading reading;
    reading.array = "K";
    const std::string renamed = with(foreign_text("ascii"), "Name=\"factor\"", "Name=\"K\"");
    CHECK(parse_factor_grid(renamed, "g.vti", reading).nodes() == 6);
    CHECK(error_of(renamed) == "g.vti:4:4: PointData holds no array 'factor'; it holds K");
}

TEST_CASE("what is no image of thrust factors is an error with its place") {
    const std::string ascii = foreign_text("ascii");
    CHECK(error_of(ascii) == "none");
    const std::vector<std::pair<std::string, std::string>> cases{
        {"<", "g.vti:1:1: is no XML: Could not determine tag type"},
        {"<a>", "g.vti:1:3: is no XML: Start-end tags mismatch"},
        {"<a/>", "g.vti:1:2: <a>: expected <VTKFile>"},
        {with(ascii, "type=\"ImageData\"", "type=\"PolyData\""),
         "g.vti:2:2: VTK data of the type 'PolyData': expected ImageData, a regular grid"},
        {with(ascii, "LittleEndian", "Middle"),
         "g.vti:2:2: byte_order is 'Middle': expected LittleEndian or BigEndian"},
        {with(ascii, "UInt64", "UInt16"), "g.vti:2:2: header_type is 'UInt16': expected UInt32 or UInt64"},
        {with(ascii, "WholeExtent=\"0 2 0 0 0 1\"", "WholeExtent=\"0 2 0 0 0 2\""),
         "g.vti:4:4: the piece has another Extent than the image's WholeExtent: expected one whole piece"},
        {with(with(ascii, "Extent=\"0 2 0 0 0 1\"", "Extent=\"0 0 0 0 0 1\""), "Piece Extent=\"0 2 0 0 0 1\"",
              "Piece Extent=\"0 0 0 0 0 1\""),
         "g.vti:3:4: WholeExtent runs from 0 to 0 along x: expected whole numbers, at least two nodes along x and z "
         "and one along y"},
        {with(with(ascii, "Extent=\"0 2 0 0 0 1\"", "Extent=\"0 99999 0 99999 0 99999\""),
              "Piece Extent=\"0 2 0 0 0 1\"", "Piece Extent=\"0 99999 0 99999 0 99999\""),
         "g.vti:3:4: the grid has 1e+15 nodes: expected at most 2^24, a larger step or a smaller extent"},
        {with(ascii, "0 2 0 0 0 1", "0 2 0 0 0 x"),
         "g.vti:3:4: WholeExtent=\"0 2 0 0 0 x\": expected 6 finite numbers"},
        {with(ascii, "Origin=\"10", "Origin=\"inf"), "g.vti:3:4: Origin=\"inf -2 0.5\": expected 3 finite numbers"},
        {with(ascii, "Spacing=\"0.25", "Spacing=\"0"), "g.vti:3:4: Spacing is 0 along x: expected more than 0 m"},
        {with(ascii, "Spacing=\"0.25", "Spacing=\"-1"), "g.vti:3:4: Spacing is -1 along x: expected more than 0 m"},
        {with(ascii, "1 0 0 0 1 0 0 0 1", "1 0 0 0 0 1 0 -1 0"),
         "g.vti:3:4: Direction=\"1 0 0 0 0 1 0 -1 0\": expected a rotation about the vertical, c -s 0 s c 0 0 0 1"},
        {with(ascii, "Float64", "String"),
         "g.vti:6:8: array 'factor' has the type 'String': expected Float32, Float64 or an integer type such as UInt8"},
        {with(ascii, "Name=\"factor\"", "Name=\"factor\" NumberOfComponents=\"3\""),
         "g.vti:6:8: array 'factor' has several components: expected one number a point"},
        {with(ascii, "format=\"ascii\"", "format=\"spoken\""),
         "g.vti:6:8: array 'factor' has the format 'spoken': expected ascii, binary or appended"},
        {with(ascii, "1.75\n", "\n"), "g.vti:6:8: array 'factor' holds 5 numbers: expected 6"},
        {with(ascii, "1.75\n", "1.75 2\n"), "g.vti:6:8: array 'factor' holds more than 6 numbers"},
        {with(ascii, "1.625 ", "much "), "g.vti:6:8: array 'factor' number 5 is 'much': expected a number"},
        {with(ascii, "1.625 ", "nan "), "g.vti: factor value 5 of 6 is nan: expected a finite factor from 0 to 100"},
        {with(ascii, "1.625 ", "-inf "), "g.vti: factor value 5 of 6 is -inf: expected a finite factor from 0 to 100"},
        {foreign_text("cell_data"),
         "g.vti:4:4: 'factor' is CellData: expected PointData (ParaView's filter Cell Data to Point Data makes it so)"},
        {foreign_text("lz4"),
         "g.vti:2:2: the data is compressed by 'vtkLZ4DataCompressor': expected vtkZLibDataCompressor or none"},
        {with(ascii, "</Piece>", "</Piece><Piece/>"), "g.vti:12:12: a second <Piece>: expected one; merge them before"},
        {with(ascii, "</PointData>", "<DataArray Name=\"factor\"/></PointData>"),
         "g.vti:9:6: array 'factor' occurs twice"},
    };
    for (const auto& [text, message] : cases) {
        CHECK(error_of(text) == message);
    }
}

TEST_CASE("a wrong byte order or header type does not pass for data") {
    const auto asks = Catch::Contains("is the byte_order or header_type wrong?");
    for (const char* name : {"appended_raw", "appended_base64_zlib_blocks", "binary_zlib", "uint8"}) {
        INFO(name);
        CHECK_THAT(error_of(with(foreign_text(name), "LittleEndian", "BigEndian")), asks);
        CHECK(error_of(with(foreign_text(name), "UInt64", "UInt32")) != "none");
    }
    for (const char* name : {"appended_raw_big_endian", "appended_base64_big_endian"}) {
        CHECK_THAT(error_of(with(foreign_text(name), "BigEndian", "LittleEndian")), asks);
    }
    // Numbers alone, without a header of counts: absurd values.
    const std::string text = with(foreign_text("ascii"), "Float64\" Name=\"factor\" format=\"ascii\"",
                                  "Int16\" Name=\"factor\" format=\"ascii\"");
    CHECK(error_of(with(text, "1.625", "256")) ==
          "g.vti: factor value 5 of 6 is 256: expected a finite factor from 0 to 100");
}

TEST_CASE("no truncated file passes for a whole one") {
    for (const char* name : {"ascii", "appended_raw", "appended_base64_zlib_blocks", "binary_zlib"}) {
        const std::string text = foreign_text(name);
        const std::size_t whole = text.find("</VTKFile>") + std::string("</VTKFile>").size();
        for (std::size_t length = 0; length < whole; ++length) {
            INFO(name << " cut to " << length << " bytes");
            REQUIRE(error_of(text.substr(0, length)) != "none");
        }
    }
}

TEST_CASE("a damaged byte is named or read, and never makes a reader crash") {
    test::Random random(5);
    int named = 0;
    int read = 0;
    for (const char* name :
         {"appended_raw", "appended_raw_zlib", "appended_base64_zlib_blocks", "binary_zlib", "turned"}) {
        const std::string text = foreign_text(name);
        for (int i = 0; i < 2000; ++i) {
            std::string damaged = text;
            const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(text.size()) - 1));
            damaged[at] = static_cast<char>(random.integer(0, 255));
            const std::string error = error_of(damaged);
            ++(error == "none" ? read : named);
            INFO(name << ": " << error);
            REQUIRE((error == "none" || error.starts_with("g.vti")));
        }
    }
    CHECK(named > 1000);
    CHECK(read > 1000);
}
